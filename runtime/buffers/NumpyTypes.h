//===- NumpyTypes.h - types of elements as NumPy writes them --------------===//
#pragma once

#include "runtime/program/Program.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// The dimensions of an element of `bytes`: of its arrays, then of a matrix its columns and rows.
std::vector<std::uint32_t> elementShape(const ValueType &type, std::uint32_t bytes);

/// Sizes as Python writes them: (3,).
std::string tupleOf(const std::vector<std::uint32_t> &sizes);

/// The type of a number, or of a struct: '<f4', [('at', '<f4', (3,)), ('n', '<i4')]. A bool of a
/// struct is a number.
std::string numpyType(const ValueType &type, bool isInStruct = false);

} // namespace rtsl::runtime
