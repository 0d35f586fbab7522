//===- Wavefront.h - a whole scene as a kernel for each step --------------===//
//
// The machine of Machine.h for many more samples in flight than lanes. Each sample has a slot. All
// slots that wait for the same step, the traversal of their ray, a certain state, or the beginning
// of another sample, are in a queue; a kernel takes the slots of one queue, runs the step, and puts
// each slot into the queue of its next step. So all lanes of a warp run the same step, and a kernel
// has the registers that one step needs. In exchange the rays are in memory between two steps
// (LaneRecord.h).
//
// A turn takes all slots through one step. There are two sets of queues: those that the kernels of
// a turn take from, and those that they fill for the next turn.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/LaneRecord.h"
#include "runtime/device/engines/Megakernel.h"
#include "runtime/device/engines/StepCounts.h"
#include "runtime/device/engines/WaveMemory.h"
#include "runtime/device/ray/Warp.h"

extern "C" {
/// Defined by the compiled program: its number of steps.
uint32_t rtsl_wave_steps(const RtslLaunch *launch);
/// Defined by the code generator, which also decides where the word is: word `number` of the record
/// of a slot, in the records of so many slots.
uint32_t rtsl_record_load(const void *records, uint32_t slots, uint32_t slot, uint32_t number);
void rtsl_record_store(void *records, uint32_t slots, uint32_t slot, uint32_t number,
                       uint32_t word);
/// Defined by the code generator, a constant: groups of four words in a record.
uint32_t rtsl_record_groups();
}

namespace rtsl::device {

/// Slots of a thread on a CPU.
constexpr uint32_t slotsOfThread = 64;

class Wave {
public:
  Wave(const WaveMemory &size, uint8_t *memory)
      : size(size), counts(reinterpret_cast<uint32_t *>(memory)),
        queues(reinterpret_cast<uint32_t *>(memory + size.countBytes())),
        records(memory + size.countBytes() + size.queueBytes()),
        stacks(records + size.recordBytes()) {}

  uint32_t slots() const { return size.slots; }
  uint32_t steps() const { return size.steps; }
  char *stack(uint32_t slot) const {
    return reinterpret_cast<char *>(stacks + slot * size.stackBytes);
  }

  /// How many slots wait for a step in a turn, and which.
  uint32_t &count(uint32_t turn, int32_t step) const {
    return counts[(turn & 1) * size.steps + placeOfStep(step)];
  }
  uint32_t *queue(uint32_t turn, int32_t step) const {
    return queues + (uint64_t(turn & 1) * size.steps + placeOfStep(step)) * size.slots;
  }
  bool isAnyInFlight(uint32_t turn) const {
    for (int32_t step = Step::trace; placeOfStep(step) < size.steps; ++step)
      if (count(turn, step) != 0)
        return true;
    return false;
  }
  void clearCounts(uint32_t turn) const {
    for (int32_t step = Step::trace; placeOfStep(step) < size.steps; ++step)
      count(turn, step) = 0;
  }

  void load(uint32_t slot, Flight &flight) const {
    forEachRecordWord(flight, [&](uint32_t number, uint32_t *word) {
      const uint32_t loaded = rtsl_record_load(records, size.slots, slot, number);
      __builtin_memcpy(word, &loaded, sizeof loaded);
    });
  }
  void store(uint32_t slot, Flight &flight) const {
    forEachRecordWord(flight, [&](uint32_t number, uint32_t *word) {
      uint32_t stored;
      __builtin_memcpy(&stored, word, sizeof stored);
      rtsl_record_store(records, size.slots, slot, number, stored);
    });
  }
  /// The slot has no sample that must be stored when it begins one.
  void storeNoSample(uint32_t slot) const {
    rtsl_record_store(records, size.slots, slot, recordedSample, TakenSamples::none);
  }

