//===- EnterSpace.h - a ray enters an instance that has its own space -----===//
//
// What device::makeTriangleRay and device::enterInstance do, and a test of the box of everything in
// the space, with x, y and z in lanes of one register. The operations are those of
// runtime/device/traverse/Instance.h, BoxRange.h and Triangle.h, in the same order, and so are the
// bits. Rays that those treat separately, and instances that move, whose origin is NaN here, are
// left to them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/traverse/Instance.h"
#include "runtime/embree/EmbreeSpace.h"

#include <immintrin.h>

#include <cstdint>

namespace rtsl::runtime {

/// x, y and z; the fourth lane may be anything but denormal, which would be slow.
using Axes = __m128;

/// Reads four floats, of which the fourth may be any.
inline Axes axesAt(const float *first) {
  return _mm_blend_ps(_mm_loadu_ps(first), _mm_setzero_ps(), 8);
}
inline Axes absolute(Axes a) {
  return _mm_andnot_ps(_mm_set1_ps(-0.0f), a);
}
inline device::Vec3 vectorOf(Axes a) {
  return {a[0], a[1], a[2]};
}
/// Does the comparison hold for x, y and z?
inline bool holds(Axes comparison) {
  return (_mm_movemask_ps(comparison) & 7) == 7;
}

/// device::rangeInBox between 0 and infinity. `lower` is followed by a float, and `upper` follows
/// one.
[[gnu::always_inline]] inline device::Range rangeInBox(const float lower[3], const float upper[3],
                                                       Axes origin, Axes inverse) {
  const Axes low = axesAt(lower), beforeHigh = _mm_loadu_ps(upper - 1);
  const Axes high = _mm_shuffle_ps(beforeHigh, beforeHigh, _MM_SHUFFLE(0, 3, 2, 1));
  // Chosen by the sign of `inverse`: where it is -0, both products are zeros or NaN.
  const Axes first = (_mm_blendv_ps(low, high, inverse) - origin) * inverse;
  const Axes last = (_mm_blendv_ps(high, low, inverse) - origin) * inverse;
  const Axes near = _mm_max_ps(first, _mm_setzero_ps()); // 0 for NaN
  const Axes far = _mm_min_ps(last, _mm_set1_ps(device::infinity));
  return {device::maximum(device::maximum(near[0], near[1]), near[2]),
          device::minimum(device::minimum(far[0], far[1]), far[2])};
}

/// device::product.
[[gnu::always_inline]] inline Axes product(const double m[9], __m256d v) {
  const __m256d x = _mm256_permute4x64_pd(v, 0x00), y = _mm256_permute4x64_pd(v, 0x55),
                z = _mm256_permute4x64_pd(v, 0xaa);
  // A column and a double after it: of the next column, or EmbreeInstance::loadedToo.
  const __m256d first = _mm256_fmadd_pd(_mm256_loadu_pd(m), x, _mm256_setzero_pd());
  const __m256d second = _mm256_fmadd_pd(_mm256_loadu_pd(m + 3), y, first);
  return _mm256_cvtpd_ps(_mm256_fmadd_pd(_mm256_loadu_pd(m + 6), z, second));
}

/// TriangleRay::kz for a direction of finite components.
[[gnu::always_inline]] inline int longestAxis(Axes direction) {
  const Axes length = absolute(direction);
  const Axes isLonger = _mm_cmpgt_ps(_mm_shuffle_ps(length, length, _MM_SHUFFLE(3, 1, 0, 0)),
                                     _mm_shuffle_ps(length, length, _MM_SHUFFLE(3, 2, 2, 1)));
  // Bits: x is longer than y, x than z, y than z. Two bits of the constant for each combination.
  const unsigned combination = unsigned(_mm_movemask_ps(isLonger)) & 7;
  return int(0x192au >> 2 * combination & 3);
}

/// The numbers of device::TriangleRay that depend on the direction.
struct DirectionAxes {
  Axes direction, inverse;
  int longest;
  Axes turned; // the direction along kx, ky and kz

  [[gnu::always_inline]] explicit DirectionAxes(Axes direction)
      : direction(direction), inverse(_mm_set1_ps(1) / direction), longest(longestAxis(direction)),
        turned(along(direction)) {}

