//===- ObjectLifetimes.h - when what an object holds is wanted ------------===//
//
// A variable that lies in the frame, as payloads do, is cleared where it is declared and wanted
// until its last use. Two that are never wanted at the same time may share their words, and so may
// an object and what is saved at traces at which it is not wanted.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/BitVector.h"

namespace rtsl::continuation {

struct ObjectLifetime {
  ir::FrameObjectOp object; // the first of its name: it may be computed again elsewhere
  llvm::BitVector traces;   // at which it is wanted, or handed to the ray
  llvm::BitVector objects;  // that are wanted while this one is
};

/// In the order in which the objects stand; `suspends` are those of the function.
std::vector<ObjectLifetime> lifetimesOfObjects(FuncOp function,
                                               llvm::ArrayRef<ir::SuspendOp> suspends);

} // namespace rtsl::continuation
