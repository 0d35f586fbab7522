//===- NodeLights.h - lights in the scene graph ---------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <array>
#include <vector>

namespace rtsl::scene {

/// A member of such a light that a transform changes, of the type vec3, and its default.
struct SpatialMember {
  const char *name;
  bool isPoint; // or a direction
  std::array<double, 3> otherwise;

  /// The value in world space.
  std::array<double, 3> moved(const std::vector<double> &value,
                              const runtime::Transform &toWorld) const;
};

/// Throws NotSupported, as requirePlaceable.
const std::vector<SpatialMember> &spatialMembers(const LocatedName &className);

/// Throws NotSupported unless lights of this class may be in a node: those of the standard library
/// whose members say which of them are points and which directions.
void requirePlaceable(const LocatedName &className);

/// The light of a node for an instance of it: its points and directions in world space. New values
/// are owned by `scene`. Throws NotSupported if the instance moves.
ObjectDescription placedLight(const ObjectDescription &light, const runtime::MovingTransform &way,
                              SceneDescription &scene);

} // namespace rtsl::scene
