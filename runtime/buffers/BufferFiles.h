//===- BufferFiles.h - the elements of buffers from files -----------------===//
//
// NumPy's .npy, columns of .csv and .ply, or elements as they lie in memory.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/Value.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::runtime {

struct BufferDescription {
  std::string file;                 // resolved; empty: zeros
  std::string element = "vertex";   // of .ply: whose columns
  std::vector<std::string> columns; // of .csv and .ply; empty: all
  // of zeros, or of a file without a format: then empty is one dimension
  std::vector<std::uint32_t> shape;
};

/// The end of the file's name, with the dot.
std::string extensionOf(const BufferDescription &buffer);

/// Reads it as a block of memory for a member of this type. `what` names the member in messages.
/// Throws WrongType, OutOfRange, BadBuffer, and the errors of reading a file.
Value readBuffer(const BufferDescription &buffer, const ValueType &type,
                 std::uint32_t colorComponents, const std::string &what);

/// The number of elements along the first dimension; none for a file that does not say, because it
/// has no format. Throws BadBuffer, and the errors of reading a file.
std::optional<std::size_t> lengthOf(const BufferDescription &buffer);

/// Zeros for a member of this type.
Value zeros(const std::vector<std::uint32_t> &sizes, const ValueType &type,
            const std::string &what);

} // namespace rtsl::runtime
