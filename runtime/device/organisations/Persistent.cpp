//===- Persistent.cpp - makes a program self-contained, of persistent blocks ===//
//
// Linked into programs with the organisation `persistent`, for the GPU and for
// `--target=host-megakernel`, in place of the entry points of Megakernel.cpp. The code generator
// makes a copy of rtsl_block_state for each state (codegen/emit/rewrites/WaveStates.h).
//
//===----------------------------------------------------------------------===//
#include "runtime/device/organisations/Persistent.h"
#include "runtime/device/organisations/JobLaunch.h"

#include "runtime/device/organisations/RunThisState.h"

using namespace rtsl;

extern "C" {

/// Defined by the code generator: the copy of rtsl_block_state for `number`.
void rtsl_block_run_state(const RtslJob *job, const device::Block *block, uint32_t turn,
                          const device::BlockTask *task, int32_t number);

void rtsl_block_state(const RtslJob *job, const device::Block *block, uint32_t turn,
                      const device::BlockTask *task, int32_t) {
  device::stateOfTask(*job, *block, turn, *task, device::RunThisState());
}

/// Whether slots have a stack; a constant.
uint32_t rtsl_slots_have_stacks() {
  return !device::hasLevelInRecord();
}

} // extern "C"

static void runBlock(const RtslJob &job, const device::Block &block, uint32_t lane,
                     uint32_t lanes) {
  device::runBlock(job, block, lane, lanes, [&](uint32_t turn, const device::BlockTask &task) {
    rtsl_block_run_state(&job, &block, turn, &task, task.step);
  });
}

#ifdef __NVPTX__

extern "C" {

/// The memory of a block; its size is decided when the kernel is launched.
extern __attribute__((address_space(3), aligned(16))) uint8_t rtsl_block_memory[];

/// One thread per lane; a block has job.slots slots.
__attribute__((nvptx_kernel)) void rtsl_persistent(const RtslJob job) {
  const RtslLaunch &launch = *device::launchOf(job);
  if (!device::hasLaneBytes(job, device::slotStackBytes(launch.maxDepth, launch.referenceChain)))
    return;
  const device::BlockMemory size = {job.slots, rtsl_wave_steps(device::launchOf(job)),
                                    rtsl_record_groups(), job.laneBytes};
  uint8_t *stacks =
      job.lanes + uint64_t(__nvvm_read_ptx_sreg_ctaid_x()) * job.slots * job.laneBytes;
  runBlock(job, device::Block(size, (uint8_t *)rtsl_block_memory, stacks),
           __nvvm_read_ptx_sreg_tid_x(), __nvvm_read_ptx_sreg_ntid_x());
}

} // extern "C"

#else

/// The memory of a block of one lane on a CPU.
static device::BlockMemory sizeOfBlock(uint32_t maxDepth, uint32_t referenceChain) {
  constexpr uint32_t slots = 64;
  return {slots, rtsl_wave_steps(nullptr), rtsl_record_groups(),
          device::slotStackBytes(maxDepth, referenceChain)};
}

extern "C" {

/// The counterparts of rtsl_lane_bytes and rtsl_run_lane.
uint64_t rtsl_block_bytes(uint32_t maxDepth, uint32_t referenceChain) {
  const device::BlockMemory size = sizeOfBlock(maxDepth, referenceChain);
  return size.sharedBytes() + size.slots * size.stackBytes;
}

void rtsl_run_block(const RtslJob *job, uint32_t number) {
  const RtslLaunch &launch = *device::launchOf(*job);
  const device::BlockMemory size = sizeOfBlock(launch.maxDepth, launch.referenceChain);
  if (!device::hasLaneBytes(*job, size.sharedBytes() + size.slots * size.stackBytes))
    return;
  uint8_t *memory = job->lanes + number * job->laneBytes;
  runBlock(*job, device::Block(size, memory, memory + size.sharedBytes()), 0, 1);
}

} // extern "C"

#endif
