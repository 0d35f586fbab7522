//===- KnownConditions.cpp - the values of expressions that are kept whole ===//
#include "codegen/lower/KnownConditions.h"

#include "codegen/ir/Rtsl.h"
#include "sema/fold/ConstantFold.h"

#include "mlir/IR/Matchers.h"
#include "llvm/ADT/DenseMap.h"

namespace rtsl {

namespace {

/// The known values of one component, and of expressions of them.
class KnownValues {
public:
  explicit KnownValues(const SourceTable &table) : table(table) {}
  std::optional<typed::Constant> of(mlir::Value value, unsigned depth = 0);

private:
  std::optional<typed::Constant> ofExpression(ir::ExpressionOp whole, unsigned depth);

  static constexpr unsigned deepest = 64; // length of a chain of dependent values
  const SourceTable &table;
  llvm::DenseMap<mlir::Value, std::optional<typed::Constant>> seen;
};

} // namespace

static std::optional<typed::Constant> ofConstant(mlir::Attribute number) {
  if (auto whole = llvm::dyn_cast<mlir::IntegerAttr>(number)) {
    const llvm::APInt &bits = whole.getValue();
    const bool isBool = bits.getBitWidth() == 1;
    return typed::Constant{{isBool ? makeBool(!bits.isZero())
                                   : makeUInt(static_cast<std::uint32_t>(bits.getZExtValue()))}};
  }
  if (auto real = llvm::dyn_cast<mlir::FloatAttr>(number))
    return typed::Constant{{makeFloat(real.getValue().convertToFloat())}};
  return std::nullopt;
}

std::optional<typed::Constant> KnownValues::ofExpression(ir::ExpressionOp whole, unsigned depth) {
  const SourceTable::Entry &entry = table.entries[whole.getSource()];
  if (entry.kind != SourceTable::Kind::Value)
    return std::nullopt;
  std::map<const typed::Expr *, typed::Constant> leaves;
  for (auto [leaf, operand] : llvm::zip(entry.leaves, whole.getOperands())) {
    std::optional<typed::Constant> known = of(operand, depth + 1);
    if (!known)
      return std::nullopt;
    leaves[leaf] = std::move(*known);
  }
  return evaluate(*entry.expr, leaves);
}

std::optional<typed::Constant> KnownValues::of(mlir::Value value, unsigned depth) {
  if (auto known = seen.find(value); known != seen.end())
    return known->second;
  std::optional<typed::Constant> result;
  if (mlir::Attribute number; mlir::matchPattern(value, mlir::m_Constant(&number)))
    result = ofConstant(number);
  else if (auto whole = value.getDefiningOp<ir::ExpressionOp>(); whole && depth != deepest)
    result = ofExpression(whole, depth);
  return seen[value] = std::move(result);
}

std::optional<bool> knownCondition(mlir::Value condition, const SourceTable &table) {
  std::optional<typed::Constant> known = KnownValues(table).of(condition);
  return known ? std::optional(known->scalars.front().b) : std::nullopt;
}

} // namespace rtsl
