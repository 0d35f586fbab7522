//===- StateExpressions.cpp - lvalues and expressions of a state ----------===//
//
// An expression is the author's tree (codegen/lower/SourceTable.h), whose leaves are what the IR
// has computed.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/states/StateWriter.h"

#include "sema/typed/Casting.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Matchers.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

Code StateWriter::use(mlir::Value value, const Type *type) {
  if (auto found = declared.find(value); found != declared.end())
    return name(found->second);
  auto found = pending.find(value);
  if (found == pending.end())
    return constant(value, type);
  Code code = found->second.code;
  consumed.add(found->second.touches);
  if (--found->second.usesLeft == 0)
    pending.erase(value);
  return code;
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

Code StateWriter::constant(mlir::Value value, const Type *type) {
  mlir::Attribute attribute;
  if (!mlir::matchPattern(value, mlir::m_Constant(&attribute))) {
    if (value.getDefiningOp<ir::NullRefOp>())
      return list(type ? context.types.of(type) : "", {});
    if (value.getDefiningOp())
      unsupported(*value.getDefiningOp());
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

Code StateWriter::place(mlir::Value address) {
  if (auto state = address.getDefiningOp<ir::StateOp>())
    return member(name("rt"), state.getName().str());
  if (auto variable = address.getDefiningOp<ir::VarOp>()) {
    const auto light = lightNumbers.find(variable);
    return light != lightNumbers.end() ? light->second : name(nameOf(variable));
  }
  if (auto object = address.getDefiningOp<ir::FrameObjectOp>())
    for (const FrameField &field : machine.frame)
      if (field.isObject && field.slot == object.getName())
        return frameField(field.name);
  if (auto argument = address.getDefiningOp<ir::CallArgumentOp>())
    return name(machine.addressName(context, machine.given(argument)));
  if (address.getDefiningOp<ir::PayloadOp>())
    return name(context.names.of(machine.method->parameters.front().get()));
  if (auto field = address.getDefiningOp<ir::FieldOp>())
    if (const Type *base = declaredType(field.getBase()); base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return member(place(field.getBase()), context.names.of(&part));
  if (auto element = address.getDefiningOp<ir::ElementOp>())
    return subscript(place(element.getBase()), elementIndices[element]);
  unsupported(*address.getDefiningOp());
  return integer(0);
}

/// What the leaves of the author's expression are here.
void StateWriter::replaceLeaves(const SourceTable::Entry &entry, mlir::ValueRange operands) {
  printer.replaced.clear();
  for (auto [leaf, operand] : llvm::zip(entry.leaves, operands))
    if (leaf)
      printer.replaced[leaf] =
          llvm::isa<ir::PtrType>(operand.getType()) ? place(operand) : use(operand, leaf->type);
  nameConstants(*entry.expr);
}

Code StateWriter::expression(const SourceTable::Entry &entry, mlir::ValueRange operands) {
  replaceLeaves(entry, operands);
  switch (entry.kind) {
  case SourceTable::Kind::Value:
  case SourceTable::Kind::Into:
    return printer.expressions.expr(*entry.expr);
  case SourceTable::Kind::AngleCosine:
    return cpp::call("rtsl::cosOfAngle", {printer.expressions.argument(*entry.expr)});
  case SourceTable::Kind::Compound: {
    const auto &assign = static_cast<const typed::AssignExpr &>(*entry.expr);
    return printer.operators.binary(assign.op, *assign.target, *assign.value);
  }
  case SourceTable::Kind::Step: {
    const auto &step = static_cast<const typed::IncDecExpr &>(*entry.expr);
    return printer.assignments.stepped(printer.expressions.operand(*step.target, Binding::Sum),
                                       step.target->type->scalar(), step.increment);
  }
  }
  return integer(0);
}

/// The comparison that holds where this one does not. Of an order of floats there is none: it fails
/// for a NaN both ways.
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

/// `i >= 3` for `i < 3`, which is the code of `condition`.
Code StateWriter::opposite(mlir::Value condition, const Code &code) {
  auto whole = condition.getDefiningOp<ir::ExpressionOp>();
  const SourceTable::Entry *entry = whole ? &source.entries[whole.getSource()] : nullptr;
  auto *compared = entry && entry->kind == SourceTable::Kind::Value
                       ? dynCast<typed::BinaryExpr>(entry->expr)
                       : nullptr;
  // below their count
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
void StateWriter::nameConstants(const typed::Expr &expr) {
  std::set<const typed::Expr *> elsewhere;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (printer.replaced.count(&inner))
      forEachExpr(inner, [&](const typed::Expr &part) { elsewhere.insert(&part); });
  });
  auto add = [&](const typed::Variable &constant) {
    if (std::find(constants.begin(), constants.end(), &constant) != constants.end())
      return;
    nameConstants(*constant.init); // what it names stands in front of it
    constants.push_back(&constant);
  };
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (elsewhere.count(&inner))
      return;
    if (auto *named = dynCast<typed::VariableExpr>(&inner);
        named && named->variable->isConst && named->variable->kind != typed::Variable::Kind::Global)
      add(*named->variable);
    if (auto *literal = dynCast<typed::LiteralExpr>(&inner)) // the value of one
      if (const void *named = printer.literals.namedConstant(*literal))
        for (const auto &local : machine.method->locals)
          if (local.get() == named)
            add(*local);
  });
}

} // namespace rtsl::cpp
