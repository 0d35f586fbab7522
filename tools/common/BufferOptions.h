//===- BufferOptions.h - NAME=FILE, for --in and --out --------------------===//
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace rtsl::tool {

/// A buffer and its file: --in NAME=FILE, --out NAME=FILE.
struct BufferFile {
  std::string name, file;
};

/// Adds an option with values NAME=FILE.
void addBufferOption(CLI::App &command, const char *name, std::vector<BufferFile> &files,
                     const char *text);

/// Rejects a file that two options would write, and a buffer that is written twice.
void checkOutputFiles(const std::vector<BufferFile> &outputs, const std::string &picture);

} // namespace rtsl::tool
