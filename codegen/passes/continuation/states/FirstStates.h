//===- FirstStates.h - the states in which entry points begin -------------===//
//
// An entry point of the machine, such as `shade`, is a function that branches on the class of its
// object and continues with the method of that class. After splitting it is a state. Where it only
// jumps to the state of a method, the machine goes there directly: one step less for each ray.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/states/PassFrame.h"

#include <map>
#include <string>

namespace rtsl::continuation {

/// The names of the states in which entry points begin, by the entry points' symbols; empty for a
/// slot of the machine that has no state. Erases the states of entry points that jump to another
/// state whatever the object is: they begin in that one.
std::map<std::string, std::string> findFirstStates(mlir::ModuleOp module);

/// Appends `@rtsl_first_state(%state: i32, %object) -> i32`: where the state of an entry point only
/// jumps for this object, the number of the state that it jumps to, otherwise `%state`.
FuncOp makeFirstState(mlir::ModuleOp module, llvm::ArrayRef<FuncOp> states,
                      const StateNumbers &numbers);

} // namespace rtsl::continuation
