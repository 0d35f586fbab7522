//===- FlowCheck.cpp - control flow of a checked body ---------------------===//
//
// One walk in the order of execution. For every variable that was declared without a value it keeps
// whether it is unwritten on some path to this point, and whether it is written on some path. Where
// paths merge, both facts are joined; at the head of a loop everything that the loop writes may
// have been written, because the walk visits the body only once.
//
//===----------------------------------------------------------------------===//
#include "sema/check/Program.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Walk.h"

#include <unordered_set>

namespace rtsl {

using namespace typed;

namespace {

constexpr std::uint8_t unwritten = 1, written = 2;

/// The facts at a point of the program.
struct State {
  std::vector<std::uint8_t> variables;
  bool reachable = false;

  void join(const State &other) {
    if (!other.reachable)
      return;
    if (!reachable) {
      *this = other;
      return;
    }
    for (std::size_t i = 0; i != variables.size(); ++i)
      variables[i] |= other.variables[i];
  }
};

class FlowCheck {
public:
  FlowCheck(const Function &function, Diagnostics &diagnostics)
      : function(function), diagnostics(diagnostics) {}
  void run();

private:
  /// The states at `break` and `continue`.
  struct Jumps {
    State breaks, continues;
    bool isLoop = true;
  };

  void track(const Variable &variable);
  void visit(const Stmt &stmt);
  void visitList(const std::vector<StmtPtr> &body);
  void visitLoop(const Stmt *body, const Expr *condition, const Expr *step, bool conditionFirst);
  void visitSwitch(const SwitchStmt &stmt);
  void visitIlluminance(const IlluminanceStmt &stmt);
  void visit(const Expr &expr);
  void visitCall(const Expr &expr);
  void visitTarget(const Expr &target, bool reads);
  void visitArgument(const Expr &arg, ast::Direction direction);
  void read(const Variable &variable, SourceRange range);
  void write(const Variable &variable);
  void assumeWritten(const Stmt *body, const Expr *condition, const Expr *step);
  void leave() {
    atExit.join(state);
    state.reachable = false;
  }

