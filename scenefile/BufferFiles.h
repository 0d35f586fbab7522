//===- BufferFiles.h - buffers that a scene takes from files --------------===//
//
// {"buffer": "points.npy"} in place of a list (docs/scene-format.md#buffers): NumPy's .npy, columns
// of .csv, or elements as they lie in memory.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/scene/ValueStore.h"
#include "scenefile/JsonValue.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rtsl::scene {

struct BufferDescription {
  std::string file;                 // resolved
  std::vector<std::string> columns; // of .csv; empty: all
  std::vector<std::uint32_t> shape; // of a file without a format; empty: one dimension
};

/// Is it a buffer in a file? For the value of a member.
bool isBufferFile(const JsonValue &value);

/// `resolve` makes a path as written one to open. Throws UnknownKey, WrongType, OutOfRange.
BufferDescription
readBufferDescription(const JsonValue &buffer,
                      const std::function<std::string(const JsonValue &)> &resolve);

/// The file as a block of memory for a member of this type. `what` names the member in messages.
/// Throws WrongType, OutOfRange, BadBuffer, and the errors of reading a file.
runtime::Value readBuffer(const BufferDescription &buffer, const runtime::ValueType &type,
                          std::uint32_t colorComponents, const std::string &what);

} // namespace rtsl::scene
