//===- AtomicFile.h - files that appear whole or not at all ---------------===//
#pragma once

#include "support/Error.h"

#include <string>
#include <string_view>
#include <vector>

namespace rtsl {

/// Writes `bytes` to a temporary file beside `path`, flushes it to disk, and renames it. A path
/// that is not a regular file (a pipe, /dev/stdout) is written directly; "-" is standard output. On
/// an error no partial file remains. Throws FileUnwritable.
void writeFileAtomically(const std::string &path, std::string_view bytes);
/// The same for bytes in several parts.
void writeFileAtomically(const std::string &path, const std::vector<std::string_view> &parts);

/// Removes temporary files that writeFileAtomically(path, ...) has left because its process was
/// killed. Those that are being written stay.
void removeUnfinishedFiles(const std::string &path);

/// Throws FileUnwritable if writeFileAtomically could not create its file.
void checkFileWritable(const std::string &path);

/// Throws OverwritesInput if `output` is the same file as one of `inputs`, under any name or link.
/// "-" is standard output.
void refuseToOverwrite(const std::string &output, const std::vector<std::string> &inputs);

/// The contents of a file; of "-", standard input. Throws FileNotFound or FileUnreadable: devices
/// are not read, because they may never end.
std::string readFile(const std::string &path);

} // namespace rtsl
