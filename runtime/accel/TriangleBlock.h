//===- TriangleBlock.h - eight triangles, tested at once ------------------===//
//
// A leaf of the host's tree. All eight are tested by the operations of
// runtime/device/traverse/Triangle.h and moveIntoBox (runtime/device/traverse/TestItem.h), in the
// same order, and so with the same bits. In the cases that those treat separately, numbers of
// unusual size or hits near the ray's origin, the triangle is tested by their own functions.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/traverse/TestItem.h"

#include <immintrin.h>

#include <cstdint>

namespace rtsl::runtime {

struct alignas(32) TriangleBlock {
  static constexpr unsigned lanes = RTSL_VERTEX_STRIDE;

  float vertices[3][3][lanes]; // [vertex][axis]; an empty lane repeats another one
  // RTSL_NO_HIT: the lane is empty. Otherwise 0 in the block of a mesh that instances share
  std::uint32_t instance[lanes];
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

  /// The lanes that are not empty.
  unsigned used() const {
    const __m256i none = _mm256_set1_epi32(int(RTSL_NO_HIT)),
                  all = _mm256_load_si256(reinterpret_cast<const __m256i *>(instance));
    return ~unsigned(_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(all, none)))) &
           0xffu;
  }

  device::TriangleVertices lane(unsigned i) const {
    auto vertex = [&](int n) -> device::Vec3 {
      return {vertices[n][0][i], vertices[n][1][i], vertices[n][2][i]};
    };
    return {vertex(0), vertex(1), vertex(2)};
  }
};

/// One float in each lane.
using Lanes = __m256;

inline Lanes all(float a) {
  return _mm256_set1_ps(a);
}
inline Lanes absolute(Lanes a) {
  return _mm256_andnot_ps(all(-0.0f), a);
}
/// maximum and minimum of runtime/device/ray/Vector.h.
inline Lanes maximum(Lanes a, Lanes b) {
  return _mm256_max_ps(a, b);
}
inline Lanes minimum(Lanes a, Lanes b) {
  return _mm256_min_ps(a, b);
}
inline Lanes maximum(Lanes a, Lanes b, Lanes c) {
  return maximum(maximum(a, b), c);
}
inline Lanes minimum(Lanes a, Lanes b, Lanes c) {
  return minimum(minimum(a, b), c);
}

/// a b - c d as differenceOfProducts of runtime/device/ray/Vector.h computes it.
inline Lanes differenceOfProducts(Lanes a, Lanes b, Lanes c, Lanes d) {
  const Lanes cd = c * d;
  const Lanes error = _mm256_fnmadd_ps(c, d, cd);
  return _mm256_fmsub_ps(a, b, cd) + error;
}

/// device::depthNearOrigin with the scale 1, for the four lanes from `first` on.
[[gnu::always_inline]] inline __m128 fourDepthsNearOrigin(const device::TriangleRay &ray,
                                                          const TriangleBlock &block,
                                                          unsigned first, __m128 depth) {
  using Doubles = __m256d;
  const auto all = [](float a) { return _mm256_set1_pd(double(a)); };
  const auto along = [&](int vertex, int axis) {
    return _mm256_cvtps_pd(_mm_load_ps(&block.vertices[vertex][axis][first]));
  };
  const Doubles vx = along(0, ray.kx), vy = along(0, ray.ky), vz = along(0, ray.kz);
  const Doubles ax = vx - all(ray.turned.x), ay = vy - all(ray.turned.y),
                az = vz - all(ray.turned.z);
  const Doubles bx = along(1, ray.kx) - vx, by = along(1, ray.ky) - vy, bz = along(1, ray.kz) - vz;
  const Doubles cx = along(2, ray.kx) - vx, cy = along(2, ray.ky) - vy, cz = along(2, ray.kz) - vz;
  const Doubles nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  const Doubles down = (nx * all(ray.sx) + ny * all(ray.sy)) + nz;
  const __m128 computed = _mm256_cvtpd_ps(((nx * ax + ny * ay) + nz * az) / down);
  const __m256i isDown =
      _mm256_castpd_si256(_mm256_cmp_pd(down, _mm256_setzero_pd(), _CMP_NEQ_UQ)); // of 64 bits each
  const __m128i low = _mm256_castsi256_si128(isDown), high = _mm256_extracti128_si256(isDown, 1);
  return _mm_blendv_ps(depth, computed, _mm_castsi128_ps(_mm_packs_epi32(low, high)));
}

/// The same for all lanes, of which those with hits near the ray's origin are the bits of `near`.
[[gnu::noinline]] inline Lanes depthsNearOrigin(const device::TriangleRay &ray,
                                                const TriangleBlock &block, unsigned near,
                                                Lanes depth) {
  __m128 low = _mm256_castps256_ps128(depth), high = _mm256_extractf128_ps(depth, 1);
  if (near & 0xfu)
    low = fourDepthsNearOrigin(ray, block, 0, low);
  if (near & 0xf0u)
    high = fourDepthsNearOrigin(ray, block, 4, high);
  return _mm256_set_m128(high, low);
}

