//===- FrameObjects.cpp - variables in memory that are live across a trace ===//
//
//   %table = rtsl.var "table"             %table = rtsl.frame_object "table"
//   ...                            ==>    rtsl.clear %table
//   a trace                               ...
//   use %table[%i]                        a trace, use %table[%i]
//
// Variables that mem2reg could not promote are indexed at run time, or are payloads of rays. They
// move to the frame; the address is the same on both sides of a trace.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/common/Liveness.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/frame/Steps.h"

namespace rtsl::continuation {

/// Collects an address and all addresses derived from it.
static void addDerived(mlir::Value address, llvm::SmallVectorImpl<mlir::Value> &derived) {
  derived.push_back(address);
  for (mlir::Operation *user : address.getUsers())
    if (llvm::isa<ir::FieldOp, ir::ElementOp>(user))
      addDerived(user->getResult(0), derived);
}

void moveVariablesToFrame(FuncOp function) {
  llvm::SmallVector<ir::SuspendOp> suspends = suspendsOf(function);
  if (suspends.empty())
    return;
  Liveness liveness(function);
  liveness.compute();
  llvm::BitVector acrossTraces = liveness.none();
  for (ir::SuspendOp suspend : suspends)
    acrossTraces |= liveness.into(suspend.getResume());

  UniqueNames names;
  llvm::SmallVector<ir::VarOp> variables;
  function.walk([&](ir::VarOp variable) { variables.push_back(variable); });
  for (ir::VarOp variable : variables) {
    llvm::SmallVector<mlir::Value> derived;
    addDerived(variable.getResult(), derived);
    // The payload of a ray, and variables passed to a call by address, are accessed by other
    // states.
    bool isShown = llvm::any_of(derived, [](mlir::Value value) {
      return llvm::any_of(value.getUsers(), llvm::IsaPred<ir::SpawnPayloadOp, ir::EnterOp>);
    });
    if (!isShown && llvm::none_of(derived, [&](mlir::Value value) {
          return acrossTraces.test(liveness.numberOf(value));
        }))
      continue;
    mlir::OpBuilder builder(variable);
    auto object = ir::FrameObjectOp::create(builder, variable.getLoc(), variable.getType(),
                                            names.unique(variable.getName().str()), 0u);
    object->setDiscardableAttrs(variable->getDiscardableAttrDictionary()); // for the C++ printer
    ir::ClearOp::create(builder, variable.getLoc(), object);
    variable.replaceAllUsesWith(object.getResult());
    variable.erase();
  }
}

} // namespace rtsl::continuation
