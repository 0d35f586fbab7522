//===- DirectionChances.h - where an image of all directions is bright ----===//
//
// The distribution by which library/std/backgrounds/EnvironmentMap.rtsl draws directions: constant
// in each texel of an image of all directions (longitude, latitude), and in proportion to the
// luminance there (Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, 12.5).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/image/Texels.h"
#include "runtime/scene/Samplers.h"

#include <vector>

namespace rtsl::runtime {

/// The member `directionChances` of a sampler2D: by row the probability that this one or one before
/// it is drawn, then for each row the same of its columns. A texel's weight is the mean luminance
/// in it, as the sampler filters level 0, times its solid angle. Empty if the image is black.
std::vector<float> directionChances(const Texels &texels, const Sampling &sampling);

} // namespace rtsl::runtime
