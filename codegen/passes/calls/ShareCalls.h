//===- ShareCalls.h - equal calls of pure functions -----------------------===//
//
// The methods of a material compute the same frame of the surface, each for itself:
//
//     rtsl.illuminate ...                          rtsl.illuminate ...
//     cf.cond_br %isLit, ^lit, ^next               call @Lambert.frame(%self, %axes)
//   ^lit:                                          cf.cond_br %isLit, ^lit, ^next
//     call @Lambert.frame(%self, %axes)          ^lit:
//     ...                                    ==>   ... %axes ...
//     cf.br ^next                                  cf.br ^next
//   ^next:                                       ^next:
//     call @Lambert.frame(%self, %other)           ... %axes ...
//     ... %other ...
//
// A function can be shared if it reads only members, and state that its caller does not write, and
// writes only its result. The one call that remains stands where each path to an end of the caller
// comes to one of the others, in front of a loop if some of them are in it. No ray is sent between
// it and them: a result would have to be saved across a trace. Only across rays to lights, which
// are not awaited in another state, results are kept that take more than a few operations.
//
// Functions come after those that they call. So before a call is shared, what its callee computes
// wherever it is called has become calls of the caller's (LiftCalls.h), and what it reads of
// aggregates has become arguments (PassParts.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-share-calls`, on a module of level 2.
std::unique_ptr<mlir::Pass> createShareCallsPass();

} // namespace rtsl::codegen
