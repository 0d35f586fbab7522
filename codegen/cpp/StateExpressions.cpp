//===- StateExpressions.cpp - places and expressions of a state -----------===//
//
// An expression is the author's tree (codegen/lower/SourceTable.h), whose leaves are what the IR has computed.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/StateWriter.h"

#include "sema/Casting.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Matchers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace rtsl::cpp {

using typed::ExprKind;

Code StateWriter::use(mlir::Value value, const std::string &type) {
  if (auto found = declared.find(value); found != declared.end())
    return {found->second};
  auto found = pending.find(value);
  if (found == pending.end())
    return constant(value, type);
  Code code = found->second.code;
  consumed.add(found->second.touches);
  mentioned.insert(found->second.mentions.begin(), found->second.mentions.end());
  if (--found->second.usesLeft == 0)
    pending.erase(value);
  return code;
}

// C++ asks both values to be of one type, and a vector of bools has another where it lies in memory.
std::string choose(const std::string &condition, const std::string &first, const std::string &second,
                   const std::string &type) {
  const auto side = [&](const std::string &value) {
    const bool isBools = type.compare(0, 9, "glm::bvec") == 0;
    return isBools && value.compare(0, type.size() + 1, type + "(") != 0 ? type + "(" + value + ")" : value;
  };
  return condition + " ? " + side(first) + " : " + side(second);
}

static Code numberCode(mlir::Attribute number, bool isUnsigned) {
  std::string text;
  if (auto integer = llvm::dyn_cast<mlir::IntegerAttr>(number)) {
    const llvm::APInt &value = integer.getValue();
    text = integer.getType().isInteger(1)    ? (value.isZero() ? "false" : "true")
           : isUnsigned                      ? fmt::format("{}u", value.getZExtValue())
           : value.isMinSignedValue()        ? "std::numeric_limits<int>::min()"
                                             : std::to_string(value.getSExtValue());
  } else {
    text = floatText(llvm::cast<mlir::FloatAttr>(number).getValue().convertToFloat());
  }
  return {text, text.front() == '-' ? Binding::Unary : Binding::Primary};
}

Code StateWriter::constant(mlir::Value value, const std::string &type) {
  mlir::Attribute attribute;
  if (!mlir::matchPattern(value, mlir::m_Constant(&attribute))) {
    if (value.getDefiningOp<ir::NullRefOp>())
      return {type.empty() ? "{}" : type + "{}"};
    if (value.getDefiningOp())
      unsupported(*value.getDefiningOp());
    return {"0"};
  }
  auto dense = llvm::dyn_cast<mlir::DenseElementsAttr>(attribute);
  if (!dense)
    return numberCode(attribute, type == "unsigned");
  mlir::Type element = dense.getElementType();
  std::string vector = type;
  if (vector.empty())
    vector = fmt::format("glm::{}vec{}", element.isF32() ? "" : element.isInteger(1) ? "b" : "i", dense.getNumElements());
  const bool isUnsigned = vector.compare(0, 9, "glm::uvec") == 0;
  if (dense.isSplat())
    return {vector + "(" + numberCode(dense.getSplatValue<mlir::Attribute>(), isUnsigned).text + ")"};
  std::vector<std::string> parts;
  for (mlir::Attribute part : dense.getValues<mlir::Attribute>())
    parts.push_back(numberCode(part, isUnsigned).text);
  return {vector + "(" + join(parts, ", ") + ")"};
}

