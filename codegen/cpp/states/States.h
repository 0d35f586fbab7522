//===- States.h - methods that trace, as their states ---------------------===//
//
// The one part of C++ that is printed from the IR: the states of a method that was split at its
// traces, converted to structured control flow (codegen/passes/restructure). Their expressions
// are still the author's (codegen/lower/SourceTable.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/lower/SourceTable.h"

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::cpp {

/// The methods that trace, split: a module on level 1 in which a method consists of the functions
/// `Class.method.state0` and so on.
struct StateProgram {
  mlir::ModuleOp ir;
  const SourceTable &source;
};

/// The table for lowering that this printer requires. `raises`: an index out of range ends the
/// sample.
SourceTable makeSourceTable(const typed::Module &module, bool raises);

} // namespace rtsl::cpp
