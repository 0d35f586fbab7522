//===- CppOutput.h - C++ of a module --------------------------------------===//
#pragma once

#include "codegen/driver/Compilation.h"

namespace rtsl::driver {

/// C++ of a module that is linked without a scene, as CompileInput::cpp says. False if there were
/// errors.
bool printCpp(Compilation &compilation);

} // namespace rtsl::driver
