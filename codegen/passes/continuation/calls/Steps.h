//===- Steps.h - calls of functions that trace ----------------------------===//
//
// Each step lies in the file that is named here; Split.cpp calls them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include <cstdint>
#include <vector>

namespace rtsl::continuation {

/// InlineTracing.cpp: a call of a function that may trace becomes that function's body, or, where
/// nothing follows and the object is the caller's own, a jump (`rtsl.tail` on the call). Functions
/// that would become part of themselves, and large ones that several call, get frames of their own:
/// they and their calls are marked `rtsl.framed`.
void inlineTracingCalls(mlir::ModuleOp module);

/// OpenCalls.cpp: of a program without a scene, on level 1: calls of methods that trace, through
/// references, become framed calls of `@dispatch.CLASS.METHOD`, which is only declared. It has the
/// names of the first class that has the method (`rtsl.class`) and of the method (`rtsl.method`).
void callThroughFrames(mlir::ModuleOp module);

/// CallFrames.cpp: where what a call hands over lies in the frame of what it calls, in bytes.
struct CallLayout {
  llvm::SmallVector<std::int32_t> arguments, results; // but for the object
  std::uint32_t size = 0;                             // what the callee saves itself begins here
};
CallLayout layoutCall(mlir::TypeRange arguments, mlir::TypeRange results);

/// CallFrames.cpp: a function with a frame of its own finds its arguments there, and leaves its
/// results.
void takeArgumentsFromFrame(FuncOp function);

/// CallFrames.cpp: bytes of all frames that lie above each other in one level, by how far chains of
/// references reach: a[n] if none is longer than n; one value if none of these functions calls
/// itself. Of a module whose functions are split.
std::vector<std::uint32_t> frameAreas(mlir::ModuleOp module);

} // namespace rtsl::continuation
