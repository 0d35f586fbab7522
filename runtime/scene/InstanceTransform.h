//===- InstanceTransform.h - transforms and boxes of instances ------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/geometry/Mesh.h"
#include "runtime/geometry/Motion.h"
#include "runtime/scene/SceneData.h"
#include "support/Error.h"

#include <optional>
#include <string>

namespace rtsl::runtime {

/// A transform must not stretch one direction more than about this many times as much as another:
/// its inverse would be off by more than a rounding of a float.
constexpr double largestCondition = 1e8;

RtslTransform identityTransform();

/// The transform as it is stored, with its inverse. Throws DegenerateGeometry, for the instance of
/// this name: a number is not finite in single precision, or the condition exceeds
/// largestCondition. One that moves is checked at its keys and at some times between them, and
/// RtslTransform::motion is left at 0.
RtslTransform roundedTransform(const MovingTransform &transform, const std::string &name,
                               const std::optional<Place> &place);

/// Sets the box for traversal from the bounds in object space, without a transform.
void setWorldBounds(RtslInstance &instance, const Bounds &bounds);
/// The same for an instance with this transform, at all times between two.
void setWorldBounds(RtslInstance &instance, const Bounds &bounds, const MovingTransform &transform,
                    float begin, float end);

/// The smallest box around the vertices that triangles use, at all keys.
Bounds boundsOf(const Mesh &mesh);

} // namespace rtsl::runtime
