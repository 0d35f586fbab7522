//===- FoldFma.cpp - math.fma of constants --------------------------------===//
#include "codegen/passes/FoldFma.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/IR/BuiltinAttributes.h"
#include "mlir/IR/Matchers.h"
#include "mlir/IR/PatternMatch.h"

namespace rtsl::codegen {

namespace {

using llvm::APFloat;

struct FoldFma : mlir::OpRewritePattern<mlir::math::FmaOp> {
  using OpRewritePattern::OpRewritePattern;

  mlir::LogicalResult matchAndRewrite(mlir::math::FmaOp op,
                                      mlir::PatternRewriter &rewriter) const override {
    mlir::Attribute a, b, c;
    if (!mlir::matchPattern(op.getA(), mlir::m_Constant(&a)) ||
        !mlir::matchPattern(op.getB(), mlir::m_Constant(&b)) ||
        !mlir::matchPattern(op.getC(), mlir::m_Constant(&c)))
      return mlir::failure();
    llvm::SmallVector<APFloat, 4> x = components(a), y = components(b), z = components(c);
    if (x.empty() || x.size() != y.size() || x.size() != z.size())
      return mlir::failure();
    for (unsigned i = 0; i < x.size(); ++i)
      x[i].fusedMultiplyAdd(y[i], z[i], APFloat::rmNearestTiesToEven);
    mlir::TypedAttr result;
    if (auto vector = llvm::dyn_cast<mlir::ShapedType>(op.getType()))
      result = mlir::DenseElementsAttr::get(vector, x);
    else
      result = mlir::FloatAttr::get(op.getType(), x.front());
    rewriter.replaceOpWithNewOp<mlir::arith::ConstantOp>(op, result);
    return mlir::success();
  }

private:
  static llvm::SmallVector<APFloat, 4> components(mlir::Attribute constant) {
    if (auto scalar = llvm::dyn_cast<mlir::FloatAttr>(constant))
      return {scalar.getValue()};
    if (auto vector = llvm::dyn_cast<mlir::DenseFPElementsAttr>(constant))
      return {vector.value_begin<APFloat>(), vector.value_end<APFloat>()};
    return {};
  }
};

} // namespace

void addFmaFolding(mlir::RewritePatternSet &patterns) {
  patterns.add<FoldFma>(patterns.getContext());
}

} // namespace rtsl::codegen
