//===- ListTraversal.cpp - rays of the host in a scene of few primitives --===//
//
// Linked into programs for the host that are bound to a scene of a few primitives: there a ray
// tests the boxes of all of them, eight at a time, and then the primitives whose boxes it enters.
// That takes less time than a search of Embree's tree, which calls back for each primitive, because
// `intersect` is part of the same code. Rays that may not see all instances, or whose hits may be
// rejected, and bad rays, are passed on.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/ray/ListedBox.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/device/traverse/Traverse.h"

using namespace rtsl;

namespace {

constexpr uint32_t lanes = 8, mostBoxes = 32;

/// A number of each of eight boxes.
typedef float Lanes __attribute__((ext_vector_type(lanes)));
typedef bool Bits __attribute__((ext_vector_type(lanes)));

Lanes fused(Lanes a, Lanes b, Lanes c) {
  return __builtin_elementwise_fma(a, b, c);
}

/// device::raised and lowered.
Lanes raised(Lanes limit, Lanes x) {
  return x > limit ? x : limit;
}
Lanes lowered(Lanes limit, Lanes x) {
  return x < limit ? x : limit;
}

/// The boxes of the program: a constant, and so is all that is loaded from it here.
struct Boxes {
  const RtslListedBox *all;
  uint32_t count;

  /// One number of the boxes from `first` on, number(box); beyond the end that of the first box.
  template <typename Number>
  Lanes from(uint32_t first, Number number) const {
    Lanes numbers;
    for (uint32_t i = 0; i < lanes; ++i)
      numbers[i] = number(all[first + i < count ? first + i : 0]);
    return numbers;
  }
};

/// ListedBoxRay::mayEnter for the boxes from `first` on, as bits.
uint32_t mayEnter(const device::ListedBoxRay &ray, const Boxes &boxes, uint32_t first, float tMin,
                  float tMax) {
  Lanes near = tMin, far = tMax;
  const auto narrow = [&](const device::ListedBoxAxis &along, int axis) {
    const Lanes middle = boxes.from(first, [&](const RtslListedBox &b) { return b.middle[axis]; }),
                half = boxes.from(first, [&](const RtslListedBox &b) { return b.half[axis]; }),
                size = device::absolute(along.inverse),
                atMiddle = fused(middle, Lanes(along.inverse), Lanes(along.toOrigin));
    near = raised(near, fused(-half, size, atMiddle));
    far = lowered(far, fused(half, size, atMiddle));
  };
  narrow(ray.x, 0);
  narrow(ray.y, 1);
  narrow(ray.z, 2);
  const Bits isMissed = __builtin_convertvector(
      near > fused(far, Lanes(1 + 32 * device::roundingUnit), Lanes(ray.slack)), Bits);
  uint8_t missed;
  __builtin_memcpy(&missed, &isMissed, sizeof missed);
  return uint8_t(~missed);
}

} // namespace

extern "C" {

/// The host's rtsl_traverse (runtime/embree/HostTraversal.cpp), under another name.
uint32_t rtsl_traverse_tree(RtslState *state, uint32_t how);

/// The boxes that the ray may enter between tMin and tMax, as bits. Separate, because vectors in
/// other functions are split (codegen/emit/LlvmModule.cpp).
__attribute__((noinline)) uint32_t rtsl_entered_boxes(const RtslLaunch *launch,
                                                      const device::ListedBoxRay *ray, float tMin,
                                                      float tMax) {
  const Boxes boxes = {rtsl_listed_boxes(launch), rtsl_listed_instances(launch)};
  uint32_t entered = 0;
#pragma clang loop unroll(full)
  for (uint32_t first = 0; first < mostBoxes; first += lanes)
    if (first < boxes.count)
      entered |= mayEnter(*ray, boxes, first, tMin, tMax) << first;
  return boxes.count < mostBoxes ? entered & ((1u << boxes.count) - 1) : entered;
}

} // extern "C"

namespace {

/// The list of the launch, in place of a tree (LaunchTree of Traverse.h).
struct List {
  template <typename Limit, typename Enter, typename Visit>
  void forEach(const RtslState &state, const device::TriangleRay &ray, Limit limit, Enter,
               Visit visit) const {
    const device::ListedBoxRay boxRay(ray.origin, ray.inverse);
    const float tMin = device::maximum(state.Epsilon, 0.0f) * (1.0f - 2 * device::rangeShare);
    uint32_t entered = rtsl_entered_boxes(state.launch, &boxRay, tMin, limit() * device::cullSlack);
    while (entered) {
      const RtslLeafItem item = {uint32_t(__builtin_ctz(entered)), 0};
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