Code StateWriter::place(mlir::Value address) {
  if (auto state = address.getDefiningOp<ir::StateOp>())
    return {"rt." + state.getName().str()};
  if (auto variable = address.getDefiningOp<ir::VarOp>()) {
    mentioned.insert(variable);
    return {nameOf(variable)};
  }
  if (auto object = address.getDefiningOp<ir::FrameObjectOp>())
    for (const FrameField &field : machine.frame)
      if (field.isObject && field.slot == object.getName())
        return {machine.frameName + "." + field.name};
  if (auto argument = address.getDefiningOp<ir::CallArgumentOp>())
    return {machine.addressName(module, machine.given(argument))};
  if (address.getDefiningOp<ir::PayloadOp>())
    return {module.names.of(machine.method->parameters.front().get())};
  if (auto field = address.getDefiningOp<ir::FieldOp>())
    if (const Type *base = declaredType(field.getBase()); base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return {place(field.getBase()).text + "." + module.names.of(&part)};
  if (auto element = address.getDefiningOp<ir::ElementOp>())
    return {place(element.getBase()).text + "[" + elementIndices[element] + "]"};
  unsupported(*address.getDefiningOp());
  return {"0"};
}

/// `isCompound`: on return, whether the first operand is the target of `target op= value`, which may be printed so.
Code StateWriter::expression(const SourceTable::Entry &entry, mlir::ValueRange operands, bool &isCompound) {
  isCompound = false;
  printer.replaced.clear();
  for (auto [leaf, operand] : llvm::zip(entry.leaves, operands)) {
    if (!leaf)
      continue;
    const Code code = llvm::isa<ir::PtrType>(operand.getType()) ? place(operand) : use(operand, module.type(leaf->type));
    printer.replaced[leaf] = code;
  }
  nameConstants(*entry.expr);
  switch (entry.kind) {
  case SourceTable::Kind::Value:
  case SourceTable::Kind::Into:
    return printer.expr(*entry.expr);
  case SourceTable::Kind::AngleCosine:
    return {"rtsl::cosOfAngle(" + printer.argument(*entry.expr) + ")"};
  case SourceTable::Kind::Compound: {
    const auto &assign = static_cast<const typed::AssignExpr &>(*entry.expr);
    isCompound = printer.plainOperator(assign.op, *assign.target, *assign.value) != nullptr;
    return printer.binary(assign.op, *assign.target, *assign.value);
  }
  case SourceTable::Kind::Step: {
    const auto &step = static_cast<const typed::IncDecExpr &>(*entry.expr);
    const Type *scalar = step.target->type->scalar();
    const std::string target = printer.operand(*step.target, Binding::Sum);
    if (scalar->is(TypeKind::Int))
      return {fmt::format("rtsl::{}({}, 1)", step.increment ? "add" : "subtract", target)};
    return {fmt::format("{} {} {}", target, step.increment ? "+" : "-", scalar->is(TypeKind::Float) ? "1.0f" : "1u"),
            Binding::Sum};
  }
  }
  return {"0"};
}

namespace {

/// A comparison's sign, and that of the opposite.
struct Signs {
  const char *own, *opposite;
};

} // namespace

static constexpr Signs below = {"<", ">="};

/// None where the opposite of an order would answer differently for a NaN.
static std::optional<Signs> oppositeOf(const typed::BinaryExpr &expr) {
  using ast::BinaryOp;
  const Type *type = expr.left->type;
  const bool isWhole = type->is(TypeKind::Int) || type->is(TypeKind::UInt);
  static const std::map<BinaryOp, Signs> orders = {{BinaryOp::Less, below},
                                                   {BinaryOp::LessEqual, {"<=", ">"}},
                                                   {BinaryOp::Greater, {">", "<="}},
                                                   {BinaryOp::GreaterEqual, {">=", "<"}}};
  if (expr.op == BinaryOp::Equal)
    return Signs{"==", "!="};
  if (expr.op == BinaryOp::NotEqual)
    return Signs{"!=", "=="};
  const auto order = orders.find(expr.op);
  return isWhole && order != orders.end() ? std::optional(order->second) : std::nullopt;
}

/// Where a text has ` sign `, once and outside of parentheses; npos: it has not.
static std::size_t findOutside(const std::string &text, const std::string &sign) {
  std::size_t found = std::string::npos;
  int depth = 0;
  for (std::size_t at = 0; at != text.size(); ++at) {
    if (std::strchr("([{", text[at]))
      ++depth;
    else if (std::strchr(")]}", text[at]))
      --depth;
    else if (depth == 0 && text.compare(at, sign.size() + 2, " " + sign + " ") == 0)
      found = found == std::string::npos ? at : text.size();
  }
  return found == text.size() ? std::string::npos : found;
}

/// `i >= 3` for `i < 3`, which is the code of `condition`.
Code StateWriter::opposite(mlir::Value condition, const Code &code) {
  auto whole = condition.getDefiningOp<ir::ExpressionOp>();
  const SourceTable::Entry *entry = whole ? &source.entries[whole.getSource()] : nullptr;
  auto *binary = entry && entry->kind == SourceTable::Kind::Value
                     ? dynCast<typed::BinaryExpr>(entry->expr)
                     : nullptr;
  const bool isOfLights =
      condition.getDefiningOp<mlir::arith::CmpIOp>() != nullptr; // below their count
  if ((!binary && !isOfLights) ||
      (code.binding != Binding::Relation && code.binding != Binding::Equality))
    return negated(code);
  const std::optional<Signs> signs = isOfLights ? below : oppositeOf(*binary);
  const std::size_t at = signs ? findOutside(code.text, signs->own) : std::string::npos;
  if (at == std::string::npos)
    return negated(code);
  return {code.text.substr(0, at + 1) + signs->opposite +
              code.text.substr(at + 1 + std::strlen(signs->own)),
          code.binding};
}

Code negated(const Code &code) {
  if (code.binding != Binding::Unary || code.text.front() != '!')
    return {"!" + bind(code, Binding::Unary), Binding::Unary};
  const std::string inner = code.text.substr(1);
  int depth = 0; // do parentheses hold all of it?
  std::size_t end = 0;
  do
    depth += inner[end] == '(' ? 1 : inner[end] == ')' ? -1 : 0;
  while (depth != 0 && ++end != inner.size());
  if (inner.front() == '(' && end + 1 == inner.size())
    return {inner.substr(1, inner.size() - 2), Binding::Assignment};
  return {inner, Binding::Primary};
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
      if (const void *named = printer.namedConstant(*literal))
        for (const auto &local : machine.method->locals)
          if (local.get() == named)
            add(*local);
  });
}

} // namespace rtsl::cpp
