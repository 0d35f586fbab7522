//===- Copy.cpp - copies of typed trees -----------------------------------===//
#include "sema/derive/Copy.h"

#include "sema/model/Conversion.h"

namespace rtsl::derive {

using namespace typed;

const Variable *Copier::copyOf(const Variable *variable) const {
  const auto found = variables.find(variable);
  return found == variables.end() ? variable : found->second;
}

std::vector<ExprPtr> Copier::copies(const std::vector<ExprPtr> &exprs) {
  std::vector<ExprPtr> made;
  for (const ExprPtr &expr : exprs)
    made.push_back(copy(expr));
  return made;
}

/// A node of the same kind and type, without children.
template <typename T>
static std::unique_ptr<T> like(const T &expr) {
  return makeExpr<T>(expr.type, expr.range);
}

template <typename T, typename Fill>
static ExprPtr made(const Expr &expr, Fill fill) {
  const T &from = cast<T>(expr);
  auto node = like(from);
  fill(*node, from);
  return node;
}

ExprPtr Copier::copyNode(const Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Literal:
    return made<LiteralExpr>(expr, [&](auto &to, const auto &from) {
      to.value = from.value;
      to.spelling = from.spelling;
      to.variable = copyOf(from.variable);
      to.member = from.member;
    });
  case ExprKind::Variable:
    return made<VariableExpr>(
        expr, [&](auto &to, const auto &from) { to.variable = copyOf(from.variable); });
  case ExprKind::State:
    return made<StateExpr>(expr, [](auto &to, const auto &from) { to.variable = from.variable; });
  case ExprKind::Member:
    return made<MemberExpr>(expr, [](auto &to, const auto &from) { to.member = from.member; });
  case ExprKind::Field:
    return made<FieldExpr>(expr, [&](auto &to, const auto &from) {
      to.base = copy(from.base);
      to.field = from.field;
    });
  case ExprKind::Swizzle:
    return made<SwizzleExpr>(expr, [&](auto &to, const auto &from) {
      to.base = copy(from.base);
      to.components = from.components;
    });
  case ExprKind::Index:
    return made<IndexExpr>(expr, [&](auto &to, const auto &from) {
      to.base = copy(from.base);
      to.index = copy(from.index);
    });
  case ExprKind::Length:
    return made<LengthExpr>(expr, [&](auto &to, const auto &from) { to.base = copy(from.base); });
  case ExprKind::Unary:
    return made<UnaryExpr>(expr, [&](auto &to, const auto &from) {
      to.op = from.op;
      to.operand = copy(from.operand);
    });
  case ExprKind::IncDec:
    return made<IncDecExpr>(expr, [&](auto &to, const auto &from) {
      to.increment = from.increment;
      to.prefix = from.prefix;
      to.target = copy(from.target);
    });
  case ExprKind::Binary:
    return made<BinaryExpr>(expr, [&](auto &to, const auto &from) {
      to.op = from.op;
      to.left = copy(from.left);
      to.right = copy(from.right);
    });
  case ExprKind::Assign:
    return made<AssignExpr>(expr, [&](auto &to, const auto &from) {
      to.compound = from.compound;
      to.op = from.op;
      to.target = copy(from.target);
      to.value = copy(from.value);
    });
  case ExprKind::Conditional:
    return made<ConditionalExpr>(expr, [&](auto &to, const auto &from) {
      to.condition = copy(from.condition);
      to.whenTrue = copy(from.whenTrue);
      to.whenFalse = copy(from.whenFalse);
    });
  case ExprKind::Comma:
    return made<CommaExpr>(expr, [&](auto &to, const auto &from) {
      to.left = copy(from.left);
      to.right = copy(from.right);
    });
  case ExprKind::Convert:
    return made<ConvertExpr>(expr, [&](auto &to, const auto &from) {
      to.isImplicit = from.isImplicit;
      to.operand = copy(from.operand);
    });
  case ExprKind::Construct:
    return made<ConstructExpr>(expr,
                               [&](auto &to, const auto &from) { to.args = copies(from.args); });
  case ExprKind::Builtin:
    return made<BuiltinExpr>(expr, [&](auto &to, const auto &from) {
      to.builtin = from.builtin;
      to.args = copies(from.args);
    });
  case ExprKind::Call:
    return made<CallExpr>(expr, [&](auto &to, const auto &from) {
      to.function = from.function;
      to.onSelf = from.onSelf;
      to.isOfBase = from.isOfBase;
      to.args = copies(from.args);
    });
  case ExprKind::MethodCall:
    return made<MethodCallExpr>(expr, [&](auto &to, const auto &from) {
      to.receiver = copy(from.receiver);
      to.method = from.method;
      to.function = from.function;
      to.args = copies(from.args);
    });
  case ExprKind::String:
    return made<StringExpr>(expr, [](auto &to, const auto &from) { to.value = from.value; });
  }
  return nullptr;
}

} // namespace rtsl::derive
