//===- Samplers.h - images as objects of sampler2D and sampler3D ----------===//
#pragma once

#include "runtime/image/Texels.h"
#include "runtime/scene/SceneData.h"

#include <array>
#include <cstdint>

namespace rtsl::runtime {

// The numbers are those of library/std/images/ImageTexels.rtsl.
enum class Filter : std::uint8_t { Nearest = 0, Linear, Trilinear, Anisotropic };
enum class Wrap : std::uint8_t { Repeat = 0, Mirror, Clamp, Black };

/// How a sampler reads an image.
struct Sampling {
  Filter filter = Filter::Trilinear;
  std::array<Wrap, 3> wrap = {Wrap::Repeat, Wrap::Repeat, Wrap::Repeat}; // by axis
  std::uint32_t anisotropy = 16; // the most lookups along a footprint
};

/// The members of a sampler2D (depth 1) or sampler3D, for Scene::addObject. Filters beyond Linear
/// use the levels that the texels have. `withDirections`: with DirectionChances.h.
ObjectValues samplerValues(Texels texels, const Sampling &sampling, bool isVolume,
                           bool withDirections);

} // namespace rtsl::runtime
