//===- BoxRuns.h - neighbouring triangles together ------------------------===//
#pragma once

#include "support/LargeArray.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// A triangle of one of several meshes, and its box. No coordinate is beyond 1e18.
struct alignas(32) TriangleBox {
  float lower[3];
  std::uint32_t mesh;
  float upper[3];
  std::uint32_t triangle;
};

/// Boxes that are close together.
struct BoxRun {
  std::size_t first;
  unsigned length;
};

constexpr unsigned longestRun = 8;

/// Sorts boxes so that each run of up to `longestRun` has a small surface, and most are full. The
/// result does not depend on the number of threads; 0: one per core.
std::vector<BoxRun> sortIntoRuns(LargeArray<TriangleBox> &boxes, unsigned threads);

} // namespace rtsl::runtime
