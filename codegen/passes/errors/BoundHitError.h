//===- BoundHitError.h - from `intersect` to the error of its t -----------===//
//
//   func.func @Sphere.intersect(%self)          func.func @Sphere.rt_boundHitError(%self)
//     ...                                         %T = HitDistance
//     %h = rtsl.hit %t                   ==>      ... with t in double, %t64 (RunningError.h)
//     ...                                         %h = T < t
//                                                 bound = t64 is nearest to T ? |T - t64| : bound
//                                                 ...
//                                                 hitError = bound
//
// The new function computes in double the value that `intersect` computed when it reported the hit
// at T: the difference is the error. The result is -1 if that is not known, and -2 if there is no
// such hit (runtime/device/ray/HitError.h). So this costs nothing if no ray leaves the hit. The
// function writes no scratch members, prints nothing, and draws no random numbers.
//
// It takes the branches that double takes, which are the correct ones, except for comparisons whose
// result is uncertain because elementary functions are exact to single precision only. If it does
// not find the hit, all of these are inverted and everything is run once more.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/errors/RunningError.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <memory>
#include <vector>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl {

/// A hit of an `intersect` whose error has no bound, and why.
struct UnboundHit {
  mlir::Location place;
  std::string reason;
};

/// Turns an `intersect` of level 2 into the function above, in place; false if no bound is derived
/// for any of its hits, and then the function must not be used. Hits whose error the author states
/// need none.
bool boundHitError(mlir::func::FuncOp intersect, ElementaryErrors elementary,
                   std::vector<UnboundHit> &unbound);

/// `rtsl-bound-hit-error`, on a function.
void registerBoundHitErrorPass();

} // namespace rtsl
