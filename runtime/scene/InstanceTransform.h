//===- InstanceTransform.h - transforms and boxes of instances ------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/geometry/Mesh.h"
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
/// largestCondition.
RtslTransform roundedTransform(const Transform &transform, const std::string &name,
                               const std::optional<Place> &place);

/// Sets the box for traversal from the bounds in object space.
void setWorldBounds(RtslInstance &instance, const Bounds &bounds, const RtslTransform &transform);

/// The smallest box around the vertices that triangles use.
Bounds boundsOf(const Mesh &mesh);

} // namespace rtsl::runtime
