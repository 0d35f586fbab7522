//===- Radiance.h - what one sample of one pixel sees ---------------------===//
#pragma once

#include "Scene.h"

#include <cstdint>

namespace handwritten {

/// What is the same for all samples of a picture.
struct Picture {
  std::uint32_t width = 960, height = 540;
  std::uint32_t samplesPerPixel = 16;
  std::uint32_t maxDepth = 8; // 0: camera rays only
  std::uint32_t seed = 1;
};

/// The color of sample `index` of pixel (x, y), row 0 on top.
vec3 sample(const Scene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index);

/// What the compiler was told for the code behind `sample`.
const char *compilerFlags();

} // namespace handwritten
