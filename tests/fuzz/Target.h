//===- Target.h - what a fuzzer runs --------------------------------------===//
//
// All targets, FrontEnd.cpp and the readers of files, define LLVMFuzzerTestOneInput. libFuzzer
// calls it with inputs that it makes; Replay.cpp is a plain main that calls it with files.
// docs/testing.md describes how to run them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Runs one input. What must not be ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace rtsl::fuzz {

/// Ends the process unless `holds`; fuzzers take that as a crash.
void require(bool holds, const char *what);

/// Requires that an error is the file's, and says what is wrong.
void expectAboutFile(const Error &error);

/// Calls `read`, whose errors are those of the file.
template <typename Read>
void attempt(Read read) {
  try {
    read();
  } catch (const Error &error) {
    expectAboutFile(error);
  }
}

/// A file with this content, for readers that take paths. It is removed at the end.
class File {
public:
  /// The end of `name` tells readers the format.
  File(std::string_view content, const std::string &name);
  ~File();
  File(const File &) = delete;
  File &operator=(const File &) = delete;

  std::string path;
};

} // namespace rtsl::fuzz
