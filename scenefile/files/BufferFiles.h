//===- BufferFiles.h - buffers of a scene that are no lists ---------------===//
//
// {"buffer": "points.npy"} in place of a list (docs/scene-format.md#buffers): NumPy's .npy, columns
// of .csv and .ply, or elements as they lie in memory. {"size": [480, 640]}: zeros.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/buffers/BufferFiles.h"
#include "scenefile/json/JsonValue.h"

#include <functional>
#include <string>

namespace rtsl::scene {

using runtime::BufferDescription;

/// Is it a buffer in a file, or of zeros? For the value of a member.
bool isBuffer(const JsonValue &value);

/// `resolve` makes a path as written one to open. Throws UnknownKey, WrongType, OutOfRange.
BufferDescription
readBufferDescription(const JsonValue &buffer,
                      const std::function<std::string(const JsonValue &)> &resolve);

} // namespace rtsl::scene