/// The intersections of a ray with the planes of triangles, and the lanes with a hit.
struct LaneHits {
  Lanes t, u, v;
  Lanes determinant; // its sign is that of TriangleHit::isBack, if the ray goes up its axis
  unsigned hit;      // t, u and v are valid, before moveIntoBox; none of them is empty
  unsigned other;    // lanes to be tested by device::testTriangle; the same
};

/// intersectTriangle for all lanes.
[[gnu::always_inline]] inline LaneHits intersectLanes(const device::TriangleRay &ray,
                                                      const TriangleBlock &block) {
  const Lanes ox = all(ray.turned.x), oy = all(ray.turned.y), oz = all(ray.turned.z);
  const Lanes sx = all(ray.sx), sy = all(ray.sy);
  Lanes x[3], y[3], z[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const auto &vertex = block.vertices[i];
    z[i] = _mm256_load_ps(vertex[ray.kz]) - oz;
    x[i] = (_mm256_load_ps(vertex[ray.kx]) - ox) - sx * z[i];
    y[i] = (_mm256_load_ps(vertex[ray.ky]) - oy) - sy * z[i];
  }
  const Lanes e0 = differenceOfProducts(x[2], y[1], y[2], x[1]);
  const Lanes e1 = differenceOfProducts(x[0], y[2], y[0], x[2]);
  const Lanes e2 = differenceOfProducts(x[1], y[0], y[1], x[0]);
  const Lanes zero = _mm256_setzero_ps();
  const Lanes isInside = _mm256_or_ps(_mm256_cmp_ps(minimum(e0, e1, e2), zero, _CMP_GE_OQ),
                                      _mm256_cmp_ps(maximum(e0, e1, e2), zero, _CMP_LE_OQ));
  // Coordinates of meshes and origins are below 2^60 here; smaller ones are scaled in
  // intersectTriangle.
  const Lanes size = maximum(maximum(absolute(x[0]), absolute(x[1]), absolute(x[2])),
                             maximum(absolute(y[0]), absolute(y[1]), absolute(y[2])));
  const Lanes isUsual = _mm256_and_ps(_mm256_cmp_ps(size, all(0x1p-30f), _CMP_GT_OQ),
                                      _mm256_cmp_ps(size, all(0x1p30f), _CMP_LT_OQ));
  LaneHits hits;
  hits.other = ~unsigned(_mm256_movemask_ps(isUsual)) & 0xffu;
  hits.hit = unsigned(_mm256_movemask_ps(isInside)) & ~hits.other;
  if ((hits.hit | hits.other) == 0)
    return hits;
  const unsigned used = block.used();
  hits.hit &= used;
  hits.other &= used;

  const Lanes determinant = hits.determinant = (e0 + e1) + e2;
  const Lanes deepest = maximum(absolute(z[0]), absolute(z[1]), absolute(z[2]));
  // Depths that are all 0 are not scaled either: a floor along two axes, and a ray that leaves it.
  const Lanes needsNoScale =
      _mm256_and_ps(_mm256_or_ps(_mm256_cmp_ps(deepest, all(0x1p-30f), _CMP_GT_OQ),
                                 _mm256_cmp_ps(deepest, zero, _CMP_EQ_OQ)),
                    _mm256_cmp_ps(deepest, all(0x1p30f), _CMP_LT_OQ));
  const Lanes isUsualDepth =
      _mm256_and_ps(_mm256_cmp_ps(determinant, zero, _CMP_NEQ_OQ), needsNoScale);
  const unsigned usualDepth = unsigned(_mm256_movemask_ps(isUsualDepth));
  hits.other |= hits.hit & ~usualDepth;
  hits.hit &= usualDepth;

  const Lanes reciprocal = all(1.0f) / determinant;
  Lanes depth = ((e0 * z[0] + e1 * z[1]) + e2 * z[2]) * reciprocal;
  const Lanes isNear =
      _mm256_cmp_ps(absolute(depth), all(device::nearShare) * (size + deepest), _CMP_LT_OQ);
  if (const unsigned near = hits.hit & unsigned(_mm256_movemask_ps(isNear)))
    depth = _mm256_blendv_ps(depth, depthsNearOrigin(ray, block, near, depth), isNear);
  hits.t = depth * all(ray.sz);
  hits.u = e1 * reciprocal;
  hits.v = e2 * reciprocal;
  return hits;
}

/// device::movedInto for all lanes.
inline Lanes movedInto(Lanes near, Lanes far, Lanes t) {
  const Lanes notBehind = _mm256_blendv_ps(t, far, _mm256_cmp_ps(t, far, _CMP_GT_OQ));
  return _mm256_blendv_ps(notBehind, near, _mm256_cmp_ps(t, near, _CMP_LT_OQ));
}

