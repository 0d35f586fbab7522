//===- KeptState.h - the state that is saved while a ray waits ------------===//
//
// The machine (Machine.h) has one state, that of the current ray. While a ray waits for one that it
// has sent, the state belongs to the other. What the waiting ray reads later is saved on its level;
// the compiled program defines which fields these are
// (codegen/passes/continuation/states/KeptState.h). The rest is never stored. State that is the
// same for all rays of a sample is not saved either.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// Numbers of what can be kept: the state variables, and fields that shaders cannot name.
enum KeptField : uint32_t {
#define RTSL_STATE_VARIABLE(name, type, ...) kept##name,
#include "language/StateVariables.def"
  keptInstance,
  keptHitPointError,
  keptPassedDistance,
  keptPayload,
  keptRayType,
  keptRayMask,
  keptRayRoot,
  keptRandomKey,
  keptDimension,
  keptFieldCount
};
static_assert(keptFieldCount <= 64, "rtsl_rays_kept has two words for them");

// What rtsl_rays_kept returns for a number.
constexpr int32_t keptFieldsLow = 0;  // bits: the fields 0 to 31
constexpr int32_t keptFieldsHigh = 1; // the fields from 32 on
constexpr int32_t keptAttributes = 2; // words of RtslState::attributes
constexpr int32_t keptRayKinds = 3;   // 1: some rays have no payload, 2: some have one; 3: both

extern "C" {
/// Defined by the compiled program, constants: the state of waiting rays that is kept.
int32_t rtsl_rays_kept(RtslState *state, int32_t part);
/// Defined by the compiled program, a constant: whether only the first ray of a sample ever waits,
/// and only the first one has a frame. Then there is one level.
int32_t rtsl_rays_wait_once(RtslState *state);
}

/// Does a ray of this type have a payload? If all rays of the program have one, or none has, this
/// is a constant.
inline bool hasPayload(const RtslState &state, uint32_t rayType) {
  const auto kinds = rtsl_rays_kept(const_cast<RtslState *>(&state), keptRayKinds);
  return kinds == 3 ? rayType != 0 : kinds == 2;
}

/// Calls visit(word) for the first `count` of the `most` words at `begin`. Unrolled, so that each
/// word has a constant address.
template <uint32_t most, typename Visit>
inline void forEachWord(void *begin, uint32_t count, Visit visit) {
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (uint32_t i = 0; i < most; ++i)
    if (i < count)
      visit(static_cast<uint32_t *>(begin) + i);
}

/// Words of a field, for colors with this number of components.
inline uint32_t wordsOf(KeptField field, uint32_t components) {
#define RTSL_WORDS_float 1
#define RTSL_WORDS_int 1
#define RTSL_WORDS_vec2 2
#define RTSL_WORDS_uint3 3
#define RTSL_WORDS_vec3 3
#define RTSL_WORDS_mat4 16
#define RTSL_WORDS_color components
  switch (field) {
#define RTSL_STATE_VARIABLE(name, type, ...)                                                       \
  case kept##name:                                                                                 \
    return RTSL_WORDS_##type;
#include "language/StateVariables.def"
  case keptRandomKey:
    return 2;
  default:
    return 1;
  }
}

/// Calls visit(word) for each word of the state that is kept, always in the same order. A payload
/// is stored as its offset from `base`; without a base the words are only counted.
template <typename Visit>
inline void forEachKeptWord(RtslState &state, char *base, Visit visit) {
  const auto low = uint32_t(rtsl_rays_kept(&state, keptFieldsLow));
  const auto high = uint32_t(rtsl_rays_kept(&state, keptFieldsHigh));
  const auto attributes = uint32_t(rtsl_rays_kept(&state, keptAttributes));
  const auto isKept = [&](KeptField field) {
    return (field < 32 ? low >> (field & 31) : high >> (field & 31)) & 1;
  };
  const uint32_t components = rtsl_color_components(state.launch);
#define RTSL_STATE_VARIABLE(name, type, ...)                                                       \
  if (isKept(kept##name))                                                                          \
    forEachWord<sizeof(state.name) / sizeof(uint32_t)>(&state.name,                                \
                                                       wordsOf(kept##name, components), visit);
#include "language/StateVariables.def"
  if (isKept(keptInstance))
    visit(&state.instance);
  if (isKept(keptHitPointError))
    forEachWord<1>(&state.hitPointError, 1, visit);
  if (isKept(keptPassedDistance))
    forEachWord<1>(&state.passedDistance, 1, visit);
  if (isKept(keptPayload)) {
    auto distance =
        uint32_t(reinterpret_cast<uintptr_t>(state.payload) - reinterpret_cast<uintptr_t>(base));
    visit(&distance);
    if (base)
      state.payload = base + distance;
  }
  if (isKept(keptRayType))
    visit(&state.rayType);
  if (isKept(keptRayMask))
    visit(&state.rayMask);
  if (isKept(keptRayRoot))
    forEachWord<1>(&state.rayRoot, 1, visit);
  if (isKept(keptRandomKey))
    forEachWord<2>(state.randomKey, 2, visit);
  if (isKept(keptDimension))
    visit(&state.dimension);
  forEachWord<RTSL_MAX_ATTRIBUTE_WORDS>(state.attributes, RTSL_MAX_ATTRIBUTE_WORDS,
                                        [&](uint32_t *word) {
                                          if (attributes >> (word - state.attributes) & 1)
                                            visit(word);
                                        });
}

/// The number of those words.
inline uint32_t keptWords(RtslState *state) {
  uint32_t count = 0;
  forEachKeptWord(*state, nullptr, [&](uint32_t *) { ++count; });
  return count;
}

} // namespace rtsl::device
