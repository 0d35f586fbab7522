// A compiled program has a constant in its place; code of the host serves all programs.
#include "runtime/device/ray/Abi.h"

extern "C" __attribute__((weak)) uint32_t rtsl_needs(const RtslLaunch *launch) {
  return launch->needs;
}
