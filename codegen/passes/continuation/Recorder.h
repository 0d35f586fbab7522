//===- Recorder.h - what is noted of a function while it is split ---------===//
//
// Split.cpp says what it has done; this notes it in a report. Nothing here changes the IR.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/FrameTraffic.h"
#include "codegen/passes/continuation/Report.h"
#include "codegen/passes/continuation/common/Names.h"

namespace rtsl::continuation {

/// Notes what becomes of one function. Each member is called after the step that it is named for,
/// in this order.
class Recorder {
public:
  /// `explains`: note what each trace would save without the optimisations, and with each of them
  /// (SplitOptions::explain).
  Recorder(FuncOp function, const WriteSummary &summary, bool explains, FunctionReport &report);

  void foundLastTraces(llvm::ArrayRef<mlir::Location> places);
  /// All traces stand at the ends of blocks. Fails, with a message, if a value can neither be saved
  /// nor recomputed.
  mlir::LogicalResult suspended();
  mlir::LogicalResult trimmedVectors();
  /// It is known what is saved and what is recomputed; nothing is changed yet.
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
