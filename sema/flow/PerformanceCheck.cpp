//===- PerformanceCheck.cpp - what is slow on a GPU: -Wperf ---------------===//
//
// What is visible in the source: arrays that cannot be in registers, and recursion that a loop
// could replace. The size of the live state across a `trace` is known only after splitting;
// codegen/driver reports it.
//
//===----------------------------------------------------------------------===//
#include "sema/check/Program.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"
#include "sema/typed/TypeProperties.h"
#include "sema/typed/Walk.h"

#include <unordered_set>

namespace rtsl {

using namespace typed;

namespace {

//===----------------------------------------------------------------------===//
// Arrays that are indexed dynamically
//===----------------------------------------------------------------------===//

/// A `for` with constant bounds and at most this many iterations is assumed to be unrolled, so that
/// its variable is a constant in each iteration.
constexpr unsigned maxUnrolledTurns = 16;

bool compare(ast::BinaryOp op, std::int64_t left, std::int64_t right) {
  switch (op) {
  case ast::BinaryOp::Less:
    return left < right;
  case ast::BinaryOp::LessEqual:
    return left <= right;
  case ast::BinaryOp::Greater:
    return left > right;
  case ast::BinaryOp::GreaterEqual:
    return left >= right;
  case ast::BinaryOp::NotEqual:
    return left != right;
  default:
    return false;
  }
}

/// The amount by which the step of a loop changes its variable; 0 if not known.
std::int64_t stepOf(const Expr &step, const Variable &variable) {
  const auto isVariable = [&](const Expr &expr) {
    const auto *name = dynCast<VariableExpr>(&expr);
    return name && name->variable == &variable;
  };
  if (const auto *incDec = dynCast<IncDecExpr>(&step))
    return !isVariable(*incDec->target) ? 0 : incDec->increment ? 1 : -1;
  const auto *assign = dynCast<AssignExpr>(&step);
  if (!assign || !assign->compound || !isVariable(*assign->target))
    return 0;
  const std::int64_t change = evaluateInteger(*assign->value).value_or(0);
  return assign->op == ast::BinaryOp::Add ? change : assign->op == ast::BinaryOp::Sub ? -change : 0;
}

/// The variable of a loop with constant bounds and few iterations; null for other loops.
const Variable *unrolledVariable(const ForStmt &loop) {
  const auto *declaration = dynCast<DeclarationStmt>(loop.init.get());
  const auto *condition = dynCast<BinaryExpr>(loop.condition.get());
  if (!declaration || declaration->variables.size() != 1 || !condition || !loop.step)
    return nullptr;
  const Variable *variable = declaration->variables[0];
  const auto *left = dynCast<VariableExpr>(condition->left.get());
  const auto first = variable->init ? evaluateInteger(*variable->init) : std::nullopt;
  const auto bound = evaluateInteger(*condition->right);
  const std::int64_t step = stepOf(*loop.step, *variable);
  if (!first || !bound || step == 0 || !left || left->variable != variable ||
      assignedVariables(*loop.body).count(variable))
    return nullptr;
  std::int64_t value = *first;
  for (unsigned turn = 0; turn <= maxUnrolledTurns; ++turn, value += step)
    if (!compare(condition->op, value, *bound))
      return variable;
  return nullptr;
}

/// Warns of the first dynamic index into each local array. A constant array is a table in memory
/// anyway.
class ArrayCheck {
public:
  ArrayCheck(const Function &function, Diagnostics &diagnostics)
      : function(function), diagnostics(diagnostics) {}

  void run() {
    forEachStmt(*function.body, [&](const Stmt &stmt) {
      if (const auto *loop = dynCast<ForStmt>(&stmt))
        if (const Variable *variable = unrolledVariable(*loop))
          unrolled.insert(variable);
    });
    forEachExpr(*function.body, [&](const Expr &expr) {
      if (const auto *index = dynCast<IndexExpr>(&expr))
        check(*index);
    });
  }

private:
  /// Is the value known once the loops are unrolled?
  bool isKnown(const Expr &expr) const {
    if (const auto *name = dynCast<VariableExpr>(&expr))
      return name->variable->constant || unrolled.count(name->variable);
    if (const auto *unary = dynCast<UnaryExpr>(&expr))
      return isKnown(*unary->operand);
    if (const auto *convert = dynCast<ConvertExpr>(&expr))
      return isKnown(*convert->operand);
    if (const auto *binary = dynCast<BinaryExpr>(&expr))
      return isKnown(*binary->left) && isKnown(*binary->right);
    return evaluate(expr).has_value();
  }

  void check(const IndexExpr &index) {
    if (!index.base->type->is(TypeKind::Array) || isKnown(*index.index))
      return;
    const Variable *variable = rootVariable(index);
    if (!variable || variable->kind == Variable::Kind::Global || variable->constant ||
        !reported.insert(variable).second)
      return;
    diagnostics
        .report(Code::dynamicArrayIndex, index.index->range, variable->name,
                sizeInBytes(variable->type))
        .label(variable->range, "declared here");
  }

