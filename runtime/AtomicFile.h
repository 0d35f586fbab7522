//===- AtomicFile.h - files that appear whole or not at all ---------------===//
#pragma once

#include "runtime/Error.h"

#include <string>
#include <string_view>

namespace rtsl::runtime {

/// Writes `bytes` to a temporary file beside `path`, makes sure that they reached the disk, and
/// renames it. A path that is no regular file (a pipe, /dev/stdout) is written directly. On an
/// error nothing is left behind. Throws FileUnwritable.
void writeFileAtomically(const std::string &path, std::string_view bytes);

/// Throws FileUnwritable if writeFileAtomically could not create its file.
void checkFileWritable(const std::string &path);

/// The whole of a file. Throws FileNotFound, FileUnreadable.
std::string readFile(const std::string &path);

} // namespace rtsl::runtime
