//===- MachineStages.h - the stages that need code generators -------------===//
#pragma once

#include "codegen/driver/Compilation.h"
#include "codegen/driver/MachineCode.h"

namespace rtsl::driver {

/// Machine code of a scene's program in this process: the entry points of `program` are set.
bool reachProgram(Compilation &compilation);

} // namespace rtsl::driver
