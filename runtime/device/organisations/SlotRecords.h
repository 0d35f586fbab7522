//===- SlotRecords.h - the records of samples in flight -------------------===//
//
// Samples in flight have a slot each: a record (LaneRecord.h) and, where that does not have the
// rays' only level, a stack.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/KnownLights.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/LaneRecord.h"
#include "runtime/device/organisations/Megakernel.h"

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

/// The bytes of a slot's stack: 0 if the only level of its rays is in the record.
inline uint64_t slotStackBytes(uint32_t maxDepth, uint32_t referenceChain) {
  return hasLevelInRecord() ? 0 : laneBytes(maxDepth, referenceChain);
}

class SlotRecords {
public:
  /// `stackBytes` of each slot.
  SlotRecords(uint32_t slots, uint8_t *records, uint8_t *stacks, uint64_t stackBytes)
      : slots(slots), records(records), stacks(stacks), stackBytes(stackBytes) {}

  char *stack(uint32_t slot) const { return reinterpret_cast<char *>(stacks + slot * stackBytes); }

  void load(uint32_t slot, Flight &flight) const {
    forEachRecordWord(flight, [&](uint32_t number, uint32_t *word) {
      const uint32_t loaded = rtsl_record_load(records, slots, slot, number);
      __builtin_memcpy(word, &loaded, sizeof loaded);
    });
  }
  void store(uint32_t slot, Flight &flight) const {
    forEachRecordWord(flight, [&](uint32_t number, uint32_t *word) {
      uint32_t stored;
      __builtin_memcpy(&stored, word, sizeof stored);
      rtsl_record_store(records, slots, slot, number, stored);
    });
  }
  /// The slot has no sample that must be stored when it begins one.
  void storeNoSample(uint32_t slot) const {
    rtsl_record_store(records, slots, slot, recordedSample, TakenSamples::none);
  }

private:
  uint32_t slots;
  uint8_t *records, *stacks;
  uint64_t stackBytes;
};

/// Loads the rays of a slot, and calls run(flight).
template <typename Run>
RTSL_INLINED void withFlight(const RtslJob &job, const SlotRecords &records, uint32_t slot,
                             Run run) {
  Flight flight;
  alignas(16) char level[mostLevelBytes];
  Rays &rays = flight.rays;
  rays.bottom = hasLevelInRecord() ? level : records.stack(slot);
  records.load(slot, flight);
  RtslState &state = rays.ray.state;
  state.launch = launchOf(job);
  knowNoLights(state);
  if (hasEvents(state))
    state.events = &rays.events;
  run(flight);
}

/// Loads the rays of a slot, runs a step of them, and stores them. Returns the next step.
template <typename Run>
RTSL_INLINED int32_t runOnSlot(const RtslJob &job, const SlotRecords &records, uint32_t slot,
                               Run run) {
  int32_t next;
  withFlight(job, records, slot, [&](Flight &flight) RTSL_ALWAYS_INLINE {
    run(flight);
    records.store(slot, flight);
    next = flight.rays.next;
  });
  return next;
}

/// Ends the sample of a slot, if it has one, and begins sample `following` of the slice, if there
/// is one. Returns the next step: Step::sample if that sample was rendered before.
inline int32_t sampleOnSlot(const RtslJob &job, const SlotRecords &records, uint32_t slot,
                            uint32_t following) {
  return runOnSlot(job, records, slot, [&](Flight &flight) {
    if (flight.sample != TakenSamples::none)
      storeSample(job, flight.sample, flight.rays);
    flight.sample = TakenSamples::none;
    if (following >= samplesOfSlice(job))
      flight.rays.next = Step::nothing;
    else if (beginSample(job, following, flight.rays))
      flight.sample = following;
    else
      flight.rays.next = Step::sample;
  });
}

inline int32_t traceOnSlot(const RtslJob &job, const SlotRecords &records, uint32_t slot) {
  return runOnSlot(job, records, slot, [](Flight &flight) { traceRay(flight.rays); });
}

} // namespace rtsl::device
