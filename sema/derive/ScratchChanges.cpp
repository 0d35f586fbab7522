//===- ScratchChanges.cpp - how scratch members of a primitive change -----===//
#include "sema/derive/ScratchChanges.h"

#include "sema/derive/DerivedBody.h"
#include "sema/model/Conversion.h"
#include "sema/typed/Walk.h"

namespace rtsl::derive {

using namespace typed;
using ast::BinaryOp;

namespace {

ExprPtr assigned(ExprPtr target, ExprPtr value) {
  auto node = makeExpr<AssignExpr>(target->type, target->range);
  node->target = std::move(target);
  node->value = std::move(value);
  return node;
}

ExprPtr memberOf(const Member &member, SourceRange range) {
  auto node = makeExpr<MemberExpr>(member.type, range);
  node->member = &member;
  return node;
}

StmtPtr evaluated(ExprPtr expr) {
  auto made = std::make_unique<ExpressionStmt>();
  made->range = expr->range;
  made->expr = std::move(expr);
  return made;
}

bool isBuiltin(const Expr &expr, Builtin builtin) {
  const auto *call = dynCast<BuiltinExpr>(&expr);
  return call && call->builtin == builtin;
}

/// Writes a copy of `intersect` that reports no hit, and whose scratch members are variables.
class FollowedIntersect : public DerivedBody {
public:
  FollowedIntersect(Derivation &derivation, const Function &intersect, const ChangeMembers &changes,
                    Function &to)
      : DerivedBody(derivation, intersect, to, /*isAtHit=*/false), intersect(intersect),
        changes(changes) {}

  void write() {
    distance = &addLocal(freeName(intersect, "distance"), types.floatType, intersect.range);
    auto end = makeExpr<StateExpr>(types.floatType, intersect.range);
    end->variable = StateVariable::HitDistance;
    distance->init = std::move(end);
    std::vector<StmtPtr> first;
    first.push_back(declaration(*distance));
    forEachExpr(*intersect.body, [&](const Expr &expr) {
      if (const Member *member = scratchOf(expr); member && !scratch.count(member)) {
        Variable &made = addLocal(freeName(intersect, member->name), member->type, member->range);
        scratch[member] = &made;
        first.push_back(declaration(made));
      }
    });
    replace();
    auto &body = static_cast<CompoundStmt &>(*to.body).body;
    body.insert(body.begin(), std::make_move_iterator(first.begin()),
                std::make_move_iterator(first.end()));
    storeChanges(body);
  }

private:
  static const Member *scratchOf(const Expr &expr) {
    const auto *read = dynCast<MemberExpr>(&expr);
    return read && read->member->access == ast::Access::Scratch ? read->member : nullptr;
  }

  ExprPtr use(const Variable &variable, SourceRange range) const {
    auto node = makeExpr<VariableExpr>(variable.type, range);
    node->variable = &variable;
    return node;
  }

  ExprPtr truth(bool value, SourceRange range) const {
    auto node = makeExpr<LiteralExpr>(types.boolType, range);
    node->value.scalars.resize(1);
    node->value.scalars[0].i = value;
    return node;
  }

  ExprPtr compared(BinaryOp op, ExprPtr left, ExprPtr right) const {
    auto node = makeExpr<BinaryExpr>(types.boolType, left->range);
    node->op = op;
    node->left = std::move(left);
    node->right = std::move(right);
    return node;
  }

