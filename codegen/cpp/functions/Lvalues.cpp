#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/fold/ConstantFold.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <cassert>

namespace rtsl::cpp {

using typed::ExprKind;

/// A constant index that is in range.
static std::optional<std::uint32_t> constantIndex(const typed::Expr &index, std::uint32_t count) {
  auto *literal = dynCast<typed::LiteralExpr>(&index);
  if (!literal || literal->value.scalars.front().u >= count)
    return std::nullopt;
  return literal->value.scalars.front().u;
}

bool Lvalues::isSimple(const typed::Expr &expr) const {
  switch (expr.kind) {
  case ExprKind::Variable:
  case ExprKind::State:
  case ExprKind::Member:
    return true;
  case ExprKind::Field:
    return isSimple(*cast<typed::FieldExpr>(expr).base);
  case ExprKind::Index: {
    const auto &index = cast<typed::IndexExpr>(expr);
    return !index.base->type->is(TypeKind::Buffer) && isSimple(*index.base) &&
           constantIndex(*index.index, index.base->type->count);
  }
  case ExprKind::Swizzle: {
    const auto &swizzle = cast<typed::SwizzleExpr>(expr);
    return swizzle.components.size() == 1 && swizzle.base->type->isVector() &&
           isSimple(*swizzle.base);
  }
  default:
    return false;
  }
}

std::vector<std::uint8_t> Lvalues::components(const typed::Expr &place,
                                              const typed::Expr *&vector) const {
  auto *swizzle = dynCast<typed::SwizzleExpr>(&place);
  if (!swizzle || !swizzle->base->type->isVector())
    return {};
  if (typed::isWholeVector(*swizzle))
    return components(*swizzle->base, vector);
  std::vector<std::uint8_t> inner = components(*swizzle->base, vector);
  if (inner.empty()) {
    vector = swizzle->base.get();
    return swizzle->components;
  }
  std::vector<std::uint8_t> result;
  for (std::uint8_t component : swizzle->components)
    result.push_back(inner[component]);
  return result;
}

typed::Effects Lvalues::indexEffects(const typed::Expr &place) {
  typed::Effects effects;
  for (const typed::Expr *at = &place;;) {
    if (auto *field = dynCast<typed::FieldExpr>(at)) {
      at = field->base.get();
    } else if (auto *swizzle = dynCast<typed::SwizzleExpr>(at)) {
      at = swizzle->base.get();
    } else if (auto *index = dynCast<typed::IndexExpr>(at)) {
      effects.add(context.effects.expression(*index->index));
      effects.raises |= raises() && typed::mayBeOutOfRange(*index);
      at = index->base.get();
    } else {
      return effects;
    }
  }
}

Code Lvalues::of(const typed::Expr &expr, bool storeIndices) {
  if (auto found = printer.replaced.find(&expr); found != printer.replaced.end())
    return found->second;
  switch (expr.kind) {
  case ExprKind::Variable:
    return name(printer.nameOf(cast<typed::VariableExpr>(expr).variable));
  case ExprKind::State:
    return member(name("rt"), typed::name(cast<typed::StateExpr>(expr).variable));
  case ExprKind::Member: {
    const typed::Member &found = *cast<typed::MemberExpr>(expr).member;
    const std::string &own = context.names.of(&found);
    return found.access == ast::Access::Scratch ? member(name("scratch"), own) : name(own);
  }
  case ExprKind::Field: {
    const auto &field = cast<typed::FieldExpr>(expr);
    const Code base = typed::isLvalue(*field.base)
                          ? of(*field.base, storeIndices)
                          : printer.expressions.operand(*field.base, Binding::Primary);
    return member(base, context.names.of(&field.base->type->structure->fields[field.field]));
  }
  case ExprKind::Swizzle: {
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = components(expr, vector);
    if (parts.size() == 1)
      return component(of(*vector, storeIndices), parts[0]);
    const auto &swizzle = cast<typed::SwizzleExpr>(expr);
    if (swizzle.base->type->isScalar() || (parts.empty() && typed::isWholeVector(swizzle)))
      return of(*swizzle.base, storeIndices);
    break;
  }
  case ExprKind::Index: {
    const auto &index = cast<typed::IndexExpr>(expr);
    if (index.base->type->is(TypeKind::Buffer))
      return bufferElement(index, storeIndices);
    const typed::Expr *vector = nullptr;
    if (const std::vector<std::uint8_t> parts = components(*index.base, vector); !parts.empty()) {
      // `v.zx[i]`: the component that the swizzle names.
      if (auto constant = constantIndex(*index.index, index.base->type->count))
        return component(of(*vector, storeIndices), parts[*constant]);
      std::vector<Code> numbers;
      for (std::uint8_t part : parts)
        numbers.push_back(integer(part));
      const std::string type = withParameters("rtsl::array", {"int", std::to_string(parts.size())});
      const Code number =
          subscript(array(type, std::move(numbers)), this->index(index, storeIndices));
      return cpp::call("rtsl::at", {of(*vector, storeIndices), number});
    }
    // The outer index is evaluated first.
    const bool changes = printer.isNested && conflicts(context.effects.expression(*index.base),
                                                       context.effects.expression(*index.index));
    const Code base = typed::isLvalue(*index.base) ? of(*index.base, storeIndices || changes)
                      : changes ? printer.hoist(index.base->type, "value",
                                                printer.expressions.argument(*index.base))
                                : printer.expressions.operand(*index.base, Binding::Primary);
    return element(index, base, storeIndices);
  }
  default:
    break;
  }
  return printer.expressions.expr(expr);
}

Code Lvalues::index(const typed::IndexExpr &expr, bool storeIndices) {
  const Code code = checked(printer.expressions.argument(*expr.index), countOf(expr));
  return storeIndices && expr.index->kind != ExprKind::Literal
             ? printer.hoist(expr.index->type, "index", code)
             : code;
}

Code Lvalues::countOf(const typed::IndexExpr &expr) {
  if (!expr.base->type->is(TypeKind::Buffer))
    return integer(expr.base->type->count);
  const auto [base, indices] = typed::bufferAccess(expr);
  const bool hasOneDimension = base->type->count == 1;
  return lengthOf(of(*base), hasOneDimension ? std::nullopt : std::optional(indices.size() - 1));
}

// Outside of functions, for example in initialisers of members, there is no sample to end.
bool Lvalues::raises() const {
  return printer.function && context.options.exceptions && context.options.checkIndices;
}

Code Lvalues::checked(Code index, Code count) const {
  return raises() ? cpp::call("rtsl::checked", {name("rt"), std::move(index), std::move(count)})
                  : index;
}

Code Lvalues::element(const typed::IndexExpr &expr, const Code &base, bool storeIndices) {
  const Type *type = expr.base->type;
  if (auto constant = constantIndex(*expr.index, type->count))
    return subscript(base, integer(*constant));
  const Code number = index(expr, storeIndices);
  if (type->is(TypeKind::Array)) // clamps
    return subscript(base, number);
  return cpp::call("rtsl::at", {base, number});
}

// All indices of `buffer[i][j]`.
Code Lvalues::bufferElement(const typed::IndexExpr &expr, bool storeIndices) {
  const auto [base, indices] = typed::bufferAccess(expr);
  assert(indices.size() == base->type->count && "a part of a buffer is no value");
  std::vector<Code> codes = printer.expressions.operands(indices, Binding::Assignment);
  const Code buffer = of(*base);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    codes[i] =
        checked(codes[i], lengthOf(buffer, codes.size() == 1 ? std::nullopt : std::optional(i)));
    if (storeIndices && (raises() || indices[i]->kind != ExprKind::Literal))
      codes[i] = printer.hoist(indices[i]->type, "index", codes[i]);
  }
  if (typed::isInOutputBuffer(expr))
    codes.insert(codes.begin(), name("rt"));
  else if (codes.size() == 1)
    return subscript(buffer, codes.front());
  return callMember(buffer, "at", std::move(codes));
}

