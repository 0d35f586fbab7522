//===- Steps.h - how a function is split at its traces --------------------===//
//
// One function a step, in the order in which Split.cpp calls them; each lies in the file that is
// named here, and each is a pass of its own in rtsl-opt (Passes.h). docs/continuations.md shows
// what each makes of a small shader.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::continuation {

using mlir::func::FuncOp;

/// The suspends of a function, in the order in which their blocks stand.
llvm::SmallVector<ir::SuspendOp> suspendsOf(FuncOp function);

/// The object of a method: it comes with the ray and is never saved. Null if the first argument is
/// no reference.
mlir::Value objectOf(FuncOp function);

/// The functions of the module that trace, or that call one that does.
llvm::SmallVector<FuncOp> tracingFunctions(mlir::ModuleOp module);

/// Those of them that calls lead back to.
llvm::SmallVector<FuncOp> functionsThatMayCallThemselves(mlir::ModuleOp module);

/// The entries that the machine starts (runtime/device/Machine.h): their states are made even if
/// they do not trace.
llvm::ArrayRef<llvm::StringLiteral> machineEntries();

//===----------------------------------------------------------------------===//
// Before the cut
//===----------------------------------------------------------------------===//

/// InlineTracing.cpp: a call of a function that may trace becomes that function's body, or, where
/// nothing follows and the object is the caller's own, a jump (`rtsl.tail` on the call). Functions
/// that would become part of themselves, and large ones that several call, get frames of their own:
/// they and their calls are marked `rtsl.framed`.
void inlineTracingCalls(mlir::ModuleOp module);

/// OpenCalls.cpp: of a program without a scene, on level 1: calls of methods that trace, through references, become framed
/// calls of `@dispatch.CLASS.METHOD`, which is only declared. It has the names of the first class that has the method
/// (`rtsl.class`) and of the method (`rtsl.method`).
void callThroughFrames(mlir::ModuleOp module);

/// CallFrames.cpp: where what a call hands over lies in the frame of what it calls, in bytes.
struct CallLayout {
  llvm::SmallVector<std::int32_t> arguments, results; // but for the object
  std::uint32_t size = 0; // what the callee saves itself begins here
};
CallLayout layoutCall(mlir::TypeRange arguments, mlir::TypeRange results);

/// Has the function, or the call, a frame of its own?
bool isFramed(mlir::Operation *op);

/// CallFrames.cpp: a function with a frame of its own finds its arguments there, and leaves its
/// results.
void takeArgumentsFromFrame(FuncOp function);

/// CallFrames.cpp: bytes of all frames that lie above each other in one level, by how far chains of
/// references reach: a[n] if none is longer than n; one value if none of these functions calls
/// itself. Of a module whose functions are split.
std::vector<std::uint32_t> frameAreas(mlir::ModuleOp module);

/// Fields of a payload that are not passed with its rays.
struct TrimmedPayload {
  std::string payload;
  std::vector<std::string> fields;
  std::uint32_t bytesBefore = 0, bytes = 0;
};

/// TrimPayloads.cpp: takes fields out of payloads that nobody reads, and those that only the senders
/// of rays use. Does nothing to a module that is not linked: other classes may read them.
std::vector<TrimmedPayload> trimPayloads(mlir::ModuleOp module);

/// What ends a chain of rays but the limit of depth.
struct Endings {
  bool alwaysTraces = false;   // on every way: nothing does
  std::vector<std::string> by; // what conditions are made of: "rand()", "its payload", "rt_Depth"
};

/// Endings.cpp: of a function that traces, before it is split.
Endings endingsOf(FuncOp function);

/// InsertSuspends.cpp: ends blocks at their traces.
void insertSuspends(FuncOp function);

/// LastTraces.cpp: a method ends at a trace behind which nothing happens; its ray takes the place of
/// this one. Gives where these traces stood.
llvm::SmallVector<mlir::Location> endAtLastTraces(FuncOp function);

