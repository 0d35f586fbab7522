//===- Wavefront.h - a whole scene as a kernel for each step --------------===//
//
// The machine of Machine.h for many more samples in flight than lanes. Each sample has a slot. All
// slots that wait for the same step, the traversal of their ray or a certain state, are in a queue;
// a kernel takes the slots of one queue, runs the step, and puts each slot into the queue of its
// next step. So all lanes of a warp run the same step, and a kernel has the registers that one step
// needs. In exchange the rays are in memory between two steps (LaneRecord.h).
//
// A turn takes all slots through one step. There are two sets of queues: those that the kernels of
// a turn take from, and those that they fill for the next turn.
//
// When all queues are empty, all slots begin another sample, in their order. So in each turn all
// samples have run equally many steps; neighbours in a queue have neighbouring pixels, and their
// records are adjacent. If each slot began another sample as soon as it could, the order of slots
// would soon be lost: docs/gpu.md has figures.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/KnownLights.h"
#include "runtime/device/organisations/QueuePlace.h"
#include "runtime/device/organisations/SlotRecords.h"
#include "runtime/device/organisations/StepCounts.h"
#include "runtime/device/organisations/WaveMemory.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

/// Slots of a thread on a CPU.
constexpr uint32_t slotsOfThread = 64;

class Wave {
public:
  Wave(const WaveMemory &size, uint8_t *memory)
      : size(size), counts(reinterpret_cast<uint32_t *>(memory)),
        queues(reinterpret_cast<uint32_t *>(memory + size.countBytes())),
        lights(reinterpret_cast<uint32_t *>(memory + size.lightsAt())),
        records(size.slots, memory + size.countBytes() + size.queueBytes(),
                memory + size.stacksAt(), size.stackBytes) {}

  uint32_t slots() const { return size.slots; }
  uint32_t states() const { return size.queues - 1; }

  /// How many slots wait for traversal or a state in a turn, and which.
  uint32_t &count(uint32_t turn, int32_t step) const {
    return counts[(turn & 1) * size.queues + queueOfStep(step)];
  }
  uint32_t *queue(uint32_t turn, int32_t step) const {
    return queues + (uint64_t(turn & 1) * size.queues + queueOfStep(step)) * size.slots;
  }
  bool isAnyInFlight(uint32_t turn) const {
    for (uint32_t queue = 0; queue < size.queues; ++queue)
      if (counts[(turn & 1) * size.queues + queue] != 0)
        return true;
    return false;
  }
  void clearCounts(uint32_t turn) const {
    for (uint32_t queue = 0; queue < size.queues; ++queue)
      counts[(turn & 1) * size.queues + queue] = 0;
  }

  /// What a state of the slot, which is about to run, does with lights.
  void beginLights(RtslState &state, LightPhase phase, uint32_t slot) const {
    KnownLights::begin(state, phase, lights + slot, size.slots);
  }

  /// Lets the slot wait for a step in a turn. All lanes of the warp call together. Slots that have
  /// ended their sample are in no queue, nor are lanes with Step::nothing, which have no slot.
  void put(uint32_t turn, int32_t step, uint32_t slot) const;

private:
  /// States have numbers from 1 on.
  static uint32_t queueOfStep(int32_t step) { return step == Step::trace ? 0 : uint32_t(step); }

  WaveMemory size;
  uint32_t *counts, *queues, *lights;

public:
  SlotRecords records;
};

inline void Wave::put(uint32_t turn, int32_t step, uint32_t slot) const {
  if (step == Step::sample)
    step = Step::nothing;
  const uint32_t place = placeInQueue(step, [&] { return &count(turn, step); });
  if (step != Step::nothing)
    queue(turn, step)[place] = slot;
}

