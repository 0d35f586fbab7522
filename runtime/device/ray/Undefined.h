//===- Undefined.h - making uninitialised state visible -------------------===//
//
// Only those fields of a ray's state are written that can be read. Tests check this: a program with
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

} // namespace rtsl::device