/// LastTraces.cpp: whether nothing happens behind a trace but sums and products of what it brings
/// back.
bool onlyScalesAndAdds(ir::SuspendOp suspend);

/// FrameObjects.cpp: variables that are still in memory and live across a trace move to the frame.
void moveVariablesToFrame(FuncOp function);

/// IdleClears.cpp: of a program that is printed for people, no variable is cleared that is written before it is read.
void removeIdleClears(FuncOp function);

/// TrimVectors.cpp: parts that are taken out of a vector behind a trace are taken out before it.
void trimVectors(FuncOp function);

//===----------------------------------------------------------------------===//
// What is saved
//===----------------------------------------------------------------------===//

/// What happens to the values that are needed behind one trace.
struct SuspendPlan {
  ir::SuspendOp suspend;
  llvm::SmallVector<mlir::Value> saved; // in program order
  llvm::SmallVector<mlir::Value>
      recomputed; // in program order; operands before what is made of them
};

struct RematerialiseOptions {
  /// Save everything that can be saved; recompute addresses only. What is compared with.
  bool onlyAddresses = false;
};

/// Rematerialise.cpp: decides what is saved and what is recomputed at each trace. Fails with a
/// message if something can neither be saved nor recomputed.
mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options);

/// Recomputes behind each trace what the plan says. What is still live across it afterwards is what
/// the plan saves.
void rematerialise(FuncOp function, llvm::ArrayRef<SuspendPlan> plan);

/// SaveLive.cpp: passes what is live across a suspend to the arguments of its resume block, by
/// name.
mlir::LogicalResult saveLive(FuncOp function);

//===----------------------------------------------------------------------===//
// Where it is saved
//===----------------------------------------------------------------------===//

/// A place in the frame.
struct FrameSlot {
  std::string name;
  std::uint32_t offset = 0; // bytes
  std::uint32_t size = 0;   // bytes; a bool's is that of the word which it is in
  int bit = -1;             // of a bool
  bool isObject = false;
};

struct FrameLayout {
  std::vector<FrameSlot> slots; // by offset, then bit, then first use
  std::uint32_t size = 0;       // bytes
  /// If no two values or objects shared words, nor bools.
  std::uint32_t unshared = 0;
  /// No frame is smaller: the most that is alive at one trace.
  std::uint32_t lowerBound = 0;
};

/// FrameLayout.cpp: gives each saved value and each frame object its place, and turns what suspends
/// pass into loads and stores. The function gets `rtsl.frame_size` in bytes.
FrameLayout layoutFrame(FuncOp function);

//===----------------------------------------------------------------------===//
// The cut and what follows
//===----------------------------------------------------------------------===//

/// SplitStates.cpp: replaces a function by its states, `@f.state0` for its beginning and one for
/// each trace.
mlir::FailureOr<llvm::SmallVector<FuncOp>> splitStates(FuncOp function);

/// ForwardArguments.cpp: an argument of a block to which only one value comes, on whatever way, is that value.
void forwardArguments(FuncOp function);

/// CleanStores.cpp: removes stores of what the slot already holds. True if there were any.
bool cleanStores(FuncOp state);

/// SinkLoads.cpp: moves loads of the frame, and what is recomputed, to where they are used, never
/// into a loop. True if any moved.
bool sinkLoads(FuncOp state);

/// Dispatch.cpp: makes the frame a parameter, numbers the states from 1 in the order in which they
/// stand, and makes the functions that the machine calls: `@rtsl_run_state`, `@rtsl_frame_size`,
/// `@rtsl_ray_kinds` with its tables (RayGraph.h), and `@f_first` for each of machineEntries(), 0 if
/// there is no such function or it does nothing, and for each other exported function that was
/// split.
mlir::LogicalResult makeDispatch(mlir::ModuleOp module);

} // namespace rtsl::continuation
