//===- Undefined.h - state that nobody has written, made visible ----------===//
//
// Of a ray's state only what can be read is written. Whether that is so, tests find out: a program
// with RTSL_FEATURE_UNDEFINED_BYTES or _NAN fills all the rest with a pattern, and its pictures
// must not depend on which. Other programs have none of this code, for rtsl_features is a constant.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// The word that undefined memory is made of; 0: it stays as it is.
inline uint32_t undefinedWord(const RtslState &state) {
  const uint32_t features = rtsl_features(const_cast<RtslState *>(&state));
  if (features & RTSL_FEATURE_UNDEFINED_BYTES)
    return 0xa5a5a5a5u;
  return features & RTSL_FEATURE_UNDEFINED_NAN ? 0x7fe00001u : 0u;
}

/// Fills memory from `begin` to `end`, of whole words, if the program of `state` shows what is
/// undefined.
inline void makeUndefined(const RtslState &state, void *begin, void *end) {
  if (const uint32_t word = undefinedWord(state))
    for (auto *at = static_cast<char *>(begin); at != end; at += sizeof word)
      __builtin_memcpy(at, &word, sizeof word);
}

/// A state of the launch, with nothing else in it.
inline void beginState(RtslState &state, const RtslLaunch *launch) {
  state.launch = launch;
  makeUndefined(state, &state, &state + 1);
  state.launch = launch;
}

/// Takes over what is the same for all rays of a sample, from one of them.
inline void takeFromSample(RtslState &state, const RtslState &other) {
  state.events = other.events;
  state.TimeSeed = other.TimeSeed;
  for (int i = 0; i < 2; ++i) {
    state.ScreenCoord[i] = other.ScreenCoord[i];
    state.LensCoord[i] = other.LensCoord[i];
    state.LaunchIndex[i] = other.LaunchIndex[i];
    state.LaunchSize[i] = other.LaunchSize[i];
  }
}

/// Makes `child` a new state and calls make(parent), where `parent` is what it was even if the two
/// are the same.
template <typename Make>
inline void beginChild(RtslState &child, const RtslState &parent, Make make) {
  if (undefinedWord(parent) == 0) {
    make(parent);
    return;
  }
  const RtslState before = parent;
  beginState(child, before.launch);
  if (&child == &parent) // the machine's only state, which the parent still needs
    takeFromSample(child, before);
  make(before);
}

} // namespace rtsl::device
