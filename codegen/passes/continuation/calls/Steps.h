//===- Steps.h - calls of functions that trace ----------------------------===//
//
// Steps with options or results, and their files; common/Steps.def has the others. Split.cpp calls
// them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include <cstdint>
#include <vector>

namespace rtsl::continuation {

/// InlineTracing.cpp: inlines calls of functions that may trace, or, if nothing follows and the
/// object is the caller's own, turns them into jumps (`rtsl.tail` on the call). Recursive
/// functions, and large ones with several callers, get frames of their own: they and their calls
/// are marked `rtsl.framed`.
void inlineTracingCalls(mlir::ModuleOp module);

/// OpenCalls.cpp: for a program without a scene, on level 1: calls of methods that trace, through
/// references, become framed calls of `@dispatch.CLASS.METHOD`, which is only declared. It has the
/// names of the first class that has the method (`rtsl.class`) and of the method (`rtsl.method`).
void callThroughFrames(mlir::ModuleOp module);

/// CallFrames.cpp: the layout of a callee's frame, in bytes.
struct CallLayout {
  llvm::SmallVector<std::int32_t> arguments, results; // without the object
  std::uint32_t size = 0;                             // the callee's saved values begin here
};
CallLayout layoutCall(mlir::TypeRange arguments, mlir::TypeRange results);

/// CallFrames.cpp: a function with a frame of its own loads its arguments from it and stores its
/// results to it.
void takeArgumentsFromFrame(FuncOp function);

/// CallFrames.cpp: bytes of all frames in one level, by the longest chain of references: a[n] if
/// none is longer than n; one value if none of these functions calls itself. For a module whose
/// functions are split.
std::vector<std::uint32_t> frameAreas(mlir::ModuleOp module);

} // namespace rtsl::continuation
