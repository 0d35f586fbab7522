//===- Output.cpp - text to a file or to standard output ------------------===//
#include "Output.h"

#include "runtime/AtomicFile.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace rtsl::tool {

void checkOutput(const std::string &path) {
  if (path != "-")
    runtime::checkFileWritable(path);
}

void writeOutput(const std::string &path, std::string_view text) {
  if (path != "-")
    runtime::writeFileAtomically(path, text);
  else if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw runtime::Error(runtime::ErrorCode::FileUnwritable,
                         fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

} // namespace rtsl::tool
