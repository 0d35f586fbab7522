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
// All variables were moved to the entry of the function (HoistVariables.h). One that is declared
// after a trace, and used before the next one, is not live across any: it moves back to its
// declaration, which cleared it, and stays out of the frame.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/common/Liveness.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/frame/Steps.h"

#include "mlir/IR/Dominance.h"

namespace rtsl::continuation {

/// Collects an address and all addresses derived from it.
static void addDerived(mlir::Value address, llvm::SmallVectorImpl<mlir::Value> &derived) {
  derived.push_back(address);
  for (mlir::Operation *user : address.getUsers())
    if (llvm::isa<ir::FieldOp, ir::ElementOp>(user))
      addDerived(user->getResult(0), derived);
}

/// Moves a variable to the clear that precedes all its uses, if there is one.
static void moveToDeclaration(ir::VarOp variable, const mlir::DominanceInfo &dominance) {
  for (mlir::Operation *user : variable->getUsers()) {
    auto clear = llvm::dyn_cast<ir::ClearOp>(user);
    if (!clear || llvm::any_of(variable->getUsers(), [&](mlir::Operation *other) {
          return other != clear && !dominance.properlyDominates(clear, other);
        }))
      continue;
    variable->moveBefore(clear);
    clear.erase(); // a variable begins as zero
    return;
  }
}

void moveVariablesToFrame(FuncOp function) {
  llvm::SmallVector<ir::SuspendOp> suspends = suspendsOf(function);
  if (suspends.empty())
    return;
  llvm::SmallVector<ir::VarOp> variables;
  function.walk([&](ir::VarOp variable) { variables.push_back(variable); });
  const mlir::DominanceInfo dominance(function);
  for (ir::VarOp variable : variables)
    moveToDeclaration(variable, dominance);

  Liveness liveness(function);
  liveness.compute();
  llvm::BitVector acrossTraces = liveness.none();
  for (ir::SuspendOp suspend : suspends)
    acrossTraces |= liveness.into(suspend.getResume());

  UniqueNames names;
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
