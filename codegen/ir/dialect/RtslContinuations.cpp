//===- RtslContinuations.cpp - the operations of split functions ----------===//
#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/StringSet.h"

namespace rtsl::ir {

using mlir::LogicalResult;

mlir::SuccessorOperands SuspendOp::getSuccessorOperands(unsigned) {
  return mlir::SuccessorOperands(getSavedMutable());
}

LogicalResult SuspendOp::verify() {
  mlir::Block *resume = getResume();
  if (resume->getSinglePredecessor() != getOperation()->getBlock())
    return emitOpError() << "resumes at a block that has other predecessors";
  if (!getOrigin() != !getDirection())
    return emitOpError() << "has only one of origin and direction";
  if (getOrigin() && (resume->empty() || !llvm::isa<TraceResultOp>(resume->front())))
    return emitOpError() << "resumes at a block that does not begin with `rtsl.trace_result`";
  if (!getOrigin() &&
      (resume->empty() || !llvm::isa<TraceReturnedOp, CallReturnedOp>(resume->front())))
    return emitOpError() << "resumes at a block that does not begin with `rtsl.trace_returned` or "
                            "`rtsl.call_returned`";
  if (getNames().size() != getSaved().size())
    return emitOpError() << "saves " << getSaved().size() << " values and names "
                         << getNames().size();
  llvm::StringSet<> seen;
  for (auto name : getNames().getAsRange<mlir::StringAttr>())
    if (!seen.insert(name.getValue()).second)
      return emitOpError() << "saves \"" << name.getValue() << "\" twice";
  return mlir::success();
}

static LogicalResult verifySlot(mlir::Operation *op, mlir::Type type, std::uint32_t offset,
                                std::optional<std::uint32_t> bit) {
  if (offset % 4 != 0)
    return op->emitOpError() << "accesses byte " << offset << ", which is not a multiple of 4";
  if (bit.has_value() != type.isInteger(1))
    return op->emitOpError() << "has a bit exactly if the value is a bool";
  if (bit && *bit > 31)
    return op->emitOpError() << "names bit " << *bit << " of a word of 32";
  return mlir::success();
}

LogicalResult FrameLoadOp::verify() {
  return verifySlot(*this, getResult().getType(), getOffset(), getBit());
}

LogicalResult FrameStoreOp::verify() {
  return verifySlot(*this, getValue().getType(), getOffset(), getBit());
}

void FrameLoadOp::getAsmResultNames(mlir::OpAsmSetValueNameFn setName) {
  setName(getResult(), getName());
}

void CallArgumentOp::getAsmResultNames(mlir::OpAsmSetValueNameFn setName) {
  setName(getResult(), getName());
}

void FrameObjectOp::getAsmResultNames(mlir::OpAsmSetValueNameFn setName) {
  setName(getResult(), getName());
}

LogicalResult NextOp::verify() {
  const bool needsState =
      getTransition() == Transition::Trace || getTransition() == Transition::Jump;
  if (getState().has_value() != needsState)
    return emitOpError() << "names a state exactly if it is a `trace` or a `jump`";
  return mlir::success();
}

} // namespace rtsl::ir
