//===- ShareExpressions.cpp - common subexpression elimination ------------===//
#include "codegen/passes/ShareExpressions.h"

#include "mlir/IR/Dominance.h"
#include "mlir/Interfaces/FunctionInterfaces.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "llvm/ADT/ScopedHashTable.h"

#include <memory>
#include <vector>

namespace rtsl::codegen {

namespace {

/// Operations with the same opcode, attributes and operands are equal.
struct SameOperation : llvm::DenseMapInfo<mlir::Operation *> {
  using Equivalence = mlir::OperationEquivalence;
  static unsigned getHashValue(const mlir::Operation *op) {
    return Equivalence::computeHash(const_cast<mlir::Operation *>(op), Equivalence::directHashValue,
                                    Equivalence::ignoreHashValue, Equivalence::IgnoreLocations);
  }
  static bool isEqual(const mlir::Operation *left, const mlir::Operation *right) {
    if (left == right)
      return true;
    if (left == getTombstoneKey() || left == getEmptyKey() || right == getTombstoneKey() ||
        right == getEmptyKey())
      return false;
    return Equivalence::isEquivalentTo(const_cast<mlir::Operation *>(left),
                                       const_cast<mlir::Operation *>(right),
                                       Equivalence::IgnoreLocations);
  }
};

class Sharing {
public:
  explicit Sharing(mlir::DominanceInfo &dominance) : dominance(dominance) {}

  bool run(mlir::Operation *function) {
    for (mlir::Region &body : function->getRegions())
      share(body);
    for (mlir::Operation *op : dead)
      op->erase();
    return !dead.empty();
  }

private:
  using Known = llvm::ScopedHashTable<mlir::Operation *, mlir::Operation *, SameOperation>;
  using Scope = Known::ScopeTy;

  void share(mlir::Region &region) {
    if (region.hasOneBlock()) {
      Scope scope(known);
      share(region.front());
    } else if (!region.empty()) {
      shareBelow(dominance.getRootNode(&region));
    }
  }

  /// Visits the blocks dominated by `root`, without recursion: a function may have chains of
  /// thousands.
  void shareBelow(mlir::DominanceInfoNode *root) {
    struct Level {
      Level(Known &known, mlir::DominanceInfoNode *node)
          : scope(known), node(node), next(node->begin()) {}
      Scope scope;
      mlir::DominanceInfoNode *node;
      mlir::DominanceInfoNode::const_iterator next;
    };
    std::vector<std::unique_ptr<Level>> levels;
    const auto enter = [&](mlir::DominanceInfoNode *node) {
      levels.push_back(std::make_unique<Level>(known, node));
      share(*node->getBlock());
    };
    enter(root);
    while (!levels.empty()) {
      Level &level = *levels.back();
      if (level.next != level.node->end())
        enter(*level.next++);
      else
        levels.pop_back();
    }
  }

  void share(mlir::Block &block) {
    unsigned writes = 0; // in this block so far
    for (mlir::Operation &op : block) {
      if (op.hasTrait<mlir::OpTrait::IsTerminator>())
        continue;
      if (mlir::isOpTriviallyDead(&op)) {
        dead.push_back(&op);
        continue;
      }
      if (op.getNumRegions() != 0) {
        for (mlir::Region &region : op.getRegions())
          share(region);
        writes += !mlir::isMemoryEffectFree(&op);
        continue;
      }
      if (mlir::isMemoryEffectFree(&op)) {
        if (mlir::Operation *before = known.lookup(&op))
          replace(op, before);
        else
          known.insert(&op, &op);
        continue;
      }
      auto effects = llvm::dyn_cast<mlir::MemoryEffectOpInterface>(op);
      if (!effects || !effects.onlyHasEffect<mlir::MemoryEffects::Read>()) {
        writes += !effects || effects.hasEffect<mlir::MemoryEffects::Write>();
        continue;
      }
      mlir::Operation *before = known.lookup(&op);
      if (before && before->getBlock() == &block && writesBefore.lookup(before) == writes) {
        replace(op, before);
        continue;
      }
      writesBefore[&op] = writes;
      known.insert(&op, &op);
    }
  }

  void replace(mlir::Operation &op, mlir::Operation *before) {
    op.replaceAllUsesWith(before);
    if (llvm::isa<mlir::UnknownLoc>(before->getLoc()))
      before->setLoc(op.getLoc());
    dead.push_back(&op);
  }

  mlir::DominanceInfo &dominance;
  Known known;
  llvm::DenseMap<mlir::Operation *, unsigned>
      writesBefore; // number of writes in the block before each read
  std::vector<mlir::Operation *> dead;
};

struct ShareExpressions : mlir::PassWrapper<ShareExpressions, mlir::OperationPass<>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ShareExpressions)
  llvm::StringRef getArgument() const override { return "rtsl-share-expressions"; }
  llvm::StringRef getDescription() const override { return "eliminates common subexpressions"; }
  void runOnOperation() override {
    for (mlir::Region &region : getOperation()->getRegions())
      for (auto function : region.getOps<mlir::FunctionOpInterface>()) {
        mlir::DominanceInfo dominance(function);
        shareExpressions(function, dominance);
      }
  }
};

} // namespace

bool shareExpressions(mlir::Operation *function, mlir::DominanceInfo &dominance) {
  return Sharing(dominance).run(function);
}

std::unique_ptr<mlir::Pass> createShareExpressionsPass() {
  return std::make_unique<ShareExpressions>();
}

} // namespace rtsl::codegen
