//===- JoinFlags.cpp - one flag for each exit -----------------------------===//
//
//     if found { inner = true; break }             if found { outer = true; break }
//   ...                                     ==>  ...
//   if inner { outer = true; break }             if outer { break }
//
// Code that leaves several constructs at once sets the flag of each. A flag that is tested only to
// set another one is replaced by the other one: after it is set, control goes straight to its test,
// and from there to the test of the other.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/restructure/Steps.h"

#include "mlir/IR/Matchers.h"

namespace rtsl::restructuring {

static bool isConstant(mlir::Operation &op) {
  return op.hasTrait<mlir::OpTrait::ConstantLike>();
}

/// The store to the flag in `if tested { flag = true; ... }`; null: it is something else.
static ir::StoreOp setBy(ir::LoadOp test) {
  auto choice = test->hasOneUse() ? llvm::dyn_cast<ir::IfOp>(*test->user_begin()) : ir::IfOp();
  if (!choice || !choice.getElseRegion().empty())
    return {};
  auto store =
      llvm::dyn_cast<ir::StoreOp>(*llvm::find_if_not(choice.getThenRegion().front(), isConstant));
  return store && mlir::matchPattern(store.getValue(), mlir::m_One()) ? store : ir::StoreOp();
}

/// Replaces `inner` by the flag that is set where `inner` is tested last. Returns whether there is
/// such a flag.
static bool join(ir::VarOp inner, const llvm::DenseSet<mlir::Operation *> &flags) {
  ir::StoreOp set;
  for (mlir::Operation *user : inner->getUsers())
    if (auto test = llvm::dyn_cast<ir::LoadOp>(user))
      if (ir::StoreOp store = setBy(test);
          store && flags.contains(store.getAddress().getDefiningOp()))
        set = store;
  if (!set || set.getAddress() == inner.getResult())
    return false;
  auto choice = llvm::cast<ir::IfOp>(set->getParentOp());
  mlir::Operation *test = choice.getCondition().getDefiningOp();
  inner.getResult().replaceAllUsesWith(set.getAddress());
  set.erase();
  mlir::Block &then = choice.getThenRegion().front();
  if (llvm::all_of(then.without_terminator(), isConstant) &&
      llvm::isa<ir::YieldOp>(then.getTerminator())) {
    choice.erase();
    test->erase();
  }
  return true;
}

void joinFlags(llvm::SmallVectorImpl<ir::VarOp> &flags) {
  llvm::DenseSet<mlir::Operation *> open(flags.begin(), flags.end());
  for (bool changed = true; changed;) {
    changed = false;
    for (ir::VarOp flag : llvm::to_vector(flags)) {
      if (!join(flag, open))
        continue;
      open.erase(flag);
      llvm::erase(flags, flag);
      flag.erase();
      changed = true;
    }
  }
}

} // namespace rtsl::restructuring
