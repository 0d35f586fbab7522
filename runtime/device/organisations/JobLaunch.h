//===- JobLaunch.h - the launch of a job ----------------------------------===//
//
// On a GPU the launch is a variable of the program in constant memory, to which the host copies it
// (runtime/gpu/GpuRenderer.cpp). Its address is known: so what it holds is an operand of
// instructions, and waits in no register.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"

#ifdef __NVPTX__
extern "C" __attribute__((address_space(4))) RtslLaunch rtsl_launch;
#endif

namespace rtsl::device {

/// The same as RtslJob::launch.
inline const RtslLaunch *launchOf([[maybe_unused]] const RtslJob &job) {
#ifdef __NVPTX__
  return (const RtslLaunch *)&rtsl_launch;
#else
  return job.launch;
#endif
}

} // namespace rtsl::device
