//===- program.h - what a generated file exports --------------------------===//
#pragma once

#include "runtime/program/Program.h"

#include <memory>

/// A C++ program, of which C only sees a pointer (rtsl/rtsl.h).
struct RtslShaders {
  std::shared_ptr<const rtsl::runtime::Program> program;
};

/// Declares what the shaders of a generated file `name.cpp` export: `name_shaders()`.
#define RTSL_DECLARE_SHADERS(name) extern "C" const RtslShaders *name##_shaders()

namespace rtsl {

/// Of no shaders, null, there is no program: a Scene refuses it.
inline std::shared_ptr<const runtime::Program> program(const RtslShaders *shaders) {
  return shaders ? shaders->program : nullptr;
}

} // namespace rtsl