  /// Lets the slot wait for a step in a turn. All lanes of the warp call together; lanes with
  /// Step::nothing have no slot to put.
  void put(uint32_t turn, int32_t step, uint32_t slot) const;

private:
  WaveMemory size;
  uint32_t *counts, *queues;
  uint8_t *records, *stacks;
};

#ifdef __NVPTX__

inline void Wave::put(uint32_t turn, int32_t step, uint32_t slot) const {
  uint32_t lanes = warp::lanesWhere(step != Step::nothing);
  while (lanes) {
    const int leader = __builtin_ctz(lanes);
    const int32_t together = warp::valueOf(step, leader);
    const uint32_t members = warp::lanesWhere(step == together);
    uint32_t first = 0;
    if (int(__nvvm_read_ptx_sreg_laneid()) == leader)
      first = __atomic_fetch_add(&count(turn, together), uint32_t(__builtin_popcount(members)),
                                 __ATOMIC_RELAXED);
    first = uint32_t(warp::valueOf(int32_t(first), leader));
    if (step == together)
      queue(turn, together)[first + uint32_t(__builtin_popcount(
                                        members & __nvvm_read_ptx_sreg_lanemask_lt()))] = slot;
    lanes &= ~members;
  }
}

#else

inline void Wave::put(uint32_t turn, int32_t step, uint32_t slot) const {
  if (step != Step::nothing)
    queue(turn, step)[count(turn, step)++] = slot;
}

#endif

/// Loads the rays of a slot, runs a step of them, and stores them. Returns the next step.
template <typename Run>
RTSL_INLINED int32_t runOnSlot(const RtslJob &job, const Wave &wave, uint32_t slot, Run run) {
  Flight flight;
  alignas(16) char level[mostLevelBytes];
  Rays &rays = flight.rays;
  rays.bottom = hasLevelInRecord() ? level : wave.stack(slot);
  wave.load(slot, flight);
  rays.ray.state.launch = job.launch;
  if (hasEvents(rays.ray.state))
    rays.ray.state.events = &rays.events;
  run(flight);
  wave.store(slot, flight);
  return rays.next;
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

/// All slots wait for a sample, in turn 0. The counts must be 0.
inline void beginWave(const Wave &wave, uint32_t lane, uint32_t lanes) {
  for (uint32_t slot = lane; slot < wave.slots(); slot += lanes) {
    wave.storeNoSample(slot);
    wave.queue(0, Step::sample)[slot] = slot;
  }
  if (lane == 0)
    wave.count(0, Step::sample) = wave.slots();
}

inline void traceWave(const RtslJob &job, const Wave &wave, uint32_t turn, uint32_t lane,
                      uint32_t lanes) {
  runQueue(job, wave, turn, Step::trace, lane, lanes, [&](bool takesPart, uint32_t slot) {
    return takesPart ? runOnSlot(job, wave, slot, [](Flight &flight) { traceRay(flight.rays); })
                     : Step::nothing;
  });
}

/// Ends the samples of slots, and begins others.
inline void sampleWave(const RtslJob &job, const Wave &wave, uint32_t turn, uint32_t lane,
                       uint32_t lanes) {
  runQueue(job, wave, turn, Step::sample, lane, lanes, [&](bool takesPart, uint32_t slot) {
    const uint32_t following = takeOneSample(job, takesPart);
    if (!takesPart)
      return Step::nothing;
    return runOnSlot(job, wave, slot, [&](Flight &flight) {
      if (flight.sample != TakenSamples::none)
        storeSample(job, flight.sample, flight.rays);
      flight.sample = following;
      if (following >= samplesOfSlice(job))
        flight.rays.next = Step::nothing;
      else if (!beginSample(job, following, flight.rays)) {
        flight.sample = TakenSamples::none;
        flight.rays.next = Step::sample;
      }
    });
  });
}

/// Runs state `number`, by run(rays), which is inlined here: the code generator copies this once
/// for each state.
template <typename Run>
RTSL_INLINED void stateWave(const RtslJob &job, const Wave &wave, uint32_t turn, int32_t number,
                            uint32_t lane, uint32_t lanes, Run run) {
  const auto runRays = [&](Flight &flight) RTSL_ALWAYS_INLINE { run(flight.rays); };
  runQueue(job, wave, turn, number, lane, lanes,
           [&](bool takesPart, uint32_t slot) RTSL_ALWAYS_INLINE {
             return takesPart ? runOnSlot(job, wave, slot, runRays) : Step::nothing;
           });
}

} // namespace rtsl::device
