//===- Machine.h - the classic engine without recursion -------------------===//
//
// Shaders that were split at their traces do not call: a state returns the next step. The machine
// runs states and traces rays. There is one current ray; its state is a local variable of the
// function that runs the machine, so that a compiler that sees the whole program may keep it in
// registers. The rays that wait for it are on a stack of the machine's own, one level per ray:
//
//   level 0: the camera ray      resume, object | frame | what it reads later of its state
//   level 1: a ray it sent       resume, object | ...
//   ...
//   the current ray                             | frame
//
// A method that is called with a frame of its own has it above that of the caller, on the same
// level: it belongs to the same ray.
//
// A ray with a tail trace gives its level to the ray that it sends: such recursion is a loop. Other
// rays stay until theirs are back, so a ray of depth d is at level d at most, one higher above
// `generate`; StackBound.h computes the exact number of levels that a program needs for a limit of
// depth. A payload is in the frame of the ray that sent it.
//
// Rays start, meet surfaces and end by the functions of Classic.h and Programs.h, in the order of
// the recursive engines. Therefore the colors are bit-identical.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Classic.h"
#include "runtime/device/engines/KeptState.h"
#include "runtime/device/engines/Programs.h"
#include "runtime/device/engines/StackBound.h"
#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// A waiting ray. Its frame follows, then the kept words of its state.
struct alignas(16) Level {
  int32_t resume; // the state to run when the ray that it sent is back
  RtslRef object; // whose method runs
  uint32_t frame; // of programs with calls: where the current frame begins
};

inline uint64_t inGroups(uint64_t bytes) {
  return (bytes + 15) / 16 * 16;
}

/// Bytes of a level with this frame and number of kept words. Groups of four words stay together.
inline uint64_t levelSize(uint64_t frame, uint64_t keptWords) {
  return sizeof(Level) + inGroups(frame > 4 ? frame : 4) + inGroups(4 * keptWords);
}

inline uint64_t levelSize(RtslState *state, uint32_t referenceChain) {
  return levelSize(uint64_t(uint32_t(rtsl_frame_size(state, int32_t(referenceChain)))),
                   keptWords(state));
}

inline uint64_t levelSize(RtslState *state) {
  return levelSize(state, state->launch->referenceChain);
}

/// Bytes for the rays of a sample, including `generate` at the bottom.
inline uint64_t stackSize(const RtslLaunch *launch, uint32_t maxDepth, uint32_t referenceChain) {
  RtslState none; // each function of a program takes a state
  none.launch = launch;
  if (rtsl_rays_wait_once(&none))
    return levelSize(&none, referenceChain);
  bool hasGenerate = rtsl_rt_RayGeneration_generate_first(&none) != 0;
  auto sent = [&](uint32_t kind) { return uint32_t(rtsl_rays_sent(&none, int32_t(kind))); };
  auto sentLast = [&](uint32_t kind) {
    return uint32_t(rtsl_rays_sent_last(&none, int32_t(kind)));
  };
  return mostLevels(uint32_t(rtsl_ray_kinds(&none)), hasGenerate, maxDepth, sent, sentLast) *
         levelSize(&none, referenceChain);
}

/// The ray that is being processed.
struct CurrentRay {
  RtslState state;             // first: shaders are passed this pointer
  float color[RTSL_MAX_COLOR]; // what the last trace brought back
  RtslRef object;              // whose method runs
  uint32_t how;                // how rtsl_traverse searches for a ray with a payload
  uint32_t frame;              // of programs with calls: where the current frame begins
  char *level;                 // its frame, and the words that are kept when it waits

  // The ray that the current state sends. It is traced when the state returns.
  PayloadRay sent; // rayType 0: no payload, and only origin and direction are used
  uint32_t sentHow;
  uint32_t sentDimension; // the key of its random numbers
  bool isSent;            // false: it is deeper than the launch allows
};

inline CurrentRay &currentRay(RtslState *state) {
  return *reinterpret_cast<CurrentRay *>(state);
}

inline void *frameOf(const CurrentRay &ray) {
  char *frames = ray.level + sizeof(Level);
  return rtsl_calls(const_cast<RtslState *>(&ray.state)) ? frames + ray.frame : frames;
}

/// The rays of one sample between two steps of the machine.
struct Rays {
  CurrentRay ray;
  char *bottom;     // the stack, aligned to 16 bytes
  uint32_t waiting; // rays on it
  RtslEvents events;
  int32_t next; // n > 0: run its state n; or one of these:

