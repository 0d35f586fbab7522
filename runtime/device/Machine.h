//===- Machine.h - the classic engine without recursion -------------------===//
//
// Shaders that were split at their traces do not call: a state returns what comes next. The machine
// runs states and traces rays on a stack of its own, one level a ray:
//
//   level 0: the camera ray      state | color, resume, object | frame
//   level 1: a ray it sent       state | ...
//   ...
//
// A ray of depth d lies at level d and none is deeper than the launch allows, so maxDepth + 1
// levels are enough, whatever shaders do. All levels are equally large, so a shader finds the ray
// that it sends one level up.
//
// Rays start, meet surfaces and end by the functions of Classic.h, in the order of the recursive
// engine. Therefore the colors are the same, bit for bit.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/Abi.h"
#include "runtime/device/Classic.h"

namespace rtsl::device {

/// One ray on the stack; its frame follows.
struct Level {
  RtslState state;             // first: shaders know their level by their state
  float color[RTSL_MAX_COLOR]; // what the last trace brought back
  int32_t resume;              // the state that runs then
  RtslRef object;              // whose method runs
  uint32_t isSpawned;          // the ray one level up is to be traced
};

/// Bytes of a level with its frame. Any state will do: each function of a program takes one.
inline uint64_t levelSize(RtslState *state) {
  uint64_t frame = uint32_t(rtsl_frame_size(state));
  uint64_t size = sizeof(Level) + (frame > 4 ? frame : 4);
  return (size + 15) / 16 * 16;
}

inline Level *above(Level *level, uint64_t size) {
  return reinterpret_cast<Level *>(reinterpret_cast<char *>(level) + size);
}

inline Level *below(Level *level, uint64_t size) {
  return reinterpret_cast<Level *>(reinterpret_cast<char *>(level) - size);
}

inline void *frameOf(Level *level) {
  return level + 1;
}

/// Bytes for the rays of a launch.
inline uint64_t stackSize(const RtslLaunch &launch) {
  RtslState none;
  return (uint64_t(launch.maxDepth) + 1) * levelSize(&none);
}

inline void spawnAbove(Level &parent, Vec3 origin, Vec3 direction) {
  uint32_t dimension;
  parent.isSpawned = maySpawn(parent.state, &dimension);
  if (parent.isSpawned)
    spawn(above(&parent, levelSize(&parent.state))->state, parent.state, dimension, origin,
          direction);
  else
    setColor(parent.color, parent.state.launch->colorComponents, 0);
}

/// Finds what the level's ray meets. Returns the state in which its method begins; 0 if the ray is
/// over.
inline int32_t begin(Level &level) {
  Arrival arrival = arrive(level.state);
  level.object = arrival.object;
  if (arrival.kind == Arrival::Surface)
    return rtsl_rt_Material_shade_first(&level.state);
  if (arrival.kind == Arrival::Background)
    return rtsl_rt_Miss_miss_first(&level.state);
  return 0;
}

/// One sample of one pixel on a stack of stackSize(launch) bytes.
inline void runMachine(const RtslLaunch &launch, uint32_t x, uint32_t y, uint32_t index,
                       void *stack, float *color) {
  Level *const bottom = static_cast<Level *>(stack);
  const uint64_t size = levelSize(&bottom->state);
  startSample(bottom->state, launch, x, y, index);

  Level *level = bottom;
  int32_t next = begin(*level);
  while (true) {
    if (next == 0) { // the ray is over
      if (level == bottom)
        break;
      Level *parent = below(level, size);
      copyColor(parent->color, level->state.SampleColor, launch.colorComponents);
      level = parent;
      next = level->resume;
    }
    int32_t after = rtsl_run_state(&level->state, next, level->object, frameOf(level));
    if (after <= 0) {
      next = -after;
      continue;
    }
    next = level->resume = after;
    if (level->isSpawned) {
      level = above(level, size);
      next = begin(*level);
    }
  }
  copyColor(color, bottom->state.SampleColor, launch.colorComponents);
}

} // namespace rtsl::device
