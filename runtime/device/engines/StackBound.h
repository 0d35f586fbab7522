//===- StackBound.h - the largest number of rays on the stack -------------===//
//
// A ray keeps its level while the rays that it has sent are active, unless it gave the level to a
// tail trace. Which kinds of rays a kind may send is known when a program is complete, so the most
// levels that any sample can use is the longest path through that graph within the depth limit.
// It is exact: if shaders can send these rays at all, that many levels are in use.
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// Levels for one sample. `sent(kind)` and `sentLast(kind)` are bit sets of kinds (rtsl_rays_sent).
template <typename Sent, typename SentLast>
inline uint32_t mostLevels(uint32_t kinds, bool hasGenerate, uint32_t maxDepth, Sent sent,
                           SentLast sentLast) {
  // Levels from a ray of a kind on, including itself, if rays may be sent `further` deep from it.
  uint32_t levels[RTSL_MAX_RAY_KINDS], deeper[RTSL_MAX_RAY_KINDS];
  for (uint32_t kind = 0; kind < kinds; ++kind)
    levels[kind] = 1;
  const uint32_t rays = maxDepth + (hasGenerate ? 1 : 0); // those of `generate` have depth 0
  for (uint32_t further = 1; further <= rays; ++further) {
    for (uint32_t kind = 0; kind < kinds; ++kind) {
      deeper[kind] = 1;
      for (uint32_t other = 0; other < kinds; ++other) {
        if (sent(kind) >> other & 1 && deeper[kind] < levels[other] + 1)
          deeper[kind] = levels[other] + 1;
        if (sentLast(kind) >> other & 1 && deeper[kind] < levels[other])
          deeper[kind] = levels[other];
      }
    }
    for (uint32_t kind = 0; kind < kinds; ++kind)
      levels[kind] = deeper[kind];
  }
  return levels[hasGenerate ? kinds - 1 : 0];
}

} // namespace rtsl::device
