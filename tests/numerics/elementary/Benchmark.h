// Times a function beside the C library's.
#pragma once

#include "Functions.h"

namespace rtsl::elementary {

/// Nanoseconds a call, in a loop of independent calls over usual arguments.
struct Timing {
  double ours, system, systemDouble;
};

Timing time(const Unary &function);
Timing time(const Binary &function);

} // namespace rtsl::elementary
