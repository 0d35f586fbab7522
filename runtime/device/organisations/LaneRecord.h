//===- LaneRecord.h - the rays of a sample, in memory between two steps ----===//
//
// A wavefront (Wavefront.h) has more samples in flight than lanes. Between two steps the rays of a
// sample (Machine.h) are a record: words with numbers, which steps load before they run and store
// afterwards. Functions that the code generator defines move single words
// (codegen/emit/rewrites/PackRecords.h): it removes words that no step reads or that never change,
// and interleaves the rest, so that neighbouring lanes touch neighbouring memory.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Machine.h"
#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// A level of up to this size is part of the record, if it is the only one.
constexpr uint64_t mostLevelBytes = 512;

/// Whether the only level of the program's rays is part of the record; a constant.
inline bool hasLevelInRecord() {
  RtslState none;
  none.launch = nullptr;
  return rtsl_rays_wait_once(&none) && !rtsl_calls(&none) && levelSize(&none, 0) <= mostLevelBytes;
}

/// A sample in flight.
struct Flight {
  Rays rays;
  uint32_t sample; // of the slice, or TakenSamples::none
};

#define RTSL_ALWAYS_INLINE __attribute__((always_inline))
#define RTSL_INLINED RTSL_ALWAYS_INLINE inline

/// Calls visit(number, word) for `count` words at `begin`, unrolled: `number` is a constant.
template <uint32_t count, typename Visit>
RTSL_INLINED uint32_t visitWords(uint32_t first, void *begin, Visit visit) {
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (uint32_t i = 0; i < count; ++i)
    visit(first + i, static_cast<uint32_t *>(begin) + i);
  return first + count;
}

constexpr uint32_t recordedSample = 0; // the number of Flight::sample

/// Calls visit(number, word) for all words that a step may leave to the next. Pointers into the
/// stack of the rays are visited as distances from its bottom.
template <typename Visit>
RTSL_INLINED void forEachRecordWord(Flight &flight, Visit visit) {
  Rays &rays = flight.rays;
  CurrentRay &ray = rays.ray;
  RtslState &state = ray.state;
  constexpr auto wordsBetween = [](size_t begin, size_t end) {
    return uint32_t((end - begin) / sizeof(uint32_t));
  };
  uint32_t number = recordedSample;
  const auto visitDistance = [&](auto *&pointer) {
    auto distance =
        uint32_t(reinterpret_cast<uintptr_t>(pointer) - reinterpret_cast<uintptr_t>(rays.bottom));
    visit(number++, &distance);
    pointer = rays.bottom + distance;
  };
  visit(number++, &flight.sample);
  number = visitWords<wordsBetween(offsetof(RtslState, instance), offsetof(RtslState, payload))>(
      number, &state.instance, visit);
  number = visitWords<wordsBetween(offsetof(RtslState, rayType), sizeof(RtslState))>(
      number, &state.rayType, visit);
  number = visitWords<RTSL_MAX_COLOR>(number, ray.color, visit);
  visit(number++, &ray.object);
  visit(number++, &ray.how);
  visit(number++, &ray.frame);
  visit(number++, &rays.waiting);
  number = visitWords<sizeof(RtslEvents) / sizeof(uint32_t)>(number, &rays.events, visit);
  visitDistance(state.payload);
  visitDistance(ray.level);
  if (!hasLevelInRecord())
    return;
  const auto words = uint32_t(levelSize(&state, 0) / sizeof(uint32_t));
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (uint32_t i = 0; i < mostLevelBytes / sizeof(uint32_t); ++i)
    if (i < words)
      visit(number + i, reinterpret_cast<uint32_t *>(rays.bottom) + i);
}

} // namespace rtsl::device
