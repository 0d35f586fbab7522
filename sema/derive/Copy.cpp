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

/// Fills a node of the same kind and type with copies of an expression's children.
struct Copier::Filler {
  Copier &copier;

  void fill(LiteralExpr &to, const LiteralExpr &from) {
    to.value = from.value;
    to.spelling = from.spelling;
    to.variable = copier.copyOf(from.variable);
    to.member = from.member;
  }
  void fill(VariableExpr &to, const VariableExpr &from) {
    to.variable = copier.copyOf(from.variable);
  }
  void fill(StateExpr &to, const StateExpr &from) { to.variable = from.variable; }
  void fill(MemberExpr &to, const MemberExpr &from) { to.member = from.member; }
  void fill(FieldExpr &to, const FieldExpr &from) {
    to.base = copier.copy(from.base);
    to.field = from.field;
  }
  void fill(SwizzleExpr &to, const SwizzleExpr &from) {
    to.base = copier.copy(from.base);
    to.components = from.components;
  }
  void fill(IndexExpr &to, const IndexExpr &from) {
    to.base = copier.copy(from.base);
    to.index = copier.copy(from.index);
  }
  void fill(LengthExpr &to, const LengthExpr &from) { to.base = copier.copy(from.base); }
  void fill(UnaryExpr &to, const UnaryExpr &from) {
    to.op = from.op;
    to.operand = copier.copy(from.operand);
  }
  void fill(IncDecExpr &to, const IncDecExpr &from) {
    to.increment = from.increment;
    to.prefix = from.prefix;
    to.target = copier.copy(from.target);
  }
  void fill(BinaryExpr &to, const BinaryExpr &from) {
    to.op = from.op;
    to.left = copier.copy(from.left);
    to.right = copier.copy(from.right);
  }
  void fill(AssignExpr &to, const AssignExpr &from) {
    to.compound = from.compound;
    to.op = from.op;
    to.target = copier.copy(from.target);
    to.value = copier.copy(from.value);
  }
  void fill(ConditionalExpr &to, const ConditionalExpr &from) {
    to.condition = copier.copy(from.condition);
    to.whenTrue = copier.copy(from.whenTrue);
    to.whenFalse = copier.copy(from.whenFalse);
  }
  void fill(CommaExpr &to, const CommaExpr &from) {
    to.left = copier.copy(from.left);
    to.right = copier.copy(from.right);
  }
  void fill(ConvertExpr &to, const ConvertExpr &from) {
    to.isImplicit = from.isImplicit;
    to.operand = copier.copy(from.operand);
  }
  void fill(ConstructExpr &to, const ConstructExpr &from) { to.args = copier.copies(from.args); }
  void fill(BuiltinExpr &to, const BuiltinExpr &from) {
    to.builtin = from.builtin;
    to.args = copier.copies(from.args);
  }
  void fill(CallExpr &to, const CallExpr &from) {
    to.function = from.function;
    to.onSelf = from.onSelf;
    to.isOfBase = from.isOfBase;
    to.args = copier.copies(from.args);
  }
  void fill(MethodCallExpr &to, const MethodCallExpr &from) {
    to.receiver = copier.copy(from.receiver);
    to.method = from.method;
    to.function = from.function;
    to.args = copier.copies(from.args);
  }
  void fill(StringExpr &to, const StringExpr &from) { to.value = from.value; }

  template <typename T>
  ExprPtr made(const Expr &expr) {
    auto node = makeExpr<T>(expr.type, expr.range);
    fill(*node, cast<T>(expr));
    return node;
  }
};

ExprPtr Copier::copyNode(const Expr &expr) {
  Filler filler{*this};
  switch (expr.kind) {
  case ExprKind::Literal:
    return filler.made<LiteralExpr>(expr);
  case ExprKind::Variable:
    return filler.made<VariableExpr>(expr);
  case ExprKind::State:
    return filler.made<StateExpr>(expr);
  case ExprKind::Member:
    return filler.made<MemberExpr>(expr);
  case ExprKind::Field:
    return filler.made<FieldExpr>(expr);
  case ExprKind::Swizzle:
    return filler.made<SwizzleExpr>(expr);
  case ExprKind::Index:
    return filler.made<IndexExpr>(expr);
  case ExprKind::Length:
    return filler.made<LengthExpr>(expr);
  case ExprKind::Unary:
    return filler.made<UnaryExpr>(expr);
  case ExprKind::IncDec:
    return filler.made<IncDecExpr>(expr);
  case ExprKind::Binary:
    return filler.made<BinaryExpr>(expr);
  case ExprKind::Assign:
    return filler.made<AssignExpr>(expr);
  case ExprKind::Conditional:
    return filler.made<ConditionalExpr>(expr);
  case ExprKind::Comma:
    return filler.made<CommaExpr>(expr);
  case ExprKind::Convert:
    return filler.made<ConvertExpr>(expr);
  case ExprKind::Construct:
    return filler.made<ConstructExpr>(expr);
  case ExprKind::Builtin:
    return filler.made<BuiltinExpr>(expr);
  case ExprKind::Call:
    return filler.made<CallExpr>(expr);
  case ExprKind::MethodCall:
    return filler.made<MethodCallExpr>(expr);
  case ExprKind::String:
    return filler.made<StringExpr>(expr);
  }
  return nullptr;
}

} // namespace rtsl::derive