  /// `hit(t)`: the rule of runtime/device/ray/Hit.h for a primitive that is alone.
  ExprPtr accepted(const Expr &t) {
    const SourceRange range = t.range;
    ExprPtr set; // before the variable, so that those of t are declared first
    ExprPtr value = copy(t);
    const Variable &kept = addKept(types.floatType, range);
    set = assigned(use(kept, range), std::move(value));
    auto begin = makeExpr<StateExpr>(types.floatType, range);
    begin->variable = StateVariable::Epsilon;
    auto taken = makeExpr<CommaExpr>(types.boolType, range);
    taken->left = assigned(use(*distance, range), use(kept, range));
    taken->right = truth(true, range);
    auto choice = makeExpr<ConditionalExpr>(types.boolType, range);
    choice->condition =
        compared(BinaryOp::LogicalAnd, compared(BinaryOp::Less, std::move(begin), use(kept, range)),
                 compared(BinaryOp::Less, use(kept, range), use(*distance, range)));
    choice->whenTrue = std::move(taken);
    choice->whenFalse = truth(false, range);
    auto all = makeExpr<CommaExpr>(types.boolType, range);
    all->left = std::move(set);
    all->right = std::move(choice);
    return all;
  }

  ExprPtr copy(const Expr &expr) override {
    if (const Member *member = scratchOf(expr))
      return use(*scratch.at(member), expr.range);
    if (const auto *state = dynCast<StateExpr>(&expr);
        state && state->variable == StateVariable::HitDistance)
      return use(*distance, expr.range);
    if (isBuiltin(expr, Builtin::Hit))
      return accepted(*cast<BuiltinExpr>(expr).args.front());
    return DerivedBody::copy(expr);
  }

  void statement(const Stmt &stmt, std::vector<StmtPtr> &out) override {
    if (const auto *end = dynCast<ReturnStmt>(&stmt)) {
      auto block = std::make_unique<CompoundStmt>();
      block->range = end->range;
      storeChanges(block->body);
      auto made = std::make_unique<ReturnStmt>();
      made->range = end->range;
      block->body.push_back(std::move(made));
      out.push_back(std::move(block));
      return;
    }
    const auto *expression = dynCast<ExpressionStmt>(&stmt);
    if (!expression || !isBuiltin(*expression->expr, Builtin::Print)) // it has been printed
      DerivedBody::statement(stmt, out);
  }

  /// `uv_dx = dFdx(uv);` for each.
  void storeChanges(std::vector<StmtPtr> &out) const {
    for (const Member *change : changes) {
      const auto found = scratch.find(change->changeOf);
      ExprPtr value = zero(change->type, intersect.range);
      if (found != scratch.end()) {
        auto derivative = makeExpr<BuiltinExpr>(change->type, intersect.range);
        derivative->builtin = change->axis == 0 ? Builtin::DFdx : Builtin::DFdy;
        derivative->args.push_back(use(*found->second, intersect.range));
        value = std::move(derivative);
      }
      out.push_back(evaluated(assigned(memberOf(*change, intersect.range), std::move(value))));
    }
  }

  const Function &intersect;
  const ChangeMembers &changes;
  Variable *distance = nullptr;
  std::map<const Member *, const Variable *> scratch;
};

} // namespace

bool canFollowScratch(const Function &intersect, EffectsOf &effects) {
  if (effects.statement(*intersect.body).random)
    return false;
  bool can = true;
  forEachExpr(*intersect.body, [&](const Expr &expr) {
    const Function *called = nullptr;
    if (const auto *call = dynCast<CallExpr>(&expr))
      called = call->function;
    else if (const auto *method = dynCast<MethodCallExpr>(&expr))
      called = method->function;
    if (!called)
      return;
    const Effects &of = effects.function(*called);
    can &= !of.reportsHit && !of.usesScratch && !of.writesScratch;
  });
  return can;
}

void writeScratchChanges(Derivation &derivation, const Function &intersect,
                         const ChangeMembers &changes, Function &to) {
  FollowedIntersect(derivation, intersect, changes, to).write();
}

void writeNoScratchChanges(const Function &intersect, const ChangeMembers &changes, Function &to) {
  auto body = std::make_unique<CompoundStmt>();
  body->range = intersect.body->range;
  for (const Member *change : changes)
    body->body.push_back(evaluated(
        assigned(memberOf(*change, intersect.range), zero(change->type, intersect.range))));
  to.body = std::move(body);
}

} // namespace rtsl::derive
