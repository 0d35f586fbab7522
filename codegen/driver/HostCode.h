//===- HostCode.h - linked IR as a program in this process ----------------===//
#pragma once

#include "codegen/driver/Compiler.h"

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::driver {

/// Compiles the functions of a linked program that make the objects of a scene, and sets these
/// entry points of `program`. They run once, so they are hardly optimised. `ir` is consumed.
void compileConstructors(mlir::ModuleOp ir, const CompileOptions &options,
                         runtime::Program &program);

} // namespace rtsl::driver