  const Function &function;
  Diagnostics &diagnostics;
  std::unordered_map<const Variable *, std::size_t> tracked;
  std::unordered_set<const Variable *> reported;
  std::unordered_set<const Variable *> filledByIndex; // `v[i] = x` with an i that is not constant
  std::vector<Jumps> jumps;
  State state, atExit;
};

bool isAlwaysTrue(const Expr *condition) {
  if (!condition)
    return true;
  if (!condition->type->is(TypeKind::Bool))
    return false;
  const std::optional<Constant> value = evaluate(*condition);
  return value && value->scalars[0].b;
}

} // namespace

//===----------------------------------------------------------------------===//
// Variables
//===----------------------------------------------------------------------===//

/// Variables that a loop may write are not known to be unwritten at its head.
void FlowCheck::assumeWritten(const Stmt *body, const Expr *condition, const Expr *step) {
  std::set<const Variable *> assigned = assignedVariables(*body);
  for (const Expr *expr : {condition, step})
    if (expr)
      assigned.merge(assignedVariables(*expr));
  for (const Variable *variable : assigned)
    if (auto found = tracked.find(variable); found != tracked.end())
      state.variables[found->second] |= written;
}

void FlowCheck::track(const Variable &variable) {
  auto [entry, fresh] = tracked.emplace(&variable, state.variables.size());
  if (fresh)
    state.variables.push_back(unwritten);
}

void FlowCheck::read(const Variable &variable, SourceRange range) {
  auto found = tracked.find(&variable);
  if (found == tracked.end() || !state.reachable)
    return;
  const std::uint8_t flags = state.variables[found->second];
  // An array that is filled in a loop, element by element: it is unknown whether the loop runs.
  const bool isFilled = variable.type->is(TypeKind::Array) || filledByIndex.count(&variable);
  if ((flags & written) && isFilled)
    return;
  if (!(flags & unwritten) || !reported.insert(&variable).second)
    return;
  const Code code = flags & written ? Code::maybeUninitialized : Code::uninitialized;
  diagnostics.report(code, range, variable.name)
      .label(variable.range, "declared without a value here");
}

void FlowCheck::write(const Variable &variable) {
  if (auto found = tracked.find(&variable); found != tracked.end())
    state.variables[found->second] = written;
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

/// Writing a part of a variable counts as writing it: filling an array in a loop must not cause a
/// warning.
void FlowCheck::visitTarget(const Expr &target, bool reads) {
  const Expr *at = &target;
  bool isIndexed = false; // by an index that is not constant
  for (;;) {
    if (const auto *field = dynCast<FieldExpr>(at))
      at = field->base.get();
    else if (const auto *swizzle = dynCast<SwizzleExpr>(at))
      at = swizzle->base.get();
    else if (const auto *index = dynCast<IndexExpr>(at)) {
      visit(*index->index);
      isIndexed |= !evaluate(*index->index);
      at = index->base.get();
    } else
      break;
  }
  const auto *variable = dynCast<VariableExpr>(at);
  if (!variable)
    return;
  if (isIndexed)
    filledByIndex.insert(variable->variable);
  if (reads)
    read(*variable->variable, variable->range);
}

void FlowCheck::visitArgument(const Expr &arg, ast::Direction direction) {
  if (direction == ast::Direction::In) {
    visit(arg);
    return;
  }
  visitTarget(arg, direction == ast::Direction::InOut);
  if (const Variable *variable = rootVariable(arg))
    write(*variable);
}

void FlowCheck::visit(const Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Variable:
    return read(*cast<VariableExpr>(expr).variable, expr.range);
  case ExprKind::Field:
    return visit(*cast<FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return visit(*cast<SwizzleExpr>(expr).base);
  case ExprKind::Index:
    visit(*cast<IndexExpr>(expr).base);
    return visit(*cast<IndexExpr>(expr).index);
  case ExprKind::Length:
    return visit(*cast<LengthExpr>(expr).base);
  case ExprKind::Unary:
    return visit(*cast<UnaryExpr>(expr).operand);
  case ExprKind::IncDec: {
    const Expr &target = *cast<IncDecExpr>(expr).target;
    return visitArgument(target, ast::Direction::InOut);
  }
  case ExprKind::Binary: {
    const auto &binary = cast<BinaryExpr>(expr);
    visit(*binary.left);
    if (binary.op != ast::BinaryOp::LogicalAnd && binary.op != ast::BinaryOp::LogicalOr)
      return visit(*binary.right);
    State skipped = state;
    visit(*binary.right);
    return state.join(skipped);
  }
  case ExprKind::Assign: {
    const auto &assign = cast<AssignExpr>(expr);
    visitTarget(*assign.target, assign.compound);
    visit(*assign.value);
    if (const Variable *variable = rootVariable(*assign.target))
      write(*variable);
    return;
  }
  case ExprKind::Conditional: {
    const auto &conditional = cast<ConditionalExpr>(expr);
    visit(*conditional.condition);
    State before = state;
    visit(*conditional.whenTrue);
    std::swap(state, before);
    visit(*conditional.whenFalse);
    return state.join(before);
  }
  case ExprKind::Comma:
    visit(*cast<CommaExpr>(expr).left);
    return visit(*cast<CommaExpr>(expr).right);
  case ExprKind::Convert:
    return visit(*cast<ConvertExpr>(expr).operand);
  case ExprKind::Construct:
    for (const ExprPtr &arg : cast<ConstructExpr>(expr).args)
      visit(*arg);
    return;
  case ExprKind::Builtin:
  case ExprKind::Call:
  case ExprKind::MethodCall:
    return visitCall(expr);
  default:
    return;
  }
}

void FlowCheck::visitCall(const Expr &expr) {
  const auto visitAll = [&](const std::vector<ExprPtr> &args, const Function *callee) {
    for (std::size_t i = 0; i != args.size(); ++i)
      visitArgument(*args[i], callee ? callee->parameters[i]->direction : ast::Direction::In);
  };
  if (const auto *call = dynCast<CallExpr>(&expr))
    return visitAll(call->args, call->function);
  if (const auto *call = dynCast<MethodCallExpr>(&expr)) {
    visit(*call->receiver);
    return visitAll(call->args, call->function);
  }
  // The author may leave a payload uninitialised before the ray is traced: passing it is not
  // counted as a read.
  const auto &call = cast<BuiltinExpr>(expr);
  for (std::size_t i = 0; i != call.args.size(); ++i)
    visitArgument(*call.args[i],
                  isOutArgument(call.builtin, i) ? ast::Direction::Out : ast::Direction::In);
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

void FlowCheck::visitList(const std::vector<StmtPtr> &body) {
  bool quiet = !state.reachable; // already reported for an enclosing statement
  for (const StmtPtr &stmt : body) {
    // A `break` after a `return` is a harmless habit.
    if (!state.reachable && !quiet && stmt->kind != ast::StmtKind::Break) {
      diagnostics.report(Code::unreachable, stmt->range);
      quiet = true;
    }
    visit(*stmt);
  }
}

/// `for`, `while` and, with the condition after the body, `do`.
void FlowCheck::visitLoop(const Stmt *body, const Expr *condition, const Expr *step,
                          bool conditionFirst) {
  assumeWritten(body, condition, step);
  const bool endless = isAlwaysTrue(condition);
  State exit;
  if (conditionFirst && condition) {
    visit(*condition);
    if (!endless)
      exit = state;
  }
  jumps.emplace_back();
  visit(*body);
  state.join(jumps.back().continues);
  if (step)
    visit(*step);
  if (!conditionFirst) {
    visit(*condition);
    if (!endless)
      exit = state;
  }
  exit.join(jumps.back().breaks);
  jumps.pop_back();
  state.reachable = exit.reachable;
  if (exit.reachable)
    state = std::move(exit);
}

void FlowCheck::visitSwitch(const SwitchStmt &stmt) {
  visit(*stmt.value);
  const State entry = state;
  bool hasDefault = false;
  jumps.emplace_back();
  jumps.back().isLoop = false;
  state.reachable = false;
  for (const SwitchStmt::Arm &arm : stmt.arms) {
    hasDefault |= arm.isDefault;
    state.join(entry);
    visitList(arm.body);
  }
  state.join(jumps.back().breaks);
  jumps.pop_back();
  if (!hasDefault)
    state.join(entry);
}

void FlowCheck::visitIlluminance(const IlluminanceStmt &stmt) {
  for (const ExprPtr *arg : {&stmt.point, &stmt.normal, &stmt.angle})
    if (*arg)
      visit(**arg);
  const State entry = state; // there may be no light
  assumeWritten(stmt.body.get(), nullptr, nullptr);
  jumps.emplace_back();
  visit(*stmt.body);
  state.join(jumps.back().continues);
  state.join(jumps.back().breaks);
  jumps.pop_back();
  state.join(entry);
}

void FlowCheck::visit(const Stmt &stmt) {
  switch (stmt.kind) {
  case ast::StmtKind::Compound:
    return visitList(cast<CompoundStmt>(stmt).body);
  case ast::StmtKind::Declaration:
    for (const Variable *variable : cast<DeclarationStmt>(stmt).variables) {
      if (variable->init)
        visit(*variable->init);
      else // reset in each iteration of a loop
        state.variables[tracked.at(variable)] = unwritten;
    }
    return;
  case ast::StmtKind::Expression:
    return visit(*cast<ExpressionStmt>(stmt).expr);
  case ast::StmtKind::If: {
    const auto &branch = cast<IfStmt>(stmt);
    visit(*branch.condition);
    State before = state;
    visit(*branch.thenStmt);
    std::swap(state, before);
    if (branch.elseStmt)
      visit(*branch.elseStmt);
    return state.join(before);
  }
  case ast::StmtKind::For: {
    const auto &loop = cast<ForStmt>(stmt);
    if (loop.init)
      visit(*loop.init);
    return visitLoop(loop.body.get(), loop.condition.get(), loop.step.get(), true);
  }
  case ast::StmtKind::While: {
    const auto &loop = cast<WhileStmt>(stmt);
    return visitLoop(loop.body.get(), loop.condition.get(), nullptr, true);
  }
  case ast::StmtKind::DoWhile: {
    const auto &loop = cast<DoWhileStmt>(stmt);
    return visitLoop(loop.body.get(), loop.condition.get(), nullptr, false);
  }
  case ast::StmtKind::Switch:
    return visitSwitch(cast<SwitchStmt>(stmt));
  case ast::StmtKind::Illuminance:
    return visitIlluminance(cast<IlluminanceStmt>(stmt));
  case ast::StmtKind::Break:
    jumps.back().breaks.join(state);
    state.reachable = false;
    return;
  case ast::StmtKind::Continue:
    for (auto target = jumps.rbegin(); target != jumps.rend(); ++target)
      if (target->isLoop) {
        target->continues.join(state);
        break;
      }
    state.reachable = false;
    return;
  case ast::StmtKind::Return:
    if (const ExprPtr &value = cast<ReturnStmt>(stmt).value)
      visit(*value);
    return leave();
  default:
    return;
  }
}

void FlowCheck::run() {
  state.reachable = true;
  for (const std::unique_ptr<Variable> &parameter : function.parameters)
    if (parameter->direction == ast::Direction::Out)
      track(*parameter);
  for (const std::unique_ptr<Variable> &local : function.locals)
    if (!local->init)
      track(*local);
  visit(*function.body);
  if (state.reachable && !function.returnType->is(TypeKind::Void) &&
      !function.returnType->isError())
    diagnostics
        .report(Code::missingReturn, function.range, function.name, toString(function.returnType))
        .note("control reaches the end of its body");
  leave();
  if (!atExit.reachable)
    return;
  for (const std::unique_ptr<Variable> &parameter : function.parameters) {
    if (parameter->direction != ast::Direction::Out || parameter->name.empty())
      continue;
    if (atExit.variables[tracked.at(parameter.get())] == unwritten)
      diagnostics.report(Code::outNotWritten, parameter->range, parameter->name);
  }
}

void checkFlow(const Function &function, Diagnostics &diagnostics) {
  FlowCheck(function, diagnostics).run();
}

} // namespace rtsl