/// Runs a step of all slots that wait for it, in turn `turn`: those of lane `lane` of `lanes`.
/// run(takesPart, slot) returns the next step; all lanes of a warp call together.
template <typename Run>
RTSL_INLINED void runQueue(const RtslJob &job, const Wave &wave, uint32_t turn, int32_t step,
                           uint32_t lane, uint32_t lanes, Run run) {
  const uint32_t count = wave.count(turn, step);
  for (uint32_t at = lane; at / lanesOfWarp * lanesOfWarp < count; at += lanes) {
    const bool takesPart = at < count;
    const uint32_t slot = takesPart ? wave.queue(turn, step)[at] : 0;
    countStep(job, step, takesPart);
    wave.put(turn + 1, run(takesPart, slot), slot);
  }
}

//===----------------------------------------------------------------------===//
// The steps
//===----------------------------------------------------------------------===//

/// No slot has a sample.
inline void beginWave(const Wave &wave, uint32_t lane, uint32_t lanes) {
  for (uint32_t slot = lane; slot < wave.slots(); slot += lanes)
    wave.records.storeNoSample(slot);
}

inline void traceWave(const RtslJob &job, const Wave &wave, uint32_t turn, uint32_t lane,
                      uint32_t lanes) {
  runQueue(job, wave, turn, Step::trace, lane, lanes, [&](bool takesPart, uint32_t slot) {
    return takesPart ? traceOnSlot(job, wave.records, slot) : Step::nothing;
  });
}

/// Ends the samples of all slots, and begins others. No slot may be in a queue.
inline void sampleWave(const RtslJob &job, const Wave &wave, uint32_t turn, uint32_t lane,
                       uint32_t lanes) {
  for (uint32_t slot = lane; slot / lanesOfWarp * lanesOfWarp < wave.slots(); slot += lanes) {
    int32_t next = slot < wave.slots() ? Step::sample : Step::nothing;
    do { // samples that were rendered before end at once
      const bool takesPart = next == Step::sample;
      countStep(job, Step::sample, takesPart);
      const uint32_t following = takeOneSample(job, takesPart);
      if (takesPart)
        next = sampleOnSlot(job, wave.records, slot, following);
    } while (warp::lanesWhere(next == Step::sample));
    wave.put(turn + 1, next, slot);
  }
}

/// May states look for lights first? A constant. Not if that would change stacks in memory.
inline bool knowsLights() {
  return rtsl_knows_lights() && hasLevelInRecord();
}
/// Words of a slot for what is known of lights.
inline uint32_t lightWordsOfSlot(const RtslLaunch *launch) {
  return knowsLights() ? knownLightWords(rtsl_color_components(launch)) : 0;
}

/// Runs state `number`, by run(rays), which is inlined here: the code generator copies this once
/// for each state. `areLightsKnown`: lightWave has run before.
template <typename Run>
RTSL_INLINED void stateWave(const RtslJob &job, const Wave &wave, uint32_t turn, int32_t number,
                            uint32_t lane, uint32_t lanes, bool areLightsKnown, Run run) {
  runQueue(job, wave, turn, number, lane, lanes,
           [&](bool takesPart, uint32_t slot) RTSL_ALWAYS_INLINE {
             const auto runRays = [&](Flight &flight) RTSL_ALWAYS_INLINE {
               if (knowsLights() && areLightsKnown)
                 wave.beginLights(flight.rays.ray.state, lightsKnown, slot);
               run(flight.rays);
             };
             return takesPart ? runOnSlot(job, wave.records, slot, runRays) : Step::nothing;
           });
}

/// Looks for the lights that state `number` is about to ask for, of the same slots; nothing else
/// changes.
template <typename Run>
RTSL_INLINED void lightWave(const RtslJob &job, const Wave &wave, uint32_t turn, int32_t number,
                            uint32_t lane, uint32_t lanes, Run run) {
  const uint32_t count = knowsLights() ? wave.count(turn, number) : 0;
  for (uint32_t at = lane; at < count; at += lanes) {
    const uint32_t slot = wave.queue(turn, number)[at];
    withFlight(job, wave.records, slot, [&](Flight &flight) RTSL_ALWAYS_INLINE {
      wave.beginLights(flight.rays.ray.state, lightsWanted, slot);
      run(flight.rays);
    });
  }
}

} // namespace rtsl::device
