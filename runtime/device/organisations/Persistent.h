//===- Persistent.h - blocks of lanes with samples of their own -----------===//
//
// The machine of Machine.h for blocks of lanes that stay on a GPU until no sample is left. Like a
// wavefront (Wavefront.h) a block has more samples in flight than lanes, and sorts them by their
// next step, so that all lanes of a warp run the same step. But it does so by itself, in one
// kernel, and records and queues are in the shared memory of the block, not in the GPU's.
//
// A turn takes all slots of the block through one step. It consists of tasks, which warps take one
// after the other: up to 32 slots that wait for the same step. The lanes of the block wait for each
// other where a turn begins.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/BlockMemory.h"
#include "runtime/device/organisations/QueuePlace.h"
#include "runtime/device/organisations/SlotRecords.h"
#include "runtime/device/organisations/StepCounts.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

/// All lanes of the block call together, and see what others wrote before.
inline void waitForBlock() {
#ifdef __NVPTX__
  __syncthreads();
#endif
}

/// What a warp does in a turn: a step, of the slots from place `first` on in the block's order.
struct BlockTask {
  int32_t step; // Step::nothing: the turn has no more tasks
  uint32_t first, end;
};

class Block {
public:
  Block(const BlockMemory &size, uint8_t *shared, uint8_t *stacks)
      : size(size), counts(reinterpret_cast<uint32_t *>(shared + size.recordBytes())),
        waits(counts + 2 * size.steps), slotsInOrder(waits + size.slots),
        nextTask(slotsInOrder + size.slots), records(size.slots, shared, stacks, size.stackBytes) {}

  /// Makes all slots wait for a sample, in turn 0.
  void begin(uint32_t lane, uint32_t lanes) const {
    for (uint32_t i = lane; i < 2 * size.steps; i += lanes)
      counts[i] = i == placeOfStep(Step::sample) ? size.slots : 0;
    for (uint32_t slot = lane; slot < size.slots; slot += lanes) {
      records.storeNoSample(slot);
      waits[slot] = placeOfStep(Step::sample) << 16 | slot;
    }
  }

  /// Orders the slots by the steps that they wait for. False if they wait for none.
  bool beginTurn(uint32_t turn, uint32_t lane, uint32_t lanes) const;

  /// The next task of the turn. The lanes of a warp call together and get the same.
  BlockTask takeTask(uint32_t turn) const;

  uint32_t slotAt(uint32_t place) const { return slotsInOrder[place]; }

  /// Lets the slot wait for a step in the turn after `turn`. All lanes of a warp call together;
  /// those without a slot have Step::nothing.
  void put(uint32_t turn, int32_t step, uint32_t slot, bool hasSlot) const {
    const uint32_t place =
        placeInQueue(step, [&] { return &countsOf(turn ^ 1)[placeOfStep(step)]; });
    if (hasSlot)
      waits[slot] = step == Step::nothing ? none : placeOfStep(step) << 16 | place;
  }

private:
  static constexpr uint32_t none = 0xffffffffu;

  uint32_t *countsOf(uint32_t turn) const { return counts + (turn & 1) * size.steps; }

  BlockMemory size;
  uint32_t *counts, *waits, *slotsInOrder, *nextTask;

public:
  SlotRecords records;
};

inline bool Block::beginTurn(uint32_t turn, uint32_t lane, uint32_t lanes) const {
  waitForBlock();
  const uint32_t *now = countsOf(turn);
  for (uint32_t slot = lane; slot < size.slots; slot += lanes) {
    if (waits[slot] == none)
      continue;
    uint32_t place = waits[slot] & 0xffff;
    for (uint32_t step = 0; step < waits[slot] >> 16; ++step)
      place += now[step];
    slotsInOrder[place] = slot;
  }
  uint32_t waiting = 0;
  for (uint32_t step = 0; step < size.steps; ++step)
    waiting += now[step];
  for (uint32_t step = lane; step < size.steps; step += lanes)
    countsOf(turn ^ 1)[step] = 0;
  if (lane == 0)
    *nextTask = 0;
  waitForBlock();
  return waiting != 0;
}

inline BlockTask Block::takeTask(uint32_t turn) const {
  uint32_t task = 0;
#ifdef __NVPTX__
  if (__nvvm_read_ptx_sreg_laneid() == 0)
    task = __atomic_fetch_add(nextTask, 1u, __ATOMIC_RELAXED);
  task = uint32_t(warp::valueOf(int32_t(task), 0));
#else
  task = (*nextTask)++;
#endif
  const uint32_t *now = countsOf(turn);
  uint32_t begin = 0;
  for (uint32_t step = 0; step < size.steps; ++step) {
    const uint32_t tasks = (now[step] + lanesOfWarp - 1) / lanesOfWarp;
    if (task < tasks)
      return {int32_t(step) + Step::trace, begin + task * lanesOfWarp, begin + now[step]};
    task -= tasks;
    begin += now[step];
  }
  return {Step::nothing, 0, 0};
}

/// Runs `run(takesPart, slot)`, which returns the next step, on the slot that a task has for the
/// lane.
template <typename Run>
RTSL_INLINED void runTask(const RtslJob &job, const Block &block, uint32_t turn,
                          const BlockTask &task, Run run) {
#ifdef __NVPTX__
  const uint32_t place = task.first + __nvvm_read_ptx_sreg_laneid();
#else
  const uint32_t place = task.first;
#endif
  const bool takesPart = place < task.end;
  const uint32_t slot = takesPart ? block.slotAt(place) : 0;
  countStep(job, task.step, takesPart);
  block.put(turn, run(takesPart, slot), slot, takesPart);
}

/// Runs a state, by run(rays), which is inlined here: the code generator copies this once for each
/// state.
template <typename Run>
RTSL_INLINED void stateOfTask(const RtslJob &job, const Block &block, uint32_t turn,
                              const BlockTask &task, Run run) {
  const auto runRays = [&](Flight &flight) RTSL_ALWAYS_INLINE { run(flight.rays); };
  runTask(job, block, turn, task, [&](bool takesPart, uint32_t slot) RTSL_ALWAYS_INLINE {
    return takesPart ? runOnSlot(job, block.records, slot, runRays) : Step::nothing;
  });
}

/// Renders until no sample is left. runState(turn, task) runs a task of a state.
template <typename RunState>
inline void runBlock(const RtslJob &job, const Block &block, uint32_t lane, uint32_t lanes,
                     RunState runState) {
  block.begin(lane, lanes);
  for (uint32_t turn = 0; block.beginTurn(turn, lane, lanes); turn ^= 1)
    for (;;) {
      const BlockTask task = block.takeTask(turn);
      if (task.step == Step::nothing)
        break;
      if (task.step == Step::trace)
        runTask(job, block, turn, task, [&](bool takesPart, uint32_t slot) {
          return takesPart ? traceOnSlot(job, block.records, slot) : Step::nothing;
        });
      else if (task.step == Step::sample)
        runTask(job, block, turn, task, [&](bool takesPart, uint32_t slot) {
          const uint32_t following = takeOneSample(job, takesPart);
          return takesPart ? sampleOnSlot(job, block.records, slot, following) : Step::nothing;
        });
      else
        runState(turn, task);
    }
}

} // namespace rtsl::device
