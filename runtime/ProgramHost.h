//===- ProgramHost.h - what programs find behind RtslLaunch::host ---------===//
#pragma once

#include "runtime/Program.h"

namespace rtsl::runtime {

/// RtslLaunch::host leads to one when the program calls its methods through its slots; the host's own things may follow.
struct ProgramHost {
  Program::Slots slots;
};

} // namespace rtsl::runtime
