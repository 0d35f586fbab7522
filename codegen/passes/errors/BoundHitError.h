//===- BoundHitError.h - from `intersect` to the error of its t -----------===//
//
//   func.func @Sphere.intersect(%self)          func.func @Sphere.rt_boundHitError(%self)
//     ...                                         %T = HitDistance
//     %h = rtsl.hit %t                   ==>      ... with t in double beside it, %t64 (RunningError.h)
//     ...                                         %h = T < t
//                                                 bound = t64 is nearest to T ? |T - t64| : bound
//                                                 ...
//                                                 hitError = bound
//
// The new function computes in double what `intersect` has computed when it reported the hit at T:
// the difference is the error. -1 if that is not known, and -2 if there is no such hit
// (runtime/device/ray/HitError.h). So nothing is lost where no ray leaves the hit. It writes no
// scratch members, prints nothing, and draws no random numbers.
//
// It takes the branches that double takes, which are the right ones, but for comparisons that
// elementary functions leave in doubt, because they are exact to single precision only. If the hit
// is not found, these are decided the other way, all of them, and everything is run once more.
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

/// Hits of an `intersect` whose error has no bound, and why.
struct UnboundHit {
  mlir::Location place;
  std::string reason;
};

/// Turns an `intersect` of level 2 into the function above, in place; false if none of its hits has
/// a bound that is to be derived, and then the function is not to be used. Hits for which the
/// author states an error are left to him.
bool boundHitError(mlir::func::FuncOp intersect, ElementaryErrors elementary,
                   std::vector<UnboundHit> &unbound);

/// `rtsl-bound-hit-error`, on a function.
void registerBoundHitErrorPass();

} // namespace rtsl
