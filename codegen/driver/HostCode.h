//===- HostCode.h - linked IR as a program in this process ----------------===//
#pragma once

#include "codegen/driver/Compiler.h"

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::driver {

/// Fills in those entries of `program`, whose classes are known, that make the objects of a scene.
/// They run once, so they are compiled lightly. `ir` is used up.
void compileConstructors(mlir::ModuleOp ir, const CompileOptions &options,
                         runtime::Program &program);

} // namespace rtsl::driver
