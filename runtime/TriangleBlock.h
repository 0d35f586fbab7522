//===- TriangleBlock.h - eight triangles, tested at once ------------------===//
//
// What lies in a leaf of the host's tree. The edge tests of runtime/device/Triangle.h are made for
// all eight, with the same operations in the same order, and so with the same bits; what passes them
// is tested by that file's own function, which also computes t, u and v.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/Traverse.h"

#include <immintrin.h>

#include <cstdint>

namespace rtsl::runtime {

struct alignas(32) TriangleBlock {
  static constexpr unsigned lanes = 8;

  float vertices[3][3][lanes]; // [vertex][axis]; an empty lane has the vertices of another one
  std::uint32_t instance[lanes]; // RTSL_NO_HIT: the lane is empty
  std::uint32_t triangle[lanes];

  void setLane(unsigned lane, const device::TriangleVertices &p, std::uint32_t of,
               std::uint32_t number) {
    for (int axis = 0; axis < 3; ++axis) {
      vertices[0][axis][lane] = p.v0[axis];
      vertices[1][axis][lane] = p.v1[axis];
      vertices[2][axis][lane] = p.v2[axis];
    }
    instance[lane] = of;
    triangle[lane] = number;
  }

  device::TriangleVertices lane(unsigned i) const {
    auto vertex = [&](int n) -> device::Vec3 {
      return {vertices[n][0][i], vertices[n][1][i], vertices[n][2][i]};
    };
    return {vertex(0), vertex(1), vertex(2)};
  }
};

/// a b - c d as differenceOfProducts of runtime/device/Vector.h computes it.
inline __m256 differenceOfProducts(__m256 a, __m256 b, __m256 c, __m256 d) {
  __m256 cd = _mm256_mul_ps(c, d);
  __m256 error = _mm256_fnmadd_ps(c, d, cd);
  return _mm256_add_ps(_mm256_fmsub_ps(a, b, cd), error);
}

/// The lanes that the ray's line may go through, as bits: all that intersectTriangle accepts, and
/// some more.
inline unsigned lanesOnLine(const device::TriangleRay &ray, const TriangleBlock &block) {
  const __m256 ox = _mm256_set1_ps(ray.turned.x), oy = _mm256_set1_ps(ray.turned.y),
               oz = _mm256_set1_ps(ray.turned.z);
  const __m256 sx = _mm256_set1_ps(ray.sx), sy = _mm256_set1_ps(ray.sy);
  __m256 x[3], y[3];
  for (int i = 0; i < 3; ++i) {
    const auto &vertex = block.vertices[i];
    const __m256 z = _mm256_sub_ps(_mm256_load_ps(vertex[ray.kz]), oz);
    x[i] = _mm256_sub_ps(_mm256_sub_ps(_mm256_load_ps(vertex[ray.kx]), ox), _mm256_mul_ps(sx, z));
    y[i] = _mm256_sub_ps(_mm256_sub_ps(_mm256_load_ps(vertex[ray.ky]), oy), _mm256_mul_ps(sy, z));
  }
  const __m256 e0 = differenceOfProducts(x[2], y[1], y[2], x[1]);
  const __m256 e1 = differenceOfProducts(x[0], y[2], y[0], x[2]);
  const __m256 e2 = differenceOfProducts(x[1], y[0], y[1], x[0]);

  const __m256 zero = _mm256_setzero_ps();
  const __m256 least = _mm256_min_ps(_mm256_min_ps(e0, e1), e2);
  const __m256 greatest = _mm256_max_ps(_mm256_max_ps(e0, e1), e2);
  const __m256 isInside = _mm256_or_ps(_mm256_cmp_ps(least, zero, _CMP_GE_OQ),
                                       _mm256_cmp_ps(greatest, zero, _CMP_LE_OQ));
  // Products so small that signs may be wrong: intersectTriangle scales them first. None is too large:
  // coordinates of meshes and of origins that come here are below 2^60.
  const __m256 size = _mm256_max_ps(greatest, _mm256_sub_ps(zero, least));
  const __m256 isSmall = _mm256_cmp_ps(size, _mm256_set1_ps(0x1p-58f), _CMP_LT_OQ);
  return unsigned(_mm256_movemask_ps(_mm256_or_ps(isInside, isSmall)));
}

/// Tests all triangles of the block and commits the one that wins. With `anyHit` the first will do.
inline bool testBlock(RtslState &state, const device::TriangleRay &ray, const TriangleBlock &block,
                      bool anyHit) {
  bool found = false;
  for (unsigned lanes = lanesOnLine(ray, block); lanes != 0; lanes &= lanes - 1) {
    const unsigned i = unsigned(__builtin_ctz(lanes));
    if (block.instance[i] == RTSL_NO_HIT)
      continue;
    found |= device::testTriangle(state, ray, block.lane(i), block.instance[i], block.triangle[i]);
    if (found && anyHit)
      break;
  }
  return found;
}

} // namespace rtsl::runtime
