//===- HostFunctions.h - what compiled programs need from the host --------===//
//
// Their functions, such as rtsl_print and rtsl_traverse, are found by name. What they note is of
// the program that runs in this process.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/PrintLog.h"

#include <cstdint>
#include <vector>

namespace rtsl::random {

/// Nothing is printed yet, and no ray has hit anything. `prints`: the program's formats.
void beginRun(const std::vector<runtime::PrintFormat> &prints);
/// All that was printed since then, as one number.
std::uint32_t hashOfPrinted();
/// Whether a ray has hit something since then.
bool hasRayThatHit();
/// Ends the process if the program wrote past the stack of its machine.
void checkStack();

} // namespace rtsl::random