/// moveIntoBox for all lanes. Returns the lanes of `hit` that meet their box.
[[gnu::always_inline]] inline unsigned moveLanesIntoBoxes(const device::TriangleRay &ray,
                                                          const TriangleBlock &block, Lanes &t) {
  Lanes near = _mm256_setzero_ps(), far = all(device::infinity);
#pragma GCC unroll 3
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes a = _mm256_load_ps(block.vertices[0][axis]),
                b = _mm256_load_ps(block.vertices[1][axis]),
                c = _mm256_load_ps(block.vertices[2][axis]);
    const Lanes lower = minimum(a, b, c), upper = maximum(a, b, c);
    const float inverse = ray.inverse[axis];
    const Lanes origin = all(ray.origin[axis]);
    const Lanes first = _mm256_blendv_ps(lower, upper, all(inverse)) - origin,
                last = _mm256_blendv_ps(upper, lower, all(inverse)) - origin;
    near = maximum(first * all(inverse), near);
    far = minimum(last * all(inverse), far);
  }
  const Lanes isMet = _mm256_cmp_ps(near, far * all(device::bvhSlack), _CMP_LE_OQ);
  t = movedInto(near * all(1.0f - device::rangeShare), far * all(1.0f + device::rangeShare), t);
  return unsigned(_mm256_movemask_ps(isMet));
}

/// device::moveIntoInstance for all lanes.
inline Lanes moveLanesIntoInstance(const device::TriangleRay &, Lanes t) {
  return t;
}
inline Lanes moveLanesIntoInstance(const device::InstanceRay &ray, Lanes t) {
  return movedInto(all(ray.range.near), all(ray.range.far), t);
}

/// The lanes of TriangleHit::isBack.
inline unsigned backsOf(const device::TriangleRay &ray, const LaneHits &hits) {
  const unsigned negative = unsigned(
      _mm256_movemask_ps(_mm256_cmp_ps(hits.determinant, _mm256_setzero_ps(), _CMP_LT_OQ)));
  return ray.sz < 0 ? ~negative : negative;
}

/// device::testTriangle for one lane.
template <typename Ray>
[[gnu::cold, gnu::noinline]] bool testLane(RtslState &state, const Ray &ray,
                                           const TriangleBlock &block, unsigned i) {
  return device::testTriangle(state, ray, block.lane(i), device::instanceOf(ray, block.instance[i]),
                              block.triangle[i]);
}

/// Tests all triangles of the block and commits the one that wins. With `anyHit` any hit is
/// sufficient. `Ray` is a device::TriangleRay, or a device::InstanceRay for the block of a mesh
/// that instances share.
template <typename Ray>
[[gnu::always_inline]] inline bool testBlock(RtslState &state, const Ray &ray,
                                             const TriangleBlock &block, bool anyHit) {
  LaneHits hits = intersectLanes(ray, block);
  if ((hits.hit | hits.other) == 0)
    return false;
  if (__builtin_expect(ray.directionExponent != 0, 0)) {
    hits.other |= hits.hit;
    hits.hit = 0;
  }
  bool found = false;
  if (hits.hit) {
    const unsigned met = moveLanesIntoBoxes(ray, block, hits.t);
    hits.t = moveLanesIntoInstance(ray, hits.t);
    const Lanes mayWin = _mm256_and_ps(_mm256_cmp_ps(hits.t, all(state.Epsilon), _CMP_GT_OQ),
                                       _mm256_cmp_ps(hits.t, all(state.nearest), _CMP_LE_OQ));
    alignas(32) float t[TriangleBlock::lanes], u[TriangleBlock::lanes], v[TriangleBlock::lanes];
    unsigned lanes = hits.hit & met & unsigned(_mm256_movemask_ps(mayWin));
    if (lanes) {
      _mm256_store_ps(t, hits.t);
      _mm256_store_ps(u, hits.u);
      _mm256_store_ps(v, hits.v);
    }
    for (; lanes != 0; lanes &= lanes - 1) {
      const unsigned i = unsigned(__builtin_ctz(lanes));
      const std::uint32_t instance = device::instanceOf(ray, block.instance[i]);
      if (!device::wins(state, t[i], instance, block.triangle[i]))
        continue;
      if (device::hasNoBacks(*state.launch, instance) && (backsOf(ray, hits) >> i & 1) != 0)
        continue;
      device::commit(state, t[i], t[i], instance, block.triangle[i]);
      state.u = u[i];
      state.v = v[i];
      device::keepVertices(state, &block.vertices[0][0][i]);
      found = true;
      if (anyHit)
        return true;
    }
  }
  for (unsigned lanes = hits.other; __builtin_expect(lanes != 0, 0); lanes &= lanes - 1)
    found |= testLane(state, ray, block, unsigned(__builtin_ctz(lanes)));
  return found;
}

} // namespace rtsl::runtime
