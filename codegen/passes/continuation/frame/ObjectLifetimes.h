//===- ObjectLifetimes.h - liveness of objects in the frame ---------------===//
//
// A variable in the frame, such as a payload, is cleared at its declaration and live until its last
// use. Two that are never live at the same time may share their words, and so may an object and
// values that are saved only at traces where it is not live.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/BitVector.h"

namespace rtsl::continuation {

struct ObjectLifetime {
  ir::FrameObjectOp object; // the first of its name: it may be recomputed elsewhere
  llvm::BitVector traces;   // at which it is live, or passed to the ray
  llvm::BitVector objects;  // that are live while this one is
};

/// The lifetimes in the order of the objects; `suspends` are those of the function.
std::vector<ObjectLifetime> lifetimesOfObjects(FuncOp function,
                                               llvm::ArrayRef<ir::SuspendOp> suspends);

} // namespace rtsl::continuation
