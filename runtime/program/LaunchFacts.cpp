//===- LaunchFacts.cpp - facts of a scene, from its launch ----------------===//
//
// A compiled program defines these itself, as constants; this code of the host serves all programs.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/ray/Abi.h"

extern "C" {

__attribute__((weak)) uint32_t rtsl_needs(const RtslLaunch *launch) {
  return launch->needs;
}
__attribute__((weak)) const RtslInstance *rtsl_instances(const RtslLaunch *launch) {
  return launch->instances;
}
__attribute__((weak)) uint32_t rtsl_listed_instances(const RtslLaunch *) {
  return 0;
}

} // extern "C"
