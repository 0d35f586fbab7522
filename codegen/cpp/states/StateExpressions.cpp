#include "codegen/cpp/states/StateExpressions.h"

#include "codegen/cpp/states/statements/StatePrinter.h"
#include "sema/typed/Casting.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Matchers.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

bool StateExpressions::print(mlir::Operation &op, Statements &out) {
  auto whole = llvm::dyn_cast<ir::ExpressionOp>(op);
  if (!whole)
    return false;
  const SourceTable::Entry &entry = state.source.entries[whole.getSource()];
  const Code code = of(entry, whole->getOperands());
  state.values.make(op, code, out);
  return true;
}

static Code number(mlir::Attribute attribute, bool isUnsigned) {
  auto integerAttr = llvm::dyn_cast<mlir::IntegerAttr>(attribute);
  if (!integerAttr)
    return floatLiteral(llvm::cast<mlir::FloatAttr>(attribute).getValue().convertToFloat());
  const llvm::APInt &value = integerAttr.getValue();
  if (integerAttr.getType().isInteger(1))
    return boolean(!value.isZero());
  return isUnsigned ? literal(fmt::format("{}u", value.getZExtValue()), value.isZero())
                    : integer(value.getSExtValue());
}

Code StateExpressions::constant(mlir::Value value, const Type *type) {
  mlir::Attribute attribute;
  if (!mlir::matchPattern(value, mlir::m_Constant(&attribute))) {
    if (value.getDefiningOp<ir::NullRefOp>())
      return list(type ? context.types.of(type) : "", {});
    if (value.getDefiningOp())
      state.unsupported(*value.getDefiningOp());
    return integer(0);
  }
  const bool isUnsigned = type && type->scalar() && type->scalar()->is(TypeKind::UInt);
  auto dense = llvm::dyn_cast<mlir::DenseElementsAttr>(attribute);
  if (!dense)
    return number(attribute, isUnsigned);
  mlir::Type element = dense.getElementType();
  const std::string vector = type ? context.types.of(type)
                                  : fmt::format("glm::{}vec{}",
                                                element.isF32()        ? ""
                                                : element.isInteger(1) ? "b"
                                                                       : "i",
                                                dense.getNumElements());
  if (dense.isSplat())
    return construct(vector, {number(dense.getSplatValue<mlir::Attribute>(), isUnsigned)});
  std::vector<Code> parts;
  for (mlir::Attribute part : dense.getValues<mlir::Attribute>())
    parts.push_back(number(part, isUnsigned));
  return construct(vector, std::move(parts));
}

void StateExpressions::replaceLeaves(const SourceTable::Entry &entry, mlir::ValueRange operands) {
  state.functions.replaced.clear();
  for (auto [leaf, operand] : llvm::zip(entry.leaves, operands))
    if (leaf)
      state.functions.replaced[leaf] = llvm::isa<ir::PtrType>(operand.getType())
                                           ? state.lvalues.of(operand)
                                           : state.values.use(operand, leaf->type);
  nameConstants(*entry.expr);
}

Code StateExpressions::of(const SourceTable::Entry &entry, mlir::ValueRange operands) {
  replaceLeaves(entry, operands);
  switch (entry.kind) {
  case SourceTable::Kind::Value:
  case SourceTable::Kind::Into:
    return state.functions.expressions.expr(*entry.expr);
  case SourceTable::Kind::Index:
    return state.functions.lvalues.index(static_cast<const typed::IndexExpr &>(*entry.expr));
  case SourceTable::Kind::AngleCosine:
    return cpp::call("rtsl::cosOfAngle", {state.functions.expressions.argument(*entry.expr)});
  case SourceTable::Kind::Compound: {
    const auto &assign = static_cast<const typed::AssignExpr &>(*entry.expr);
    return state.functions.operators.binary(assign.op, *assign.target, *assign.value);
  }
  case SourceTable::Kind::Step: {
    const auto &step = static_cast<const typed::IncDecExpr &>(*entry.expr);
    return state.functions.assignments.stepped(
        state.functions.expressions.operand(*step.target, Binding::Sum),
        step.target->type->scalar(), step.increment);
  }
  }
  return integer(0);
}

/// The comparison that is true where this one is false. Floats have none for `<` and the like: with
/// a NaN both are false.
static std::optional<Operator> oppositeOf(Operator op, bool isWhole) {
  switch (op) {
  case Operator::Equal:
    return Operator::NotEqual;
  case Operator::NotEqual:
    return Operator::Equal;
  case Operator::Less:
    return isWhole ? std::optional(Operator::GreaterEqual) : std::nullopt;
  case Operator::LessEqual:
    return isWhole ? std::optional(Operator::Greater) : std::nullopt;
  case Operator::Greater:
    return isWhole ? std::optional(Operator::LessEqual) : std::nullopt;
  case Operator::GreaterEqual:
    return isWhole ? std::optional(Operator::Less) : std::nullopt;
  default:
    return std::nullopt;
  }
}

Code StateExpressions::opposite(mlir::Value condition, const Code &code) {
  auto whole = condition.getDefiningOp<ir::ExpressionOp>();
  const SourceTable::Entry *entry = whole ? &state.source.entries[whole.getSource()] : nullptr;
  auto *compared = entry && entry->kind == SourceTable::Kind::Value
                       ? dynCast<typed::BinaryExpr>(entry->expr)
                       : nullptr;
  // The condition of a loop over lights is `i < count`.
  const bool isOfLights = condition.getDefiningOp<mlir::arith::CmpIOp>() != nullptr;
  const Code inner = bare(code);
  if ((!compared && !isOfLights) || !inner->is(ExpressionKind::Binary))
    return negated(code);
  auto isInteger = [](const Type *type) {
    return type->is(TypeKind::Int) || type->is(TypeKind::UInt);
  };
  const std::optional<Operator> op =
      oppositeOf(inner->op, isOfLights || isInteger(compared->left->type));
  return op ? binary(*op, inner->parts[0], inner->parts[1]) : negated(code);
}

/// Constant arrays and structs of a function are declared where a state names them.
void StateExpressions::nameConstants(const typed::Expr &expr) {
  std::set<const typed::Expr *> elsewhere;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (state.functions.replaced.count(&inner))
      forEachExpr(inner, [&](const typed::Expr &part) { elsewhere.insert(&part); });
  });
  auto add = [&](const typed::Variable &constant) {
    if (std::find(constants.begin(), constants.end(), &constant) != constants.end())
      return;
    nameConstants(*constant.init); // constants that its initialiser mentions come first
    constants.push_back(&constant);
    state.functions.constantNames[&constant] = state.names.fresh(context.names.of(&constant));
  };
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (elsewhere.count(&inner))
      return;
    if (auto *named = dynCast<typed::VariableExpr>(&inner);
        named && named->variable->isConst && named->variable->kind != typed::Variable::Kind::Global)
      add(*named->variable);
    if (auto *literal = dynCast<typed::LiteralExpr>(&inner)) // the value of a named constant
      if (const void *named = state.functions.literals.namedConstant(*literal))
        for (const auto &local : state.machine.method->locals)
          if (local.get() == named)
            add(*local);
  });
}

} // namespace rtsl::cpp
