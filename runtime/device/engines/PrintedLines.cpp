//===- PrintedLines.cpp - `print` where the host cannot be called ---------===//
//
// For programs on a GPU, and for the host machine code of packages, which has no external
// references.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/engines/PrintedLines.h"

extern "C" void rtsl_print(RtslState *state, uint32_t format, const uint32_t *words,
                           uint32_t count) {
  RtslStatus &status = *state->launch->status;
  if (status.printed)
    rtsl::device::printLine(status, *state->events, format, words, count);
}
