#include "codegen/passes/errors/HitBranches.h"

#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/IR/PatternMatch.h"
#include "mlir/Transforms/RegionUtils.h"
#include "llvm/ADT/STLExtras.h"

namespace rtsl {

using mlir::Block;
using Blocks = llvm::SetVector<Block *>;

Blocks blocksAfter(llvm::ArrayRef<Block *> starts) {
  Blocks after;
  for (Block *start : starts)
    after.insert(start->succ_begin(), start->succ_end());
  for (std::size_t i = 0; i < after.size(); ++i)
    after.insert(after[i]->succ_begin(), after[i]->succ_end());
  return after;
}

void takeBranchesToHits(mlir::func::FuncOp intersect) {
  Blocks withHits;
  intersect.walk([&](ir::HitOp hit) { withHits.insert(hit->getBlock()); });
  const Blocks afterHits = blocksAfter(withHits.getArrayRef());
  const auto leadsToHit = [&](Block *block) {
    const auto hasHit = [&](Block *one) { return withHits.contains(one); };
    return hasHit(block) || llvm::any_of(blocksAfter(block), hasHit);
  };

  mlir::IRRewriter rewriter(intersect.getContext());
  for (Block &block : intersect.getBody()) {
    auto branch = llvm::dyn_cast<mlir::cf::CondBranchOp>(block.getTerminator());
    if (!branch || withHits.contains(&block) || afterHits.contains(&block) ||
        blocksAfter(&block).contains(&block))
      continue;
    const bool ifTrue = leadsToHit(branch.getTrueDest());
    if (ifTrue == leadsToHit(branch.getFalseDest()))
      continue;
    rewriter.setInsertionPoint(branch);
    rewriter.replaceOpWithNewOp<mlir::cf::BranchOp>(
        branch, ifTrue ? branch.getTrueDest() : branch.getFalseDest(),
        ifTrue ? branch.getTrueDestOperands() : branch.getFalseDestOperands());
  }
  (void)mlir::eraseUnreachableBlocks(rewriter, intersect->getRegions());
  (void)mlir::runRegionDCE(rewriter, intersect->getRegions());
}

} // namespace rtsl
