//===- Output.h - text to a file or to standard output --------------------===//
#pragma once

#include <string>
#include <string_view>

namespace rtsl::tool {

/// Throws now if writeOutput could not succeed later. "-" is standard output.
void checkOutput(const std::string &path);

/// Writes all of `text`; a file appears whole or not at all. Throws runtime::Error with FileUnwritable.
void writeOutput(const std::string &path, std::string_view text);

} // namespace rtsl::tool
