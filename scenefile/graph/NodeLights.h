//===- NodeLights.h - lights in the scene graph ---------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <array>
#include <functional>
#include <vector>

namespace rtsl::scene {

/// A member of such a light that a transform changes, of the type vec3, and its default.
struct SpatialMember {
  const char *name;
  bool isPoint; // or a direction
  std::array<double, 3> otherwise;
  const char *ifMirrored = name; // the member that has the value if the transform mirrors
};

/// A member of a light and its value in world space.
struct PlacedMember {
  const char *name;
  std::array<double, 3> value;
};

/// All of the members of a light that a transform changes; `valueOf` gives their three numbers in
/// the space of the node. A transform that mirrors exchanges the sides of a RectangleLight, so that
/// it shines where an Emitter in its place does. Throws NotSupported, as requirePlaceable.
std::vector<PlacedMember>
placedMembers(const LocatedName &className, const runtime::Transform &toWorld,
              const std::function<std::vector<double>(const SpatialMember &)> &valueOf);

/// Throws NotSupported unless lights of this class may be in a node: those of the standard library
/// whose members say which of them are points and which directions.
void requirePlaceable(const LocatedName &className);

/// The light of a node for an instance of it: its points and directions in world space. New values
/// are owned by `scene`. Throws NotSupported if the instance moves.
ObjectDescription placedLight(const ObjectDescription &light, const runtime::MovingTransform &way,
                              SceneDescription &scene);

} // namespace rtsl::scene
