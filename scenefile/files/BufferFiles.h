//===- BufferFiles.h - buffers of a scene that are no lists ---------------===//
//
// {"buffer": "points.npy"} in place of a list (docs/scene-format.md#buffers): NumPy's .npy, columns
// of .csv and .ply, or elements as they lie in memory. {"size": [480, 640]}: zeros.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/scene/ValueStore.h"
#include "scenefile/json/JsonValue.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rtsl::scene {

struct BufferDescription {
  std::string file;                 // resolved; empty: zeros
  std::string element = "vertex";   // of .ply: whose columns
  std::vector<std::string> columns; // of .csv and .ply; empty: all
  // of zeros, or of a file without a format: then empty is one dimension
  std::vector<std::uint32_t> shape;
};

/// Is it a buffer in a file, or of zeros? For the value of a member.
bool isBuffer(const JsonValue &value);

/// `resolve` makes a path as written one to open. Throws UnknownKey, WrongType, OutOfRange.
BufferDescription
readBufferDescription(const JsonValue &buffer,
                      const std::function<std::string(const JsonValue &)> &resolve);

/// As a block of memory for a member of this type. `what` names the member in messages.
/// Throws WrongType, OutOfRange, BadBuffer, and the errors of reading a file.
runtime::Value readBuffer(const BufferDescription &buffer, const runtime::ValueType &type,
                          std::uint32_t colorComponents, const std::string &what);

/// The number of elements along the first dimension, which is that of a file if it says so. Throws
/// MissingKey, BadBuffer, and the errors of reading a file.
std::size_t lengthOf(const BufferDescription &buffer);

/// Zeros for a member of this type.
runtime::Value zeros(const std::vector<std::uint32_t> &sizes, const runtime::ValueType &type,
                     const std::string &what);

} // namespace rtsl::scene
