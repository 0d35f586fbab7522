//===- BuildKernels.cpp - the kernels that build trees ---------------------===//
#include "runtime/device/trees/Clusters.h"
#include "runtime/device/trees/Refit.h"
#include "runtime/device/trees/Sort.h"
#include "runtime/device/trees/Widen.h"

using namespace rtsl::device::build;

extern "C" {

uint32_t rtsl_needs(const RtslLaunch *launch) {
  return launch->needs;
}

#define RTSL_BUILD_STEP(name, call)                                                                \
  __attribute__((nvptx_kernel)) void rtsl_build_##name(const TreeBuild *memory, uint32_t count,    \
                                                       uint32_t a, uint32_t b, uint32_t c) {       \
    const TreeBuild build = *memory;                                                               \
    const uint32_t i = __nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() +            \
                       __nvvm_read_ptx_sreg_tid_x();                                               \
    (void)a, (void)b, (void)c;                                                                     \
    if (i < count) [[clang::always_inline]]                                                        \
      call; /* or `build` would be copied to memory */                                             \
  }
#include "runtime/device/trees/Steps.def"

} // extern "C"
