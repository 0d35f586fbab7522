//===- HitErrors.h - bounds of t, in C++ ----------------------------------===//
//
// What the compiler derives from `intersect` (codegen/passes/errors) has no source of the author's:
// it is printed from the IR, an operation a line.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/tree/Declaration.h"
#include "sema/typed/TypedAst.h"

#include "mlir/IR/BuiltinOps.h"

#include <set>

namespace rtsl::cpp {

/// The functions `Class.rt_boundHitError` of a module, converted to level 1.
struct HitErrorFunctions {
  mlir::ModuleOp ir;
};

class Context;

/// `boundHitError(rt, self)` for each primitive that has one; `printed` gets their classes.
Declarations hitErrors(Context &context, std::set<const typed::Class *> &printed);

} // namespace rtsl::cpp
