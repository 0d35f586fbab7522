//===- Radiance.h - what one sample of one pixel sees ---------------------===//
#pragma once

#include "Scene.h"

#include <cstdint>

namespace handwritten {

/// The color of sample `index` of pixel (x, y), row 0 on top.
vec3 sample(const Scene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index);

/// The compiler options of the code of `sample`.
const char *compilerFlags();

} // namespace handwritten
