#include "codegen/passes/ForgetArguments.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/Matchers.h"
#include "mlir/IR/SymbolTable.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/SetVector.h"

namespace rtsl::codegen {

namespace {

using mlir::func::CallOp;
using mlir::func::FuncOp;

class ForgetArguments
    : public mlir::PassWrapper<ForgetArguments, mlir::OperationPass<mlir::ModuleOp>> {
public:
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ForgetArguments)

  llvm::StringRef getArgument() const override { return "rtsl-forget-arguments"; }
  llvm::StringRef getDescription() const override {
    return "passes zeros where callees use no argument";
  }

  void runOnOperation() override {
    const mlir::SymbolTable symbols(getOperation());
    calls.clear();
    getOperation().walk([&](CallOp call) {
      if (auto callee = symbols.lookup<FuncOp>(call.getCallee()); callee && !callee.isExternal())
        calls[callee].push_back(call);
    });
    // A function whose code for an argument is removed may use fewer arguments itself.
    for (const auto &[callee, callers] : calls)
      pending.insert(callee);
    while (!pending.empty())
      forgetArgumentsOf(llvm::cast<FuncOp>(pending.pop_back_val()));
  }

private:
  void forgetArgumentsOf(FuncOp callee) {
    for (mlir::BlockArgument argument : callee.getArguments())
      if (argument.use_empty() &&
          (argument.getType().isIntOrFloat() || llvm::isa<mlir::VectorType>(argument.getType())))
        for (CallOp call : calls.lookup(callee))
          forget(call, argument.getArgNumber());
  }

  void forget(CallOp call, unsigned number) {
    const mlir::Value before = call.getOperand(number);
    if (mlir::matchPattern(before, mlir::m_Constant()))
      return;
    mlir::OpBuilder builder(call);
    call.setOperand(number, mlir::arith::ConstantOp::create(builder, call.getLoc(),
                                                            builder.getZeroAttr(before.getType())));
    if (auto caller = call->getParentOfType<FuncOp>(); calls.contains(caller))
      pending.insert(caller);
    eraseIfDead(before.getDefiningOp());
  }

  /// Erases the operation if nothing uses it, and what it alone has used. An operation is listed
  /// once, however often an erased one has used it; when it is erased itself, no operation is left
  /// that could list it again.
  static void eraseIfDead(mlir::Operation *first) {
    llvm::SmallSetVector<mlir::Operation *, 8> candidates;
    candidates.insert(first);
    while (!candidates.empty()) {
      mlir::Operation *op = candidates.pop_back_val();
      if (!op || !mlir::isOpTriviallyDead(op))
        continue;
      for (const mlir::Value operand : op->getOperands())
        candidates.insert(operand.getDefiningOp());
      op->erase();
    }
  }

  llvm::MapVector<mlir::Operation *, llvm::SmallVector<CallOp>> calls; // by callee
  llvm::SetVector<mlir::Operation *> pending;                          // callees
};

} // namespace

std::unique_ptr<mlir::Pass> createForgetArgumentsPass() {
  return std::make_unique<ForgetArguments>();
}

} // namespace rtsl::codegen
