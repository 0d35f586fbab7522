//===- PrintLog.h - what shaders print ------------------------------------===//
//
// Samples run in any order on any number of threads; what they print is collected and shown at the
// end in the order of the launch: by row, column, sample, and then as it was printed.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "support/FirstFew.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// One `print` that has run.
struct PrintedLine {
  std::uint32_t x, y, sample; // noSample: a constructor's, or while the scene was built
  std::uint32_t order;        // of what the sample printed
  std::uint32_t format;       // index into Program::prints
  std::vector<std::uint32_t> words;
  std::string text = {}; // of shaders in C++: what it prints; they have no formats

  static constexpr std::uint32_t noSample = ~0u;
};

class PrintLog {
public:
  /// More lines are counted, but not kept; those that come first in the order of the launch are.
  static constexpr std::size_t mostLines = 100000;

  void add(PrintedLine line);

  /// The lines as text, in order, each with the pixel and the sample that printed it; at the end
  /// how many more there were.
  std::vector<std::string> texts(const std::vector<PrintFormat> &formats);

private:
  struct ComesFirst {
    bool operator()(const PrintedLine &a, const PrintedLine &b) const;
  };
  FirstFew<PrintedLine, ComesFirst> lines{mostLines};
};

/// `print` of shaders in C++.
void print(RtslState *state, const PrintFormat &format, const std::vector<std::uint32_t> &words);

/// Takes what was printed since the last time, by any thread of the process.
PrintLog takePrintLog();

} // namespace rtsl::runtime
