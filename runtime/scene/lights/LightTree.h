//===- LightTree.h - building a tree of lamps -----------------------------===//
//
// The tree of runtime/device/engines/LightTree.h, top down. A node is divided where the sum over
// both sides of power times the square of the size times a measure of how much the normals spread
// is least (after Conty Estevez and Kulla, 2018). Only operations that are exact or correctly
// rounded are used, so that the tree is the same on all machines.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// An emitter, or a part of one.
struct Lamp {
  std::array<double, 3> lower, upper; // its box in world space, at all times
  std::array<double, 3> axis;  // its normal, of length 1; 0: it has normals of all directions
  bool isTwoSided;             // of a normal: it shines on both sides
  double power;                // above 0
  std::uint32_t emitter, part; // part: or RTSL_WHOLE_EMITTER
};

/// The nodes, for at least one lamp. Boxes that are not finite or huge are cut off.
std::vector<RtslLightNode> buildLightTree(std::vector<Lamp> lamps);

} // namespace rtsl::runtime
