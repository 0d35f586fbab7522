// A compiled program defines a constant instead; this code of the host serves all programs.
#include "runtime/device/ray/Abi.h"

extern "C" __attribute__((weak)) uint32_t rtsl_needs(const RtslLaunch *launch) {
  return launch->needs;
}