  /// The components along kx, ky and kz, without jumps, which would often be mispredicted.
  Axes along(Axes vector) const { return _mm_permutevar_ps(vector, _mm_load_si128(&order())); }
  /// Is its length one that makeTriangleRay does not treat separately?
  bool isUsual() const {
    const float length = __builtin_fabsf(turned[2]);
    return length > 0x1p-30f && length < 0x1p30f;
  }
  /// makeTriangleRay, if isUsual().
  [[gnu::always_inline]] void fill(device::TriangleRay &ray, Axes origin) const {
    ray.origin = vectorOf(origin);
    ray.direction = vectorOf(direction);
    ray.inverse = vectorOf(inverse);
    ray.kx = axes[longest][0];
    ray.ky = axes[longest][1];
    ray.kz = longest;
    ray.turned = vectorOf(along(origin));
    ray.sz = along(inverse)[2];
    ray.sx = turned[0] * ray.sz;
    ray.sy = turned[1] * ray.sz;
    ray.directionExponent = 0;
  }

private:
  alignas(16) static constexpr std::int32_t axes[3][4] = {{1, 2, 0, 0}, {2, 0, 1, 0}, {0, 1, 2, 0}};
  const __m128i &order() const { return *reinterpret_cast<const __m128i *>(axes[longest]); }
};

/// Three floats that have just been stored, one by one: a load of several at once, which the
/// compiler would make of these, waits until the stores have left the processor.
[[gnu::always_inline]] inline Axes gathered(const float from[3]) {
  float x = from[0], y = from[1], z = from[2];
  asm("" : "+x"(x), "+x"(y), "+x"(z));
  return _mm_setr_ps(x, y, z, 0);
}

/// device::makeTriangleRay for a ray whose components have just been stored.
[[gnu::always_inline]] inline void makeRay(const float origin[3], const float direction[3],
                                           device::TriangleRay &ray) {
  const DirectionAxes axes(gathered(direction));
  if (axes.isUsual())
    axes.fill(ray, gathered(origin));
  else
    ray = device::makeTriangleRay(device::load(origin), device::load(direction));
}

/// Does the ray enter the box of the space before `limit`? It is that of a tree's root, tested
/// before Embree begins, and turns with the instance, whose box in world space may be larger.
inline bool entersBounds(device::Range inBounds, float epsilon, float limit) {
  return !inBounds.isEmpty() && inBounds.near <= limit * device::cullSlack &&
         inBounds.far >= epsilon * (1 - 2 * device::rangeShare);
}

/// For any ray and any instance.
[[gnu::cold, gnu::noinline]] inline bool enterAnySpace(const RtslLaunch &launch,
                                                       const device::TriangleRay &world,
                                                       std::uint32_t number, const RtslBox &bounds,
                                                       float time, float epsilon, float limit,
                                                       device::InstanceRay &entered) {
  return device::enterInstance(launch, world, number, time, epsilon, limit, entered) &&
         entersBounds(device::rangeInBox(bounds.lower, bounds.upper, entered.origin,
                                         entered.inverse, 0, device::infinity),
                      epsilon, limit);
}

/// The part of the ray in the box of an instance in world space, widened. False: there is none
/// between `epsilon` and `limit`.
[[gnu::always_inline]] inline bool reachBox(const device::TriangleRay &world,
                                            const EmbreeInstance &instance, float epsilon,
                                            float limit, device::Range &inBox) {
  const device::Range range =
      rangeInBox(instance.lower, instance.upper, axesAt(&world.origin.x), axesAt(&world.inverse.x));
  if (range.isEmpty())
    return false;
  inBox = range.widened();
  return !(inBox.near > limit || inBox.far < epsilon);
}

/// The ray in the object space of an instance, as device::enterInstance computes it; `inBox` is
/// that of reachBox. False if it hits nothing there before `limit`.
[[gnu::always_inline]] inline bool enterSpace(const RtslLaunch &launch,
                                              const device::TriangleRay &world,
                                              const EmbreeInstance &instance, device::Range inBox,
                                              float time, float epsilon, float limit,
                                              device::InstanceRay &entered) {
  const std::uint32_t number = instance.instance;
  const RtslBox &bounds = instance.inside->bounds;
  const Axes worldOrigin = axesAt(&world.origin.x);
  const Axes origin = product(instance.inverse, _mm256_cvtps_pd(worldOrigin) -
                                                    _mm256_cvtps_pd(axesAt(instance.translation)));
  const Axes direction = product(instance.inverse, _mm256_cvtps_pd(axesAt(&world.direction.x)));
  const DirectionAxes axes(direction);
  if (!holds(_mm_cmplt_ps(absolute(origin), _mm_set1_ps(device::infinity))) || !axes.isUsual())
    return enterAnySpace(launch, world, number, bounds, time, epsilon, limit, entered);
  if (!entersBounds(rangeInBox(bounds.lower, bounds.upper, origin, axes.inverse), epsilon, limit))
    return false;
  axes.fill(entered, origin);
  entered.instance = number;
  entered.range = inBox;
  return true;
}

} // namespace rtsl::runtime
