//===- Undefined.h - making uninitialised state visible -------------------===//
//
// Of a ray's state only what can be read is written. Tests check this: a program with
// RTSL_FEATURE_UNDEFINED_BYTES or _NAN fills all the rest with a pattern, and its images must not
// depend on the pattern. Other programs contain none of this code, because rtsl_features is a
// constant.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// The word that undefined memory is filled with; 0: it is not filled.
inline uint32_t undefinedWord(const RtslState &state) {
  const uint32_t features = rtsl_features(const_cast<RtslState *>(&state));
  if (features & RTSL_FEATURE_UNDEFINED_BYTES)
    return 0xa5a5a5a5u;
  return features & RTSL_FEATURE_UNDEFINED_NAN ? 0x7fe00001u : 0u;
}

/// Fills memory from `begin` to `end`, of whole words, if the program of `state` has that feature.
inline void makeUndefined(const RtslState &state, void *begin, void *end) {
  if (const uint32_t word = undefinedWord(state))
    for (auto *at = static_cast<char *>(begin); at != end; at += sizeof word)
      __builtin_memcpy(at, &word, sizeof word);
}

/// Begins a state of the launch, with all other fields undefined.
inline void beginState(RtslState &state, const RtslLaunch *launch) {
  state.launch = launch;
  makeUndefined(state, &state, &state + 1);
  state.launch = launch;
}

/// Copies what is the same for all rays of a sample from one of them.
inline void takeFromSample(RtslState &state, const RtslState &other) {
  state.events = other.events;
  state.TimeSeed = other.TimeSeed;
  for (int i = 0; i < 2; ++i) {
    state.ScreenCoord[i] = other.ScreenCoord[i];
    state.LensCoord[i] = other.LensCoord[i];
  }
  for (int i = 0; i < 3; ++i) {
    state.LaunchIndex[i] = other.LaunchIndex[i];
    state.LaunchSize[i] = other.LaunchSize[i];
  }
}

/// Makes `child` a new state and calls make(parent), where `parent` has its old value even if the
/// two are the same.
template <typename Make>
inline void beginChild(RtslState &child, const RtslState &parent, Make make) {
  if (undefinedWord(parent) == 0) {
    make(parent);
    return;
  }
  const RtslState before = parent;
  beginState(child, before.launch);
  if (&child == &parent) // the only state of the machine, which is still read as the parent
    takeFromSample(child, before);
  make(before);
}

} // namespace rtsl::device
