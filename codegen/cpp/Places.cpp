//===- Places.cpp - variables, members, elements, parts of vectors --------===//
#include "codegen/cpp/Printer.h"

#include "codegen/lower/Analysis.h"
#include "sema/Casting.h"
#include "sema/ConstantFold.h"

#include <fmt/format.h>

#include <cassert>

namespace rtsl::cpp {

using typed::ExprKind;

static const char letters[] = "xyzw";

/// A constant index that is in range.
static std::optional<std::uint32_t> constantIndex(const typed::Expr &index, std::uint32_t count) {
  auto *literal = dynCast<typed::LiteralExpr>(&index);
  if (!literal || literal->value.scalars.front().u >= count)
    return std::nullopt;
  return literal->value.scalars.front().u;
}

bool FunctionPrinter::isSimple(const typed::Expr &expr) const {
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
    return swizzle.components.size() == 1 && swizzle.base->type->isVector() && isSimple(*swizzle.base);
  }
  default:
    return false;
  }
}

std::vector<std::uint8_t> FunctionPrinter::components(const typed::Expr &place,
                                                      const typed::Expr *&vector) const {
  auto *swizzle = dynCast<typed::SwizzleExpr>(&place);
  if (!swizzle || !swizzle->base->type->isVector())
    return {};
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

Effects FunctionPrinter::indexEffects(const typed::Expr &place) {
  Effects effects;
  for (const typed::Expr *at = &place;;) {
    if (auto *field = dynCast<typed::FieldExpr>(at)) {
      at = field->base.get();
    } else if (auto *swizzle = dynCast<typed::SwizzleExpr>(at)) {
      at = swizzle->base.get();
    } else if (auto *index = dynCast<typed::IndexExpr>(at)) {
      effects.add(module.effects.expression(*index->index));
      at = index->base.get();
    } else {
      return effects;
    }
  }
}

Code FunctionPrinter::place(const typed::Expr &expr, bool storeIndices) {
  if (auto found = replaced.find(&expr); found != replaced.end())
    return found->second;
  switch (expr.kind) {
  case ExprKind::Variable:
    return {module.names.of(cast<typed::VariableExpr>(expr).variable)};
  case ExprKind::State:
    return {std::string("rt.") + typed::name(cast<typed::StateExpr>(expr).variable)};
  case ExprKind::Member: {
    const typed::Member &member = *cast<typed::MemberExpr>(expr).member;
    const std::string &name = module.names.of(&member);
    return {member.access == ast::Access::Scratch ? "scratch." + name : name};
  }
  case ExprKind::Field: {
    const auto &field = cast<typed::FieldExpr>(expr);
    const std::string base =
        lowering::isPlace(*field.base) ? place(*field.base, storeIndices).text : operand(*field.base, Binding::Primary);
    return {base + "." + module.names.of(&field.base->type->structure->fields[field.field])};
  }
  case ExprKind::Swizzle: {
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = components(expr, vector);
    if (parts.size() == 1)
      return {bind(place(*vector, storeIndices), Binding::Primary) + "." + letters[parts[0]]};
    if (auto *swizzle = dynCast<typed::SwizzleExpr>(&expr); swizzle->base->type->isScalar())
      return place(*swizzle->base, storeIndices);
    break;
  }
  case ExprKind::Index: {
    const auto &index = cast<typed::IndexExpr>(expr);
    if (index.base->type->is(TypeKind::Buffer))
      return bufferElement(index);
    const typed::Expr *vector = nullptr;
    if (const std::vector<std::uint8_t> parts = components(*index.base, vector); !parts.empty()) {
      // `v.zx[i]`: the component that the swizzle names.
      if (auto constant = constantIndex(*index.index, index.base->type->count))
        return {bind(place(*vector, storeIndices), Binding::Primary) + "." + letters[parts[*constant]]};
      std::vector<std::string> numbers;
      for (std::uint8_t part : parts)
        numbers.push_back(std::to_string(part));
      const std::string table =
          fmt::format("rtsl::array<int, {}>{{{{{}}}}}[{}]", numbers.size(), join(numbers, ", "),
                      this->index(index, storeIndices));
      return {fmt::format("rtsl::at({}, {})", place(*vector, storeIndices).text, table)};
    }
    // An outer index comes first.
    const bool changes = isNested && conflicts(module.effects.expression(*index.base), module.effects.expression(*index.index));
    const std::string base = lowering::isPlace(*index.base) ? place(*index.base, storeIndices || changes).text
                             : changes                      ? hoist(index.base->type, "value", argument(*index.base))
                                                            : operand(*index.base, Binding::Primary);
    return element(index, base, storeIndices);
  }
  default:
    break;
  }
  return this->expr(expr);
}

std::string FunctionPrinter::index(const typed::IndexExpr &expr, bool storeIndices) {
  std::string text = argument(*expr.index);
  if (storeIndices && expr.index->kind != ExprKind::Literal)
    text = hoist(expr.index->type, "index", text);
  return checked(text, std::to_string(expr.base->type->count));
}

// Outside of functions there is no sample that could end.
std::string FunctionPrinter::checked(const std::string &index, const std::string &count) const {
  const bool raises = function && module.options.exceptions && module.options.checkIndices;
  return raises ? fmt::format("rtsl::checked(rt, {}, {})", index, count) : index;
}

Code FunctionPrinter::element(const typed::IndexExpr &expr, const std::string &base, bool storeIndices) {
  const Type *type = expr.base->type;
  if (auto constant = constantIndex(*expr.index, type->count))
    return {fmt::format("{}[{}]", base, *constant)};
  const std::string text = index(expr, storeIndices);
  if (type->is(TypeKind::Array)) // clamps
    return {base + "[" + text + "]"};
  return {"rtsl::at(" + base + ", " + text + ")"};
}

// All indices of `buffer[i][j]`.
Code FunctionPrinter::bufferElement(const typed::IndexExpr &expr) {
  std::vector<const typed::Expr *> indices;
  const typed::Expr *base = &expr;
  while (auto *index = dynCast<typed::IndexExpr>(base)) {
    if (!index->base->type->is(TypeKind::Buffer))
      break;
    indices.insert(indices.begin(), index->index.get());
    base = index->base.get();
  }
  assert(indices.size() == base->type->count && "a part of a buffer is no value");
  std::vector<std::string> texts = operands(indices, Binding::Assignment);
  const std::string buffer = place(*base).text;
  for (std::size_t i = 0; i < texts.size(); ++i)
    texts[i] = checked(texts[i], texts.size() == 1 ? buffer + ".length()" : fmt::format("{}.length({})", buffer, i));
  if (texts.size() == 1)
    return {buffer + "[" + texts.front() + "]"};
  return {buffer + ".at(" + join(texts, ", ") + ")"};
}

// `buffer[i].length()` asks for the second dimension; which i does not matter, but what it does is
// done.
Code FunctionPrinter::length(const typed::LengthExpr &expr) {
  unsigned dimension = 0;
  const typed::Expr *base = expr.base.get();
  while (auto *index = dynCast<typed::IndexExpr>(base)) {
    if (!index->base->type->is(TypeKind::Buffer))
      break;
    if (!module.effects.expression(*index->index).isPure())
      before->push_back(argument(*index->index) + ";");
    base = index->base.get();
    ++dimension;
  }
  if (!base->type->is(TypeKind::Buffer))
    return {std::to_string(base->type->count)};
  return {place(*base).text + (dimension ? fmt::format(".length({})", dimension) : ".length()")};
}

} // namespace rtsl::cpp
