//===- TransformReader.h - "transform" of a scene file --------------------===//
#pragma once

#include "runtime/geometry/Motion.h"
#include "scenefile/json/JsonValue.h"

namespace rtsl::scene {

/// An object with scale, rotate and translate (applied in this order) or with matrix; one with
/// keys, which are such objects; or a list of these, applied in the order of the list. Throws the
/// errors of Reader.h, and OutOfRange for a transform that flattens space.
///
/// Between keys, scales and translations are interpolated linearly, and rotations turn steadily:
/// about their axis if it is the same at all keys, by as many degrees as the angles differ;
/// otherwise by the shortest turn from one orientation to the next. The numbers of matrices are
/// interpolated linearly.
runtime::MovingTransform readTransform(const JsonValue &value);

} // namespace rtsl::scene
