//===- Megakernel.cpp - makes a program self-contained --------------------===//
//
// Linked into programs for the GPU and for `--target=host-megakernel`: traversal of our own tree,
// memory functions, and the entry points that run lanes.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/organisations/Megakernel.h"

#include "runtime/device/organisations/SampleSums.h"
#include "runtime/device/organisations/WholeSamples.h"
#include "runtime/device/traverse/AnyHit.h"

using namespace rtsl;

extern "C" {

uint32_t rtsl_traverse(RtslState *state, uint32_t how) {
  const bool mayInvoke = rtsl_needs(state->launch) & RTSL_NEEDS_ANY_HIT;
  uint32_t answer = mayInvoke && how & RTSL_INVOKE_ANY_HIT
                        ? device::traverseAsking(*state, how, device::LinkedPayloadSlots())
                        : device::traverseDevice(*state, how, device::LinkedSlots());
  if (answer == RTSL_BAD_RAY)
    device::countUp(&state->launch->status->badRays);
  return answer;
}

uint64_t rtsl_lane_bytes(uint32_t maxDepth, uint32_t referenceChain) {
  return device::laneBytes(maxDepth, referenceChain);
}

void rtsl_run_lane(const RtslJob *job, uint32_t lane) {
  device::runLane(*job, lane);
}

#ifdef __NVPTX__
__attribute__((address_space(4))) RtslLaunch rtsl_launch;

/// LLVM's intrinsic by its name: clang's built-in function can be used only in programs that are
/// compiled for sm_80 or later.
uint32_t leastOf(uint32_t number, uint32_t lanes) __asm__("llvm.nvvm.redux.sync.umin");

/// rtsl_least_of_warp of GPUs from sm_80 on.
uint32_t rtsl_least_by_instruction(const RtslLaunch *, uint32_t number) {
  return leastOf(number, device::warp::all);
}
/// rtsl_least_of_warp of older GPUs: each lane compares its number with those of lanes at distances
/// of 16, 8, ..., 1.
uint32_t rtsl_least_by_exchange(const RtslLaunch *, uint32_t number) {
  for (int distance = 16; distance > 0; distance /= 2) {
    const auto other =
        uint32_t(__nvvm_shfl_sync_bfly_i32(device::warp::all, int32_t(number), distance, 31));
    number = other < number ? other : number;
  }
  return number;
}

static uint32_t threadNumber() {
  return __nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() +
         __nvvm_read_ptx_sreg_tid_x();
}

/// The kernel: one thread per lane, in whole warps.
__attribute__((nvptx_kernel)) void rtsl_render(const RtslJob job) {
  device::runLane(job, threadNumber());
}
/// The same for programs without states; it gets the name of the other one, which they lack.
__attribute__((nvptx_kernel)) void rtsl_render_whole(const RtslJob job) {
  device::runWholeSamples(job);
}
/// One thread per sample of the launch.
__attribute__((nvptx_kernel)) void rtsl_render_samples(const RtslJob job) {
  device::renderSampleOfThread(job, threadNumber());
}
/// One thread per pixel of the launch, where the job allows it, otherwise per sample.
__attribute__((nvptx_kernel)) void rtsl_render_pixels(const RtslJob job) {
  if (job.mayTakePixels)
    device::renderPixelOfThread(job, threadNumber());
  else
    device::renderSampleOfThread(job, threadNumber());
}
/// The kernel that adds its samples to the sums afterwards, with any number of threads.
__attribute__((nvptx_kernel)) void rtsl_sum(const RtslJob job) {
  device::addSamples(job, threadNumber(),
                     __nvvm_read_ptx_sreg_nctaid_x() * __nvvm_read_ptx_sreg_ntid_x());
}
#endif

} // extern "C"
