//===- Wavefront.cpp - makes a program self-contained, with a kernel a step ===//
//
// Linked into programs with the organisation `wavefront`, for the GPU and for
// `--target=host-megakernel`, in place of the entry points of Megakernel.cpp. The code generator
// makes a copy of rtsl_wave_state for each state, and one of rtsl_wave_light for large ones that
// call `illuminate` (codegen/emit/rewrites/WaveStates.h).
//
//===----------------------------------------------------------------------===//
#include "runtime/device/organisations/Wavefront.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/RunThisState.h"

using namespace rtsl;

extern "C" {

/// Defined by the code generator for each copy of rtsl_wave_state: whether it has one of
/// rtsl_wave_light.
uint32_t rtsl_are_lights_known();

/// Whether slots have a stack; a constant.
uint32_t rtsl_slots_have_stacks() {
  return !device::hasLevelInRecord();
}

} // extern "C"

/// Traversal and each state has one, but not the beginning of samples.
static uint32_t queuesOfWave(const RtslLaunch *launch) {
  return rtsl_wave_steps(launch) - 1;
}

#ifdef __NVPTX__

namespace {

uint32_t threadNumber() {
  return __nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() +
         __nvvm_read_ptx_sreg_tid_x();
}

uint32_t threadCount() {
  return __nvvm_read_ptx_sreg_nctaid_x() * __nvvm_read_ptx_sreg_ntid_x();
}

device::Wave waveOf(const RtslJob &job) {
  return device::Wave({job.slots, queuesOfWave(device::launchOf(job)), rtsl_record_groups(),
                       job.laneBytes, device::lightWordsOfSlot(device::launchOf(job))},
                      job.lanes);
}

} // namespace

extern "C" {

__attribute__((nvptx_kernel)) void rtsl_wave_begin(const RtslJob job) {
  device::beginWave(waveOf(job), threadNumber(), threadCount());
}

__attribute__((nvptx_kernel)) void rtsl_wave_trace(const RtslJob job, uint32_t turn) {
  device::traceWave(job, waveOf(job), turn, threadNumber(), threadCount());
}

__attribute__((nvptx_kernel)) void rtsl_wave_sample(const RtslJob job, uint32_t turn) {
  const RtslLaunch &launch = *device::launchOf(job);
  if (!device::hasLaneBytes(job, device::slotStackBytes(launch.maxDepth, launch.referenceChain)))
    return; // no sample begins, and the job is over
  device::sampleWave(job, waveOf(job), turn, threadNumber(), threadCount());
}

__attribute__((nvptx_kernel)) void rtsl_wave_state(const RtslJob job, uint32_t turn,
                                                   int32_t number) {
  device::stateWave(job, waveOf(job), turn, number, threadNumber(), threadCount(),
                    rtsl_are_lights_known(), device::RunThisState());
}

__attribute__((nvptx_kernel)) void rtsl_wave_light(const RtslJob job, uint32_t turn,
                                                   int32_t number) {
  device::lightWave(job, waveOf(job), turn, number, threadNumber(), threadCount(),
                    device::RunThisState());
}

} // extern "C"

#else

extern "C" {

/// Defined by the code generator: the copies of rtsl_wave_state and rtsl_wave_light for `number`;
/// of the second there may be none.
void rtsl_wave_run_state(const RtslJob *job, const device::Wave *wave, uint32_t turn,
                         int32_t number);
void rtsl_wave_run_light(const RtslJob *job, const device::Wave *wave, uint32_t turn,
                         int32_t number);

void rtsl_wave_state(const RtslJob *job, const device::Wave *wave, uint32_t turn, int32_t number) {
  device::stateWave(*job, *wave, turn, number, 0, 1, rtsl_are_lights_known(),
                    device::RunThisState());
}

void rtsl_wave_light(const RtslJob *job, const device::Wave *wave, uint32_t turn, int32_t number) {
  device::lightWave(*job, *wave, turn, number, 0, 1, device::RunThisState());
}

static device::WaveMemory memoryOfThread(uint32_t maxDepth, uint32_t referenceChain) {
  return {device::slotsOfThread, queuesOfWave(nullptr), rtsl_record_groups(),
          device::slotStackBytes(maxDepth, referenceChain), device::lightWordsOfSlot(nullptr)};
}

/// The counterparts of rtsl_lane_bytes and rtsl_run_lane.
uint64_t rtsl_wave_bytes(uint32_t maxDepth, uint32_t referenceChain) {
  return memoryOfThread(maxDepth, referenceChain).bytes();
}

void rtsl_run_wave(const RtslJob *job, uint32_t lane) {
  const RtslLaunch &launch = *device::launchOf(*job);
  const device::WaveMemory size = memoryOfThread(launch.maxDepth, launch.referenceChain);
  if (!device::hasLaneBytes(*job, size.bytes()))
    return;
  const device::Wave wave(size, job->lanes + lane * job->laneBytes);
  for (uint32_t turn = 0; turn < 2; ++turn)
    wave.clearCounts(turn);
  device::beginWave(wave, 0, 1);
  for (uint32_t turn = 0;;) {
    device::sampleWave(*job, wave, turn++, 0, 1);
    if (!wave.isAnyInFlight(turn))
      return;
    for (; wave.isAnyInFlight(turn); ++turn) {
      device::traceWave(*job, wave, turn, 0, 1);
      for (uint32_t state = 1; state <= wave.states(); ++state) {
        rtsl_wave_run_light(job, &wave, turn, int32_t(state));
        rtsl_wave_run_state(job, &wave, turn, int32_t(state));
      }
      wave.clearCounts(turn);
    }
  }
}

} // extern "C"

#endif
