//===- ListTraversal.cpp - rays of the host in a scene of few primitives --===//
//
// Linked into programs for the host that are bound to a scene of a few primitives: there a ray
// tests the boxes of all of them, eight at a time, and then the primitives whose boxes it enters.
// The boxes are those of any other traversal, so that each primitive has the same range in its own.
// That takes less time than a search of Embree's tree, which calls back for each primitive, because
// `intersect` is part of the same code. Rays that may not see all instances, or whose hits may be
// rejected, and bad rays, are passed on.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/traverse/EightRanges.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/device/traverse/Traverse.h"

using namespace rtsl;

namespace {

constexpr uint32_t lanes = 8, mostBoxes = 32;

/// What the test of a box needs of a ray: its numbers for triangles, which a list does not have,
/// are not computed.
struct BoxRay {
  device::Vec3 origin, inverse;
};

/// The instances of the program: a constant, and so is all that is loaded from it here.
struct Instances {
  const RtslInstance *all;
  uint32_t count;

  /// One number of the instances from `first` on, number(instance); beyond the end that of the
  /// first instance.
  template <typename Number>
  __m256 from(uint32_t first, Number number) const {
    __m256 numbers;
    for (uint32_t i = 0; i < lanes; ++i)
      numbers[i] = number(all[first + i < count ? first + i : 0]);
    return numbers;
  }
};

/// Where hits in the boxes of the instances may be, by number.
struct Ranges {
  float near[mostBoxes], far[mostBoxes];

  /// With --fp=fast hits count where they are, as in hasHitsIn of TestItem.h.
  device::Range of(uint32_t number) const {
    return rtsl_is_fast() ? device::Range{-device::infinity, device::infinity}
                          : device::Range{near[number], far[number]};
  }
};

/// Stores the ranges of the instances from `first` on. Returns, as bits, which of them are not
/// empty and have a part between tMin and tMax.
uint32_t enter(const BoxRay &ray, const Instances &instances, uint32_t first, float tMin,
               float tMax, Ranges &ranges) {
  device::EightRanges eight;
  const auto narrow = [&](float origin, float inverse, int axis) {
    const __m256 low = instances.from(first, [&](const RtslInstance &i) { return i.lower[axis]; }),
                 high = instances.from(first, [&](const RtslInstance &i) { return i.upper[axis]; });
    // Of lanes, because the sign cannot be predicted.
    const __m256 isTurned = _mm256_cmp_ps(_mm256_set1_ps(inverse), _mm256_setzero_ps(), _CMP_LT_OQ);
    eight.narrow(_mm256_blendv_ps(low, high, isTurned), _mm256_blendv_ps(high, low, isTurned),
                 origin, inverse);
  };
  narrow(ray.origin.x, ray.inverse.x, 0);
  narrow(ray.origin.y, ray.inverse.y, 1);
  narrow(ray.origin.z, ray.inverse.z, 2);
  const uint32_t entered = eight.widen(tMin, tMax);
  _mm256_storeu_ps(ranges.near + first, eight.near);
  _mm256_storeu_ps(ranges.far + first, eight.far);
  return entered;
}

} // namespace

extern "C" {

/// The host's rtsl_traverse (runtime/embree/HostTraversal.cpp), under another name.
uint32_t rtsl_traverse_tree(RtslState *state, uint32_t how);

/// The instances whose boxes the ray enters between tMin and tMax, as bits. Separate, because
/// vectors in other functions are split (codegen/emit/LlvmModule.cpp).
__attribute__((noinline)) uint32_t rtsl_entered_boxes(const RtslLaunch *launch, const BoxRay *ray,
                                                      float tMin, float tMax, Ranges *ranges) {
  const Instances instances = {rtsl_instances(launch), rtsl_listed_instances(launch)};
  uint32_t entered = 0;
#pragma clang loop unroll(full)
  for (uint32_t first = 0; first < mostBoxes; first += lanes)
    if (first < instances.count)
      entered |= enter(*ray, instances, first, tMin, tMax, *ranges) << first;
  return instances.count < mostBoxes ? entered & ((1u << instances.count) - 1) : entered;
}

} // extern "C"

namespace {

/// The list of the launch, in place of a tree (LaunchTree.h).
struct List {
  template <typename Limit, typename Enter, typename Visit>
  void forEach(const RtslState &state, const device::TriangleRay &ray, Limit limit, Enter,
               Visit visit) const {
    const BoxRay boxRay = {ray.origin, ray.inverse};
    Ranges ranges;
    uint32_t entered = rtsl_entered_boxes(state.launch, &boxRay, state.Epsilon, limit(), &ranges);
    while (entered) {
      const auto number = uint32_t(__builtin_ctz(entered));
      const device::EnteredItem item = {{number, 0}, ranges.of(number)};
      entered &= entered - 1;
      if (visit(item, ray))
        return;
    }
  }
};

} // namespace

extern "C" uint32_t rtsl_traverse(RtslState *state, uint32_t how) {
  constexpr uint32_t hides = RTSL_HAS_ROOTS | RTSL_HAS_SELECTORS | RTSL_HAS_MASKS;
  if (rtsl_needs(state->launch) & hides || how & RTSL_INVOKE_ANY_HIT || state->rayMask != ~0u ||
      state->rayRoot != 0 || !device::isGoodRay(*state))
    return rtsl_traverse_tree(state, how);
  return device::findHit(*state, how, device::LinkedSlots(), List());
}
