//===- Paths.cpp - what is known of the rays of a program -----------------===//
//
// The lanes of a GPU begin with similar rays. Where shaders choose the next ray at random, rays of
// neighbouring lanes soon diverge; otherwise they stay coherent for long. How the megakernel
// schedules its lanes depends on this (runtime/device/organisations/Schedule.h).
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Rays.h"
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"

#include "llvm/ADT/StringSet.h"

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// The methods of materials that run for the rays of this trace.
std::string methodFor(mlir::Operation *trace) {
  auto withPayload = llvm::dyn_cast<ir::TracePayloadOp>(trace);
  if (!withPayload)
    return "shade";
  const auto payload = llvm::cast<ir::PtrType>(withPayload.getPayload().getType()).getPointee();
  return ("closestHit." + llvm::cast<ir::StructType>(payload).getName()).str();
}

/// Whether a method of a class with such a root contains an operation for which `holds` holds,
/// itself or in functions that it calls.
bool anyMethod(const LinkContext &context, llvm::function_ref<bool(mlir::Operation *)> holds,
               llvm::function_ref<bool(llvm::StringRef)> isSuchRoot) {
  Contains contains(context.symbols, holds);
  return llvm::any_of(context.ir->getRegion(0).getOps<FuncOp>(), [&](FuncOp function) {
    const llvm::StringRef root = readerOf(context.symbols, function).root;
    return !root.empty() && isSuchRoot(root) && contains(function);
  });
}

} // namespace

runtime::Paths findPaths(const LinkContext &context) {
  mlir::ModuleOp ir = context.ir;
  Contains traces(context.symbols, ir::isTrace);

  // Rays at whose hits others are sent: not those that only look for a lamp.
  llvm::StringSet<> methodsThatTrace;
  for (FuncOp function : ir.getOps<FuncOp>())
    if (traces(function))
      methodsThatTrace.insert(function.getSymName().split('.').second);
  const auto goesOn = [&](mlir::Operation *op) {
    return ir::isTrace(op) && methodsThatTrace.contains(methodFor(op));
  };
  Contains sendsPath(context.symbols, goesOn);

  // A function that draws and traces draws for its own rays, not for those of its caller.
  const auto isRand = [](mlir::Operation *op) { return llvm::isa<ir::RandOp>(op); };
  const auto tracesNothing = [&](FuncOp function) { return !traces(function); };
  Contains draws(context.symbols, isRand, tracesNothing);

  const auto isRandomWalk = [&](mlir::Operation *op) {
    return llvm::isa<ir::LoopOp>(op) && draws(op) && traces(op);
  };
  runtime::Paths paths = runtime::Paths::Single;
  for (FuncOp function : ir.getOps<FuncOp>()) {
    const bool generates = readerOf(context.symbols, function).root == "rt_RayGeneration";
    if (generates ? ir::anyOperation(function, isRandomWalk)
                  : draws(function) && sendsPath(function))
      return runtime::Paths::Random;
    if (!generates && sendsPath(function))
      paths = runtime::Paths::Alike;
  }
  return paths;
}

bool raysLeaveHits(const LinkContext &context) {
  return anyMethod(context, ir::sendsRays,
                   [](llvm::StringRef root) { return root != "rt_RayGeneration"; });
}

bool samplesDiffer(const LinkContext &context) {
  Contains traces(context.symbols, ir::isTrace);
  const auto isLoopOfRays = [&](mlir::Operation *op) {
    return llvm::isa<ir::LoopOp>(op) && traces(op);
  };
  return llvm::any_of(context.rayTypes,
                      [](const RayType &type) { return type.search & RTSL_FIRST_HIT; }) ||
         ir::anyOperation(context.ir, isLoopOfRays);
}

bool hasPrimitives(const LinkContext &context) {
  return llvm::any_of(context.ir->getRegion(0).getOps<FuncOp>(), [&](FuncOp function) {
    return readerOf(context.symbols, function).root == "rt_Primitive";
  });
}

bool raysReadLaunch(const LinkContext &context) {
  const auto readsLaunch = [](mlir::Operation *op) {
    auto state = llvm::dyn_cast<ir::StateOp>(op);
    return state && (state.getName() == "LaunchIndex" || state.getName() == "LaunchSize") &&
           isRead(state);
  };
  return anyMethod(context, readsLaunch, [](llvm::StringRef root) {
    return root != "rt_RayGeneration" && root != "rt_Camera";
  });
}

} // namespace rtsl::linking
