//===- Output.h - what goes to standard output -----------------------------===//
#pragma once

#include <string_view>

namespace rtsl::tool {

/// Writes all of `text` to standard output. Throws Error with FileUnwritable: so a full disk is
/// reported, whatever a command prints.
void printOut(std::string_view text);

/// Whether all that was printed by other means, such as the help texts, was written; reports it
/// if it was not.
bool finishOutput(const char *program);

/// From now on, to write beyond the limit on the size of files is an error like a full disk. The
/// signal that the system sends otherwise would end the process, and what it has computed is lost.
void reportFileSizeLimit();

} // namespace rtsl::tool
