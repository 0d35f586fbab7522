//===- PassFrame.h - the frame as a parameter of a state ------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/StringMap.h"

namespace rtsl::continuation {

/// From the names of states to their numbers, from 1.
using StateNumbers = llvm::StringMap<std::int32_t>;

/// Gives the state its frame as the last parameter, and replaces the operations on the frame and on
/// the frames of its callees by loads and stores at addresses in it. Fails if a call resumes in a
/// function that is not a state.
mlir::LogicalResult passFrame(FuncOp state, const StateNumbers &numbers);

} // namespace rtsl::continuation
