//===- ProgramHost.h - the host data of programs, RtslLaunch::host --------===//
#pragma once

#include "runtime/program/Program.h"

namespace rtsl::runtime {

/// RtslLaunch::host points to one if the program calls its methods through its slots; other data of
/// the host may follow.
struct ProgramHost {
  Program::Slots slots;
};

/// The slots, for device code that calls methods: an empty slot does nothing.
struct FilledSlots {
  const Program::Slots &slots;
#define RTSL_SLOT(base, method)                                                                    \
  void base##_##method(RtslState *state, RtslRef object) const {                                   \
    if (slots.base##_##method)                                                                     \
      slots.base##_##method(state, object);                                                        \
  }
#define RTSL_PAYLOAD_SLOT(base, method) RTSL_SLOT(base, method##_payload)
#include "language/PayloadSlots.def"
#include "language/Slots.def"
};

} // namespace rtsl::runtime