  static constexpr int32_t none = 0;   // the sample is over
  static constexpr int32_t trace = -1; // traverse the ray
};

/// Begins the method of this object, on the ray's first frame.
inline void beginOn(Rays &rays, RtslRef object) {
  CurrentRay &ray = rays.ray;
  if (undefinedWord(ray.state)) {
    makeUndefined(ray.state, ray.color, ray.color + RTSL_MAX_COLOR);
    if (rays.waiting == 0 || !rtsl_rays_wait_once(&ray.state))
      makeUndefined(ray.state, ray.level, ray.level + levelSize(&ray.state));
  }
  ray.object = object;
  if (rtsl_calls(&ray.state))
    ray.frame = 0;
}

//===----------------------------------------------------------------------===//
// Sending
//===----------------------------------------------------------------------===//

/// The current state sends a ray, which returns a color.
inline void send(CurrentRay &ray, Vec3 origin, Vec3 direction, float *color) {
  ray.isSent = maySpawn(ray.state, &ray.sentDimension);
  ray.sent.origin = origin;
  ray.sent.direction = direction;
  ray.sent.rayType = 0;
  if (!ray.isSent)
    setColor(color, rtsl_color_components(ray.state.launch), 0);
}

/// The same for a ray with a payload, which is unchanged if the ray may not be sent.
inline void send(CurrentRay &ray, const PayloadRay &sent, uint32_t how) {
  ray.isSent = maySpawn(ray.state, &ray.sentDimension);
  ray.sent = sent;
  ray.sentHow = how;
}

/// Makes the ray that was sent the current one.
inline void takeTurn(CurrentRay &ray) {
  RtslState &state = ray.state;
  if (hasPayload(state, ray.sent.rayType)) {
    spawn(state, state, ray.sentDimension, ray.sent);
    ray.how = ray.sentHow;
  } else {
    spawn(state, state, ray.sentDimension, ray.sent.origin, ray.sent.direction);
  }
}

/// Address of the kept words of the ray's state.
inline char *keptPart(const CurrentRay &ray) {
  auto *state = const_cast<RtslState *>(&ray.state);
  const auto frame =
      uint64_t(uint32_t(rtsl_frame_size(state, int32_t(state->launch->referenceChain))));
  return ray.level + sizeof(Level) + inGroups(frame > 4 ? frame : 4);
}

/// Pushes the ray onto the stack until the one that it has sent is back; then state `resume` runs.
inline void wait(Rays &rays, int32_t resume) {
  CurrentRay &ray = rays.ray;
  auto &level = *static_cast<Level *>(__builtin_assume_aligned(ray.level, 16));
  level.resume = resume;
  level.object = ray.object;
  if (rtsl_calls(&ray.state))
    level.frame = ray.frame;
  auto *kept = static_cast<char *>(__builtin_assume_aligned(keptPart(ray), 16));
  forEachKeptWord(ray.state, rays.bottom, [&](uint32_t *word) {
    __builtin_memcpy(kept, word, sizeof *word);
    kept += sizeof *word;
  });
  ++rays.waiting;
  if (!rtsl_rays_wait_once(&ray.state))
    ray.level += levelSize(&ray.state);
}

/// Resumes the last waiting ray.
inline void goOn(Rays &rays) {
  CurrentRay &ray = rays.ray;
  if (undefinedWord(ray.state)) { // what is not kept must not be read
    const RtslState before = ray.state;
    beginState(ray.state, before.launch);
    takeFromSample(ray.state, before);
    if (rtsl_rays_kept(&ray.state, keptRayKinds) ==
        1) { // without payloads, constant for the sample
      ray.state.Time = before.Time;
      ray.state.rayMask = before.rayMask;
      ray.state.rayRoot = before.rayRoot;
    }
  }
  --rays.waiting;
  if (!rtsl_rays_wait_once(&ray.state))
    ray.level -= levelSize(&ray.state);
  const auto &level = *static_cast<const Level *>(__builtin_assume_aligned(ray.level, 16));
  rays.next = level.resume;
  ray.object = level.object;
  if (rtsl_calls(&ray.state))
    ray.frame = level.frame;
  const auto *kept = static_cast<const char *>(__builtin_assume_aligned(keptPart(ray), 16));
  forEachKeptWord(ray.state, rays.bottom, [&](uint32_t *word) {
    __builtin_memcpy(word, kept, sizeof *word);
    kept += sizeof *word;
  });
}

