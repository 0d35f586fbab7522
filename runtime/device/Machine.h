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
    setColor(parent.color, rtsl_color_components(parent.state.launch), 0);
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

/// The rays of one sample between two steps of the machine.
struct Rays {
  Level *bottom; // the camera ray
  Level *top;    // the ray whose turn it is
  int32_t next;  // n > 0: its state n is to be run; or one of these:

  static constexpr int32_t none = 0;   // the sample is over
  static constexpr int32_t trace = -1; // what it meets is to be found
};

/// Makes the camera ray of a sample, on a stack of stackSize(launch) bytes.
inline void startRays(Rays &rays, const RtslLaunch &launch, uint32_t x, uint32_t y,
                      uint32_t index) {
  startSample(rays.bottom->state, launch, x, y, index);
  rays.top = rays.bottom;
  rays.next = Rays::trace;
}

/// The ray on top is over: its color goes to the one that sent it.
inline void endRay(Rays &rays) {
  rays.next = Rays::none;
  if (rays.top == rays.bottom)
    return;
  const RtslState &state = rays.top->state;
  rays.top = below(rays.top, levelSize(&rays.top->state));
  copyColor(rays.top->color, state.SampleColor, rtsl_color_components(state.launch));
  rays.next = rays.top->resume;
}

/// The step for Rays::trace.
inline void traceRay(Rays &rays) {
  rays.next = begin(*rays.top);
  if (rays.next == 0)
    endRay(rays);
}

/// Runs state `number` of the ray on top, which is rays.next.
inline void runState(Rays &rays, int32_t number) {
  Level &level = *rays.top;
  int32_t after = rtsl_run_state(&level.state, number, level.object, frameOf(&level));
  if (after == 0) {
    endRay(rays);
  } else if (after < 0) {
    rays.next = -after;
  } else {
    rays.next = level.resume = after;
    if (level.isSpawned) {
      rays.top = above(&level, levelSize(&level.state));
      rays.next = Rays::trace;
    }
  }
}

/// One sample of one pixel on a stack of stackSize(launch) bytes.
inline void runMachine(const RtslLaunch &launch, uint32_t x, uint32_t y, uint32_t index,
                       void *stack, float *color) {
  Rays rays;
  rays.bottom = static_cast<Level *>(stack);
  startRays(rays, launch, x, y, index);
  while (rays.next != Rays::none) {
    if (rays.next == Rays::trace)
      traceRay(rays);
    else
      runState(rays, rays.next);
  }
  copyColor(color, rays.bottom->state.SampleColor, rtsl_color_components(&launch));
}

} // namespace rtsl::device
