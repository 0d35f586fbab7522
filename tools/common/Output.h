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

} // namespace rtsl::tool
