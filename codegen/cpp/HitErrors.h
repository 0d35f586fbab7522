//===- HitErrors.h - bounds of t, in C++ ----------------------------------===//
//
// What the compiler derives from `intersect` (codegen/passes/errors) has no source of the author's:
// it is printed from the IR, an operation a line.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::cpp {

/// The functions `Class.rt_boundHitError` of a module, brought back to level 1.
struct HitErrorFunctions {
  mlir::ModuleOp ir;
};

} // namespace rtsl::cpp
