//===- PlyColumns.h - numbers in PLY files --------------------------------===//
#pragma once

#include "runtime/buffers/NumberFiles.h"

#include <cstddef>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// Reads properties of the elements of this name, an element a row. `columns` chooses them by name,
/// in this order; empty: all but lists, which cannot be chosen. The rest of the file must be there,
/// too. Throws BadBuffer, UnknownName, NotSupported, and the errors of reading a file.
NumberArray readPly(const std::string &path, const std::string &element,
                    const std::vector<std::string> &columns);

/// How many elements of this name there are. Throws BadBuffer, UnknownName, and the errors of
/// reading a file.
std::size_t plyCount(const std::string &path, const std::string &element);

} // namespace rtsl::runtime
