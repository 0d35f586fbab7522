//===- Machine.h - the classic engine without recursion -------------------===//
//
// Shaders that were split at their traces do not call: a state returns what comes next. The machine
// runs states and traces rays on a stack of its own, one level a ray:
//
//   level 0: the camera ray      state | color, resume, object | frame
//   level 1: a ray it sent       state | ...
//   ...
//
// What a ray's method calls with a frame of its own has it above that of the caller, on the same
// level: it is the same ray.
//
// A ray behind whose last trace nothing happens gives its level to the ray that it sends: such
// recursion is a loop. Other rays stay until theirs are back, so a ray of depth d lies at level d
// at most, one higher above `generate`; how many levels a program needs for a limit of depth is
// exactly what StackBound.h says. A payload lies in the frame of who sent the ray. All levels are
// equally large, so a shader finds the ray that it sends one level up.
//
// Rays start, meet surfaces and end by the functions of Classic.h and Programs.h, in the order of
// the recursive engines. Therefore the colors are the same, bit for bit.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/Abi.h"
#include "runtime/device/Classic.h"
#include "runtime/device/Programs.h"
#include "runtime/device/StackBound.h"

namespace rtsl::device {

/// One ray on the stack; its frame follows.
struct Level {
  RtslState state;             // first: shaders know their level by their state
  float color[RTSL_MAX_COLOR]; // what the last trace brought back
  int32_t resume;              // the state that runs then
  RtslRef object;              // whose method runs
  uint16_t isSpawned;          // the ray one level up, or the one in this level's place, is to be traced
  uint16_t how;                // rtsl_traverse searches for a ray with a payload
  uint32_t frame;              // of programs with calls: where the frame of what runs begins
};

/// Bytes of a level with its frame.
inline uint64_t levelSize(uint64_t frame) {
  uint64_t size = sizeof(Level) + (frame > 4 ? frame : 4);
  return (size + 15) / 16 * 16;
}

inline uint64_t levelSize(RtslState *state, uint32_t referenceChain) {
  return levelSize(uint64_t(uint32_t(rtsl_frame_size(state, int32_t(referenceChain)))));
}

inline uint64_t levelSize(RtslState *state) {
  return levelSize(state, state->launch->referenceChain);
}

inline Level *above(Level *level, uint64_t size) {
  return reinterpret_cast<Level *>(reinterpret_cast<char *>(level) + size);
}

inline Level *below(Level *level, uint64_t size) {
  return reinterpret_cast<Level *>(reinterpret_cast<char *>(level) - size);
}

inline void *frameOf(Level *level) {
  char *frames = reinterpret_cast<char *>(level + 1);
  return rtsl_calls(&level->state) ? frames + level->frame : frames;
}

/// The method of this object begins, on the level's first frame.
inline void beginOn(Level &level, RtslRef object) {
  makeUndefined(level.state, &level.color, above(&level, levelSize(&level.state)));
  level.object = object;
  if (rtsl_calls(&level.state))
    level.frame = 0;
}

/// Bytes for the rays of a sample, and for `generate` below them.
inline uint64_t stackSize(uint32_t maxDepth, uint32_t referenceChain) {
  RtslState none; // each function of a program takes one
  bool hasGenerate = rtsl_rt_RayGeneration_generate_first(&none) != 0;
  auto sent = [&](uint32_t kind) { return uint32_t(rtsl_rays_sent(&none, int32_t(kind))); };
  auto sentLast = [&](uint32_t kind) {
    return uint32_t(rtsl_rays_sent_last(&none, int32_t(kind)));
  };
  return mostLevels(uint32_t(rtsl_ray_kinds(&none)), hasGenerate, maxDepth, sent, sentLast) *
         levelSize(&none, referenceChain);
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

/// The same for a ray with a payload.
inline void spawnAbove(Level &parent, const PayloadRay &ray, uint32_t how) {
  uint32_t dimension;
  parent.isSpawned = maySpawn(parent.state, &dimension);
  if (!parent.isSpawned)
    return;
  Level &child = *above(&parent, levelSize(&parent.state));
  spawn(child.state, parent.state, dimension, ray);
  child.how = uint16_t(how);
}

/// The ray that `level`'s sends takes its place. Where it may not be sent, what it would have
/// brought back is what the launch's limit of depth says: no color, and the payload as it is.
inline void spawnInPlace(Level &level, Vec3 origin, Vec3 direction) {
  uint32_t dimension;
  level.isSpawned = maySpawn(level.state, &dimension);
  if (level.isSpawned)
    spawn(level.state, level.state, dimension, origin, direction);
  else
    setColor(level.state.SampleColor, rtsl_color_components(level.state.launch), 0);
}

inline void spawnInPlace(Level &level, const PayloadRay &ray, uint32_t how) {
  uint32_t dimension;
  level.isSpawned = maySpawn(level.state, &dimension);
  if (!level.isSpawned)
    return;
  spawn(level.state, level.state, dimension, ray);
  level.how = uint16_t(how);
}

/// `begin` for a ray with a payload.
inline int32_t beginWithPayload(Level &level) {
  Arrival arrival = arriveWithPayload(level.state, level.how);
  beginOn(level, arrival.object);
  if (arrival.kind == Arrival::Surface)
    return rtsl_rt_Material_closestHit_payload_first(&level.state);
  if (arrival.kind == Arrival::Background)
    return rtsl_rt_Miss_miss_payload_first(&level.state);
  return 0;
}

/// Finds what the level's ray meets. Returns the state in which its method begins; 0 if the ray is
/// over.
inline int32_t begin(Level &level) {
  if (level.state.rayType != 0)
    return beginWithPayload(level);
  Arrival arrival = arrive(level.state);
  beginOn(level, arrival.object);
  if (arrival.kind == Arrival::Surface)
    return rtsl_rt_Material_shade_first(&level.state);
  if (arrival.kind == Arrival::Background)
    return rtsl_rt_Miss_miss_first(&level.state);
  return 0;
}

/// The rays of one sample between two steps of the machine.
struct Rays {
  Level *bottom; // the camera ray, or `generate`
  Level *top;    // the ray whose turn it is
  RtslEvents events;
  int32_t next;  // n > 0: its state n is to be run; or one of these:

  static constexpr int32_t none = 0;   // the sample is over
  static constexpr int32_t trace = -1; // what it meets is to be found
};

/// Starts a sample, on a stack of stackSize(...) bytes: with `generate` if the program has it,
/// or else with the camera's ray.
inline void startRays(Rays &rays, const RtslLaunch &launch, uint32_t x, uint32_t y,
                      uint32_t index) {
  rays.top = rays.bottom;
  if (launch.rayGeneration) {
    startGenerate(rays.bottom->state, launch, x, y, index, rays.events);
    rays.next = rtsl_rt_RayGeneration_generate_first(&rays.bottom->state);
    beginOn(*rays.bottom, launch.rayGeneration);
    return;
  }
  startSample(rays.bottom->state, launch, x, y, index, rays.events);
  rays.next = Rays::trace;
}

/// The ray on top is over: its color goes to the one that sent it.
inline void endRay(Rays &rays) {
  rays.next = Rays::none;
  if (rays.top == rays.bottom)
    return;
  const RtslState &state = rays.top->state;
  rays.top = below(rays.top, levelSize(&rays.top->state));
  if (state.rayType == 0) // a payload is where it was all the time
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
  } else if (after == RTSL_NEXT_LAST) {
    rays.next = Rays::trace;
    if (!level.isSpawned)
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

/// What follows the last state of a sample.
inline void endSample(Rays &rays) {
  RtslState &state = rays.bottom->state;
  state.Depth = state.launch->rayGeneration ? -1 : 0; // if a ray has taken its place
  endEvents(state);
}

/// One sample of one pixel on a stack of stackSize(...) bytes.
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
  endSample(rays);
  copyColor(color, rays.bottom->state.SampleColor, rtsl_color_components(&launch));
}

} // namespace rtsl::device
