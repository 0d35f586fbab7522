#include "codegen/passes/calls/LiftCalls.h"

#include "codegen/passes/calls/FunctionEffects.h"
#include "codegen/passes/calls/Operands.h"
#include "codegen/passes/calls/Parts.h"
#include "codegen/passes/calls/Places.h"
#include "codegen/passes/calls/ResultVariables.h"

namespace rtsl::codegen {

namespace {

using mlir::Value;
using mlir::func::CallOp;
using mlir::func::FuncOp;

/// What is read of an aggregate that a call returns.
struct ReadResult {
  unsigned operand; // of the call: the variable
  std::vector<Part> parts;
};

class LiftedCalls {
public:
  LiftedCalls(FuncOp function, llvm::ArrayRef<CallOp> callers, EffectsOfFunctions &effects)
      : function(function), callers(callers), effects(effects), dominance(function) {}

  void run() {
    llvm::SmallVector<CallOp> calls;
    function.walk([&](CallOp call) { calls.push_back(call); });
    for (CallOp call : calls)
      if (mayBeLifted(call))
        if (const auto results = resultsOf(call))
          lift(call, *results);
  }

private:
  bool mayBeLifted(CallOp call) {
    mlir::Block &entry = function.getBody().front();
    return isSameWhereverCalled(call, function, effects) &&
           llvm::all_of(call.getOperands(),
                        [&](Value operand) {
                          return llvm::isa<ir::PtrType>(operand.getType())
                                     ? isResult(operand, call, dominance)
                                     : canCompute(operand, isArgument);
                        }) &&
           (call->getBlock() == &entry || isAlwaysReached({call}, &entry)) &&
           !sendsRaysBetween(&entry.front(), call, effects);
  }

  static bool isArgument(Value value) {
    auto argument = llvm::dyn_cast<mlir::BlockArgument>(value);
    return argument && argument.getOwner()->isEntryBlock();
  }

  /// None if it is not known what is read.
  static std::optional<std::vector<ReadResult>> resultsOf(CallOp call) {
    std::vector<ReadResult> results;
    for (mlir::OpOperand &operand : call->getOpOperands()) {
      if (!llvm::isa<ir::PtrType>(operand.get().getType()))
        continue;
      auto parts = partsOfResult(operand.get(), call);
      if (!parts)
        return std::nullopt;
      results.push_back({operand.getOperandNumber(), std::move(*parts)});
    }
    return results;
  }

  void lift(CallOp call, const std::vector<ReadResult> &results) {
    for (CallOp caller : callers)
      callIn(caller, call, results);

    for (Value value : call.getResults())
      if (!value.use_empty())
        value.replaceAllUsesWith(addArgument(function, value.getType()));
    llvm::SmallVector<Value> variables;
    for (const ReadResult &result : results) {
      for (const Part &part : result.parts)
        replaceLoads(part, addArgument(function, part.type));
      variables.push_back(call.getOperand(result.operand));
    }
    call.erase();
    for (Value variable : variables) {
      eraseParts(variable);
      variable.getDefiningOp()->erase();
    }
  }

  /// Calls it before a call of this function, and passes what it returns.
  void callIn(CallOp caller, CallOp call, const std::vector<ReadResult> &results) {
    mlir::OpBuilder builder(caller);
    const mlir::Location location = call.getLoc();
    llvm::SmallVector<Value> operands;
    for (Value operand : call.getOperands())
      if (auto variable = operand.getDefiningOp<ir::VarOp>())
        operands.push_back(createResult(variable, caller));
      else
        operands.push_back(compute(builder, operand, [&](Value known) {
          return isArgument(known)
                     ? caller.getOperand(llvm::cast<mlir::BlockArgument>(known).getArgNumber())
                     : Value();
        }));
    auto lifted =
        CallOp::create(builder, location, call.getCallee(), call.getResultTypes(), operands);
    llvm::SmallVector<Value> passed;
    for (auto [inFunction, result] : llvm::zip(call.getResults(), lifted.getResults()))
      if (!inFunction.use_empty())
        passed.push_back(result);
    for (const ReadResult &result : results)
      for (const Part &part : result.parts)
        passed.push_back(loadPart(builder, location, operands[result.operand], part));
    caller.getOperandsMutable().append(passed);
  }

  /// A variable of the caller's, which is cleared before the call.
  static Value createResult(ir::VarOp variable, CallOp caller) {
    mlir::Block &entry = caller->getParentOfType<FuncOp>().getBody().front();
    mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(&entry);
    auto own = llvm::cast<ir::VarOp>(builder.clone(*variable));
    builder.setInsertionPoint(caller);
    ir::ClearOp::create(builder, variable.getLoc(), own.getResult());
    return own;
  }

  FuncOp function;
  llvm::ArrayRef<CallOp> callers;
  EffectsOfFunctions &effects;
  mlir::DominanceInfo dominance;
};

} // namespace

void liftCalls(FuncOp function, llvm::ArrayRef<CallOp> callers, EffectsOfFunctions &effects) {
  LiftedCalls(function, callers, effects).run();
}

} // namespace rtsl::codegen