//===----------------------------------------------------------------------===//
// Steps
//===----------------------------------------------------------------------===//

/// The state of the entry point for what the ray has met; 0 if the ray is over.
inline int32_t firstState(RtslState *state, bool carries, Arrival::Kind kind) {
  if (kind == Arrival::Surface)
    return carries ? rtsl_rt_Material_closestHit_payload_first(state)
                   : rtsl_rt_Material_shade_first(state);
  if (kind == Arrival::Background)
    return carries ? rtsl_rt_Miss_miss_payload_first(state) : rtsl_rt_Miss_miss_first(state);
  return 0;
}

/// Finds what the ray meets, and the next step. One copy of the traversal serves all kinds of rays.
inline int32_t begin(Rays &rays) {
  CurrentRay &ray = rays.ray;
  RtslState &state = ray.state;
  const bool carries = hasPayload(state, state.rayType);
  const uint32_t how = carries ? ray.how : 0;
  const uint32_t found = traverseWithDefaults(state, how);
  const Arrival arrival = carries ? arriveWithPayloadAt(state, how, found) : arriveAt(state, found);
  beginOn(rays, arrival.object);
  return rtsl_first_state(&state, firstState(&state, carries, arrival.kind), arrival.object);
}

/// Starts a sample, on a stack of stackSize(...) bytes: with `generate` if the program has it,
/// otherwise with the camera ray. Without a ray the sample is over.
inline void startRays(Rays &rays, const RtslLaunch &launch, uint32_t x, uint32_t y,
                      uint32_t index) {
  CurrentRay &ray = rays.ray;
  ray.level = rays.bottom;
  rays.waiting = 0;
  if (rtsl_generates(&launch)) {
    const bool hasRay = startGenerate(ray.state, launch, x, y, index, rays.events);
    rays.next = hasRay ? rtsl_rt_RayGeneration_generate_first(&ray.state) : Rays::none;
    beginOn(rays, launch.rayGeneration);
    return;
  }
  const bool hasRay = startSample(ray.state, launch, x, y, index, rays.events);
  rays.next = hasRay ? Rays::trace : Rays::none;
}

/// The ray is over: its color is returned to the ray that sent it.
inline void endRay(Rays &rays) {
  rays.next = Rays::none;
  if (rays.waiting == 0)
    return;
  CurrentRay &ray = rays.ray;
  if (!hasPayload(ray.state, ray.state.rayType)) // a payload is already in place
    copyColor(ray.color, ray.state.SampleColor, rtsl_color_components(ray.state.launch));
  goOn(rays);
}

/// The step for Rays::trace.
inline void traceRay(Rays &rays) {
  rays.next = begin(rays);
  if (rays.next == 0)
    endRay(rays);
}

/// The end of a state that returned `after`.
inline void endState(Rays &rays, int32_t after) {
  CurrentRay &ray = rays.ray;
  if (after < 0 && after != RTSL_NEXT_LAST) {
    rays.next = -after;
    return;
  }
  const bool sends = after != 0 && ray.isSent;
  if (!sends) {
    rays.next = after;
    if (after <= 0)
      endRay(rays);
    return;
  }
  if (after != RTSL_NEXT_LAST)
    wait(rays, after);
  takeTurn(ray);
  rays.next = Rays::trace;
}

/// Runs state `number` of the ray, which is rays.next.
inline void runState(Rays &rays, int32_t number) {
  CurrentRay &ray = rays.ray;
  endState(rays, rtsl_run_state(&ray.state, number, ray.object, frameOf(ray)));
}

/// The end of a sample, after its last state.
inline void endSample(Rays &rays) {
  RtslState &state = rays.ray.state;
  state.Depth = rtsl_generates(state.launch) ? -1 : 0; // in case a tail trace has replaced it
  endEvents(state);
}

/// One sample of one pixel on a stack of stackSize(...) bytes.
inline void runMachine(const RtslLaunch &launch, uint32_t x, uint32_t y, uint32_t index,
                       void *stack, float *color) {
  Rays rays;
  rays.bottom = static_cast<char *>(stack);
  startRays(rays, launch, x, y, index);
  while (rays.next != Rays::none) {
    if (rays.next == Rays::trace)
      traceRay(rays);
    else
      runState(rays, rays.next);
  }
  endSample(rays);
  copyColor(color, rays.ray.state.SampleColor, rtsl_color_components(&launch));
}

} // namespace rtsl::device
