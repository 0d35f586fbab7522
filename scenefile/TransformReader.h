//===- TransformReader.h - "transform" of a scene file --------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "scenefile/JsonValue.h"

namespace rtsl::scene {

/// An object with scale, rotate and translate (applied in this order) or with matrix; or a list of
/// such objects, applied in the order of the list. Throws the errors of Reader.h, and OutOfRange
/// for a transform that flattens space.
runtime::Transform readTransform(const JsonValue &value);

} // namespace rtsl::scene
