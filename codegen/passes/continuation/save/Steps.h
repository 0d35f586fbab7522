//===- Steps.h - the values saved at a trace ------------------------------===//
//
// Steps with options or results, and their files; common/Steps.def has the others. Split.cpp calls
// them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/Recompute.h"
#include "codegen/passes/continuation/common/Steps.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::continuation {

/// Fields of a payload that are not passed with rays.
struct TrimmedPayload {
  std::string payload;
  std::vector<std::string> fields;
  std::uint32_t bytesBefore = 0, bytes = 0;
};

/// TrimPayloads.cpp: removes fields of payloads that are never read, and those that only the
/// senders of rays use. Does nothing to a module that is not linked: other classes may read them.
std::vector<TrimmedPayload> trimPayloads(mlir::ModuleOp module);

/// The treatment of the values that are needed after one trace.
struct SuspendPlan {
  ir::SuspendOp suspend;
  llvm::SmallVector<mlir::Value> saved; // in program order
  // in program order; operands before their users
  llvm::SmallVector<mlir::Value> recomputed;
};

struct RematerialiseOptions {
  /// Save every value that can be saved and recompute only addresses: the baseline of comparisons.
  bool onlyAddresses = false;
};

/// Rematerialise.cpp: decides which values are saved and which are recomputed at each trace. Fails
/// with a message if a value can neither be saved nor recomputed.
mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options);
/// The same with a given summary, which takes a walk over the module to compute.
mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options,
                  const WriteSummary &summary);

/// Recomputes values after each trace as planned. The values that are still live across it
/// afterwards are those that the plan saves.
void rematerialise(FuncOp function, llvm::ArrayRef<SuspendPlan> plan);

/// SaveLive.cpp: passes the values that are live across a suspend to the arguments of its resume
/// block, by name.
mlir::LogicalResult saveLive(FuncOp function);

} // namespace rtsl::continuation
