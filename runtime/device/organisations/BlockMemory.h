//===- BlockMemory.h - the memory of a persistent block -------------------===//
//
// The shared memory of a block of lanes (Persistent.h) with a number of slots, in this order:
//
//   the records of the slots, in groups of four words           groups * slots * 16 bytes
//   for each of two turns: how many slots wait for each step    steps words
//   which step each slot waits for, and its place among these   slots words
//   the slots in the order of their steps                       slots words
//   the next task of the turn                                   1 word
//
// The stacks of slots, if they are not part of the records, are in global memory.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

namespace rtsl::device {

struct BlockMemory {
  uint32_t slots;      // less than 2^16
  uint32_t steps;      // traversal, the beginning of samples, and states; less than 2^15
  uint32_t groups;     // of a record, of 16 bytes
  uint64_t stackBytes; // of a slot, a multiple of 16

  uint64_t recordBytes() const { return uint64_t(groups) * slots * 16; }
  uint64_t words() const { return uint64_t(2) * steps + uint64_t(2) * slots + 1; }
  uint64_t sharedBytes() const {
    return (recordBytes() + words() * sizeof(uint32_t) + 15) & ~15ull;
  }
};

} // namespace rtsl::device
