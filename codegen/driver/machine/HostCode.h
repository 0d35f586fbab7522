//===- HostCode.h - linked IR as a program in this process ----------------===//
#pragma once

#include "codegen/driver/Compilation.h"

namespace rtsl::driver {

/// Compiles the functions of a linked program that make the objects of a scene, and sets these
/// entry points of `program`. They run once, so they are hardly optimised. `ir` is consumed.
void compileConstructors(mlir::ModuleOp ir, const CompileOptions &options,
                         runtime::Program &program);

/// Compiles level 2 of a scene's program to machine code and sets its entry points.
void compileHostCode(Compilation &compilation);

} // namespace rtsl::driver
