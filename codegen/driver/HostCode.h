//===- HostCode.h - linked IR as a program in this process ----------------===//
#pragma once

#include "codegen/driver/Compiler.h"

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::driver {

/// Fills in the entries of `program`, whose classes are known. `ir` is used up.
void compileLinked(mlir::ModuleOp ir, const CompileOptions &options, runtime::Program &program);

/// The same with what makes the objects of a scene and nothing else. It runs once, so it is
/// compiled lightly.
void compileConstructors(mlir::ModuleOp ir, const CompileOptions &options,
                         runtime::Program &program);

} // namespace rtsl::driver
