//===- Recorder.h - records the splitting of a function -------------------===//
//
// Records the steps of Split.cpp in a report, without changing the IR.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/FrameTraffic.h"
#include "codegen/passes/continuation/Report.h"
#include "codegen/passes/continuation/common/Names.h"

namespace rtsl::continuation {

/// Records the steps for one function. Each member is called after the step that it is named after,
/// in this order.
class Recorder {
public:
  /// `explains`: record what each trace would save without the optimisations, and with each of them
  /// (SplitOptions::explain).
  Recorder(FuncOp function, const WriteSummary &summary, bool explains, FunctionReport &report);

  void foundTailTraces(llvm::ArrayRef<mlir::Location> places);
  /// Called when all traces are at the ends of blocks. Fails, with a message, if a value can
  /// neither be saved nor recomputed.
  mlir::LogicalResult suspended();
  mlir::LogicalResult trimmedVectors();
  /// Called when the plans are made; the IR is unchanged.
  void planned(llvm::ArrayRef<SuspendPlan> plans);
  void laidOut(FrameLayout frame);
  void split(llvm::ArrayRef<FuncOp> states);
  void cleanedStores(FuncOp state); // of each state
  void finished(llvm::ArrayRef<FuncOp> states, bool wereCleaned);

private:
  mlir::LogicalResult notePlainLiveness(const char *step);
  void explainPlan(const SuspendPlan &plan, TraceReport &trace);
  void noteTraffic(const char *step, const FrameTraffic &traffic);
  void sumUpExtras();

  FuncOp function; // until it is split
  const WriteSummary &summary;
  bool explains;
  FunctionReport &report;
  UniqueNames plainNames;
  FrameTraffic afterCleanStores;
};

} // namespace rtsl::continuation