  const Function &function;
  Diagnostics &diagnostics;
  std::unordered_set<const Variable *> unrolled, reported;
};

//===----------------------------------------------------------------------===//
// Recursion that a loop could replace
//===----------------------------------------------------------------------===//

std::size_t countTraces(const Expr &expr) {
  std::size_t count = 0;
  forEachExpr(expr, [&](const Expr &inner) { count += mayTrace(inner); });
  return count;
}

/// Finds the tail traces of a method: only sums and products follow them, which a loop can
/// accumulate.
class TailTraceCheck {
public:
  TailTraceCheck(const Function &function, Diagnostics &diagnostics)
      : function(function), diagnostics(diagnostics) {}

  void run() {
    std::size_t traces = 0;
    forEachExpr(*function.body, [&](const Expr &expr) { traces += mayTrace(expr); });
    if (traces == 0)
      return;
    visit(*function.body, true);
    if (traces != tails.size()) // the others need the stack anyway
      return;
    for (const Expr *trace : tails)
      diagnostics.report(Code::tailTrace, trace->range, function.name)
          .note("trace in a loop in `generate`, and keep the accumulated product in the payload");
  }

private:
  /// `isLast`: the method ends after this statement.
  void visit(const Stmt &stmt, bool isLast) {
    if (const auto *block = dynCast<CompoundStmt>(&stmt)) {
      for (std::size_t i = 0; i < block->body.size(); ++i) {
        const bool isEnd = i + 1 == block->body.size();
        visit(*block->body[i], isEnd ? isLast : block->body[i + 1]->kind == ast::StmtKind::Return);
      }
    } else if (const auto *branch = dynCast<IfStmt>(&stmt)) {
      visit(*branch->thenStmt, isLast);
      if (branch->elseStmt)
        visit(*branch->elseStmt, isLast);
    } else if (const auto *expression = dynCast<ExpressionStmt>(&stmt)) {
      if (isLast)
        visitLast(*expression->expr);
    } else {
      forEachChild(stmt, [this](const Stmt &child) { visit(child, false); }, [](const Expr &) {});
    }
  }

  void visitLast(const Expr &expr) {
    if (const auto *builtin =
            dynCast<BuiltinExpr>(&expr)) { // with the payload parameter of the method
      const Expr *argument = payloadOf(*builtin);
      const auto *payload = argument ? dynCast<VariableExpr>(argument) : nullptr;
      if (payload && payload->variable->kind == Variable::Kind::Parameter)
        tails.push_back(&expr);
      return;
    }
    const auto *assign = dynCast<AssignExpr>(&expr);
    const auto *state = assign ? dynCast<StateExpr>(assign->target.get()) : nullptr;
    if (!state || state->variable != StateVariable::SampleColor)
      return;
    const bool isSumOrProduct = !assign->compound || assign->op == ast::BinaryOp::Add ||
                                assign->op == ast::BinaryOp::Sub ||
                                assign->op == ast::BinaryOp::Mul;
    if (isSumOrProduct && countTraces(*assign->value) == 1)
      if (const Expr *trace = linearTrace(*assign->value))
        tails.push_back(trace);
  }

  /// The only trace in an expression, if its value is only added to and multiplied; otherwise null.
  const Expr *linearTrace(const Expr &expr) const {
    if (mayTrace(expr))
      return expr.kind == ExprKind::Builtin ? &expr : nullptr;
    if (const auto *unary = dynCast<UnaryExpr>(&expr))
      return linearTrace(*unary->operand);
    const auto *binary = dynCast<BinaryExpr>(&expr);
    if (!binary)
      return nullptr;
    const bool isLeft = countTraces(*binary->left) == 1;
    switch (binary->op) {
    case ast::BinaryOp::Add:
    case ast::BinaryOp::Sub:
    case ast::BinaryOp::Mul:
      return linearTrace(isLeft ? *binary->left : *binary->right);
    case ast::BinaryOp::Div:
      return isLeft ? linearTrace(*binary->left) : nullptr;
    default:
      return nullptr;
    }
  }

  const Function &function;
  Diagnostics &diagnostics;
  std::vector<const Expr *> tails;
};

} // namespace

void checkPerformance(const Function &function, Diagnostics &diagnostics) {
  if (diagnostics.warnings.isOn(Code::dynamicArrayIndex))
    ArrayCheck(function, diagnostics).run();
  // `generate` is where the loop would be.
  const bool mayRecurse = function.isStateMethod && function.name != "generate";
  if (mayRecurse && diagnostics.warnings.isOn(Code::tailTrace))
    TailTraceCheck(function, diagnostics).run();
}

void Program::checkPerformance() {
  if (diagnostics.hasErrors())
    return;
  for (const PendingBody &body : bodies)
    rtsl::checkPerformance(*body.function, diagnostics);
}

} // namespace rtsl
