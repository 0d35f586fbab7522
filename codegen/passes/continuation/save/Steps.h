//===- Steps.h - what is saved at a trace ---------------------------------===//
//
// Each step lies in the file that is named here; Split.cpp calls them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/Recompute.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::continuation {

/// Fields of a payload that are not passed with its rays.
struct TrimmedPayload {
  std::string payload;
  std::vector<std::string> fields;
  std::uint32_t bytesBefore = 0, bytes = 0;
};

/// TrimPayloads.cpp: takes fields out of payloads that nobody reads, and those that only the
/// senders of rays use. Does nothing to a module that is not linked: other classes may read them.
std::vector<TrimmedPayload> trimPayloads(mlir::ModuleOp module);

/// TrimVectors.cpp: parts that are taken out of a vector behind a trace are taken out before it.
void trimVectors(FuncOp function);

/// What happens to the values that are needed behind one trace.
struct SuspendPlan {
  ir::SuspendOp suspend;
  llvm::SmallVector<mlir::Value> saved; // in program order
  // in program order; operands before what is made of them
  llvm::SmallVector<mlir::Value> recomputed;
};

struct RematerialiseOptions {
  /// Save everything that can be saved; recompute addresses only. What is compared with.
  bool onlyAddresses = false;
};

/// Rematerialise.cpp: decides what is saved and what is recomputed at each trace. Fails with a
/// message if something can neither be saved nor recomputed.
mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options);
/// Where the summary is known already: it takes a walk over the module.
mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options,
                  const WriteSummary &summary);

/// Recomputes behind each trace what the plan says. What is still live across it afterwards is what
/// the plan saves.
void rematerialise(FuncOp function, llvm::ArrayRef<SuspendPlan> plan);

/// SaveLive.cpp: passes what is live across a suspend to the arguments of its resume block, by
/// name.
mlir::LogicalResult saveLive(FuncOp function);

} // namespace rtsl::continuation
