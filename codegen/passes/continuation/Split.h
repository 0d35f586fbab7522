//===- Split.h - shaders that trace become state machines -----------------===//
//
// All steps of this folder in one call: turns level 2 with `rtsl.trace` into states and their
// dispatch. Functions that do not trace are unchanged.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/DecideBranches.h"
#include "codegen/passes/continuation/Report.h"

#include "mlir/IR/BuiltinOps.h"

namespace rtsl {

struct SplitOptions {
  /// Recompute values that are cheaper to recompute than to save. Off: save all live values.
  bool rematerialise = true;
  /// Save only those components of vectors, and pass only those fields of payloads, that are read.
  bool trim = true;
  /// Remove stores of values that the slot already holds, and move loads to their uses.
  bool cleanUp = true;
  /// Report what each trace would save without the optimisations, and with each of them; this
  /// doubles the time.
  bool explain = false;
  /// Number the states and make the functions that the machine calls. Off: for examining the
  /// states.
  bool dispatch = true;
  /// Decides branches that folding cannot, for C++ output. None: such branches remain.
  codegen::KnownCondition isKnown;
  /// Run the verifier after each step, not only at the end.
#ifdef NDEBUG
  bool verifyEach = false;
#else
  bool verifyEach = true;
#endif
};

/// Level 1, before the pipeline to level 2: keeps methods that trace and that the runtime starts as
/// separate functions, so that each has its own states. Otherwise they are inlined into the entry
/// points, which only makes the report less detailed.
void keepTracingMethods(mlir::ModuleOp module);

/// Splits every function of the module that traces, is not called by one that traces, and has no
/// result. Reports errors through MLIR's diagnostics and returns false.
bool splitAtTrace(mlir::ModuleOp module, const SplitOptions &options, SplitReport &report);

} // namespace rtsl
