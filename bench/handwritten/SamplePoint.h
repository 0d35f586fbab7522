//===- SamplePoint.h - where a sample lies, as rtslc chooses it -----------===//
#pragma once

#include "Picture.h"

#include "runtime/device/ray/Random.h"

#include <cstdint>

namespace handwritten {

/// A sample's point of the picture, in [0, 1]^2 from its upper left corner, and the words that its
/// random numbers begin with.
struct SamplePoint {
  float right, down;
  rtsl::device::Words4 words;
};

inline SamplePoint samplePoint(const Picture &picture, std::uint32_t x, std::uint32_t y,
                               std::uint32_t index) {
  using namespace rtsl::device;
  const Words4 shift = hash4(x, y, 0xffffffffu, picture.seed); // the same for the whole pixel
  float jitterX, jitterY;
  pixelSample(index, shift.x, shift.y, &jitterX, &jitterY);
  return {(float(x) + jitterX) / float(picture.width), (float(y) + jitterY) / float(picture.height),
          hash4(x, y, index, picture.seed)};
}

} // namespace handwritten
