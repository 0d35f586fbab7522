//===- WaveMemory.h - the memory of a wavefront ---------------------------===//
//
// Samples in flight have a slot each. The memory of a number of slots, in this order:
//
//   for each of two turns: the lengths of the queues            queues words
//   for each of two turns: the slots in each queue              queues * slots words
//   the records of the slots, in groups of four words           groups * slots * 16 bytes
//   the stacks of the slots, if they are not part of the record slots * stackBytes
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

namespace rtsl::device {

struct WaveMemory {
  uint32_t slots;
  uint32_t queues;     // for traversal, and for each state
  uint32_t groups;     // of a record, of 16 bytes
  uint64_t stackBytes; // of a slot, a multiple of 16

  static uint64_t aligned(uint64_t bytes) { return (bytes + 255) / 256 * 256; }

  uint64_t countBytes() const { return aligned(uint64_t(2) * queues * sizeof(uint32_t)); }
  uint64_t queueBytes() const { return aligned(uint64_t(2) * queues * slots * sizeof(uint32_t)); }
  uint64_t recordBytes() const { return aligned(uint64_t(groups) * slots * 16); }
  uint64_t bytes() const {
    return countBytes() + queueBytes() + recordBytes() + slots * stackBytes;
  }
};

} // namespace rtsl::device
