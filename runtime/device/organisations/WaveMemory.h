//===- WaveMemory.h - the memory of a wavefront ---------------------------===//
//
// Samples in flight have a slot each. The memory of a number of slots, in this order:
//
//   for each of two turns: the lengths of the queues            queues words
//   for each of two turns: the slots in each queue              queues * slots words
//   the records of the slots, in groups of four words           groups * slots * 16 bytes
//   the stacks of the slots, if they are not part of the record slots * stackBytes
//   what is known of lights (KnownLights.h), in slots next to each other: slots * lightWords words
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/KnownLights.h"

#include <stdint.h>

namespace rtsl::device {

struct WaveMemory {
  uint32_t slots;
  uint32_t queues;     // for traversal, and for each state
  uint32_t groups;     // of a record, of 16 bytes
  uint64_t stackBytes; // of a slot, a multiple of 16
  uint32_t lightWords; // of a slot; 0: no state looks for lights first

  void makePlaceForLights(uint32_t colorComponents) {
    lightWords = knownLightWords(colorComponents);
  }

  static uint64_t aligned(uint64_t bytes) { return (bytes + 255) / 256 * 256; }

  uint64_t countBytes() const { return aligned(uint64_t(2) * queues * sizeof(uint32_t)); }
  uint64_t queueBytes() const { return aligned(uint64_t(2) * queues * slots * sizeof(uint32_t)); }
  uint64_t recordBytes() const { return aligned(uint64_t(groups) * slots * 16); }
  /// The first bytes of the stacks, and of the lights.
  uint64_t stacksAt() const { return countBytes() + queueBytes() + recordBytes(); }
  uint64_t lightsAt() const { return stacksAt() + aligned(slots * stackBytes); }
  uint64_t bytes() const { return lightsAt() + uint64_t(slots) * lightWords * sizeof(uint32_t); }
};

} // namespace rtsl::device
