//===- Split.h - shaders that trace become state machines -----------------===//
//
// The whole of this folder in one call: level 2 with `rtsl.trace` in, states and their dispatch
// out. A function that does not trace is not touched.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/DecideBranches.h"
#include "codegen/passes/continuation/Report.h"

#include "mlir/IR/BuiltinOps.h"

namespace rtsl {

struct SplitOptions {
  /// Recompute what is cheaper than to save. Off: everything that is live is saved.
  bool rematerialise = true;
  /// Save the components of vectors, and pass the fields of payloads, that are read, not all.
  bool trim = true;
  /// No stores of what a slot holds already; loads where they are used.
  bool cleanUp = true;
  /// Report what each trace would save without the optimisations, and with each of them: as much
  /// work again as the optimisations.
  bool explain = false;
  /// Number the states and make the functions that the machine calls. Off: for looking at.
  bool dispatch = true;
  /// Decides branches that folding cannot, for people who read the states. None: branches stay as
  /// they are.
  codegen::KnownCondition isKnown;
  /// The verifier after each step, not only at the end.
#ifdef NDEBUG
  bool verifyEach = false;
#else
  bool verifyEach = true;
#endif
};

/// Level 1, before the pipeline to level 2: keeps the methods that the runtime starts and that
/// trace functions of their own, so that each has its own states. Without it they become part of
/// the entries, which costs nothing but the report's detail.
void keepTracingMethods(mlir::ModuleOp module);

/// Splits every function of the module that traces, is not called by one that does, and gives no
/// result. Reports errors through MLIR's diagnostics and returns false.
bool splitAtTrace(mlir::ModuleOp module, const SplitOptions &options, SplitReport &report);

} // namespace rtsl
