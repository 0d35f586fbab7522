//===- PrintLog.h - the output of print in shaders ------------------------===//
//
// Samples run in any order on any number of threads; their output is collected and shown at the end
// in the order of the launch: by row, column and sample, and then in the order of printing.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "support/FirstFew.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// One executed `print`.
struct PrintedLine {
  std::uint32_t x, y, sample; // noSample: in a constructor, or while the scene was built
  std::uint32_t order;        // within the output of the sample
  std::uint32_t format;       // index into Program::prints
  std::vector<std::uint32_t> words;
  std::string text = {}; // for shaders in C++: the text; they have no formats

  static constexpr std::uint32_t noSample = ~0u;
};

class PrintLog {
public:
  /// Further lines are counted, but not kept; the first ones in the order of the launch are kept.
  static constexpr std::size_t mostLines = 100000;

  void add(PrintedLine line);
  /// The lines that a device has printed. `words` has at least those that they reserved, as far as
  /// their capacity goes.
  void add(const RtslPrintedLines &printed, const std::uint32_t *words);

  /// The lines as text, in order, each with the pixel and the sample that printed it; at the end
  /// the number of further lines, and of those that a device had no memory for.
  std::vector<std::string> texts(const std::vector<PrintFormat> &formats);

private:
  struct ComesFirst {
    bool operator()(const PrintedLine &a, const PrintedLine &b) const;
  };
  FirstFew<PrintedLine, ComesFirst> lines{mostLines};
  std::uint64_t lost = 0;
};

/// `print` for shaders in C++.
void print(RtslState *state, const PrintFormat &format, const std::vector<std::uint32_t> &words);

/// The values as text, each preceded by a space.
std::string itemsText(const PrintFormat &format, const std::uint32_t *words);

// Add to the output of the process: a line, and the lines of a device.
void addPrinted(PrintedLine line);
void addPrinted(const RtslPrintedLines &printed, const std::uint32_t *words);

/// Takes the output since the last call, of all threads of the process.
PrintLog takePrintLog();

} // namespace rtsl::runtime