/// The length of a buffer, or of one of its dimensions.
Code Lvalues::lengthOf(const Code &buffer, std::optional<std::size_t> dimension) {
  std::vector<Code> arguments;
  if (dimension)
    arguments.push_back(integer(static_cast<std::int64_t>(*dimension)));
  return callMember(buffer, "length", std::move(arguments));
}

// `buffer[i].length()` is the size of the second dimension. It does not depend on i, but the
// effects of i are kept.
Code Lvalues::length(const typed::LengthExpr &expr) {
  std::size_t dimension = 0;
  const typed::Expr *base = expr.base.get();
  while (auto *index = dynCast<typed::IndexExpr>(base)) {
    if (!index->base->type->is(TypeKind::Buffer))
      break;
    if (!context.effects.expression(*index->index).isPure())
      printer.before->push_back(statement(printer.expressions.argument(*index->index)));
    base = index->base.get();
    ++dimension;
  }
  if (!base->type->is(TypeKind::Buffer))
    return integer(base->type->count);
  return lengthOf(of(*base), dimension ? std::optional(dimension) : std::nullopt);
}

bool Lvalues::canBind(const typed::Expr &place) const {
  const typed::Expr *vector = nullptr;
  if (components(place, vector).size() > 1)
    return false;
  auto *variable = dynCast<typed::VariableExpr>(&place);
  const bool isBool = place.type->is(TypeKind::Bool) ||
                      (place.type->isVector() && place.type->element->is(TypeKind::Bool));
  if (auto *component = dynCast<typed::SwizzleExpr>(&place); component && isBool)
    return canBind(*component->base);
  return variable || !isBool;
}

} // namespace rtsl::cpp
