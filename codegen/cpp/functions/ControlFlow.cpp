//===- ControlFlow.cpp - branches, loops and switches of the author's -----===//
#include "codegen/cpp/functions/FunctionPrinter.h"

#include "math/Elementary.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

using ast::StmtKind;

Statement StatementPrinter::ifStatement(const typed::IfStmt &stmt) {
  Statement made = simple(StatementKind::If);
  made.value = printer.expressions.operand(*stmt.condition, Binding::Comma);
  // The comment after the author's opening brace.
  if (stmt.thenStmt && stmt.thenStmt->kind == StmtKind::Compound)
    made.trailing = context.notes.trailingComment(
        {stmt.range.file, stmt.condition->range.begin, stmt.condition->range.end});
  nest(stmt.thenStmt, made);
  if (stmt.elseStmt)
    made.otherwise = nested(stmt.elseStmt, made.otherwiseHasBraces);
  made.otherwiseHasBraces |= stmt.elseStmt && made.otherwise.empty();
  return made;
}

// A counter that runs over a known interval cannot overflow.
void StatementPrinter::noteCounter(const typed::ForStmt &stmt) {
  auto *declaration = dynCast<typed::DeclarationStmt>(stmt.init);
  auto *condition = dynCast<typed::BinaryExpr>(stmt.condition);
  auto *step = dynCast<typed::IncDecExpr>(stmt.step);
  if (!declaration || !condition || !step || !step->increment)
    return;
  auto *counter = dynCast<typed::VariableExpr>(condition->left);
  auto *stepped = dynCast<typed::VariableExpr>(step->target);
  const bool isBounded = condition->op == ast::BinaryOp::Less ||
                         condition->op == ast::BinaryOp::NotEqual ||
                         condition->op == ast::BinaryOp::LessEqual;
  if (!counter || !stepped || counter->variable != stepped->variable || !isBounded ||
      !counter->variable->type->is(TypeKind::Int))
    return;
  const auto &declared = declaration->variables;
  if (std::find(declared.begin(), declared.end(), counter->variable) == declared.end() ||
      !counter->variable->init)
    return;
  if (stmt.body && assignedVariables(*stmt.body).count(counter->variable))
    return;
  const std::optional<Interval> first = printer.ranges.range(*counter->variable->init);
  const std::optional<Interval> last = printer.ranges.range(*condition->right);
  const bool isConstant = last && last->low == last->high;
  if (condition->op == ast::BinaryOp::Less) {
    // i < n <= INT_MAX
    printer.counters[counter->variable] = {
        first ? first->low : std::numeric_limits<std::int32_t>::min(),
        last ? last->high : std::numeric_limits<std::int32_t>::max()};
  } else if (condition->op == ast::BinaryOp::LessEqual && last &&
             last->high < std::numeric_limits<std::int32_t>::max()) {
    printer.counters[counter->variable] = {
        first ? first->low : std::numeric_limits<std::int32_t>::min(), last->high + 1};
  } else if (condition->op == ast::BinaryOp::NotEqual && isConstant && first &&
             first->high <= last->low) {
    printer.counters[counter->variable] = {first->low, last->high};
  }
}

/// The step of a `for`, whose results are not used.
Code StatementPrinter::stepOf(const typed::Expr &expr) {
  if (auto *comma = dynCast<typed::CommaExpr>(&expr)) {
    const Code left = stepOf(*comma->left);
    return cpp::comma(left, stepOf(*comma->right));
  }
  if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
    return printer.assignments.incDec(*incDec, false);
  if (auto *assignment = dynCast<typed::AssignExpr>(&expr))
    return printer.assignments.assign(*assignment, false);
  const Code code = printer.expressions.argument(expr);
  return context.effects.expression(expr).isPure() ? discarded(code) : code;
}

Statement StatementPrinter::forStatement(const typed::ForStmt &stmt) {
  noteCounter(stmt);
  Statement made = simple(StatementKind::For);
  Statements outside;
  if (auto *declared = dynCast<typed::DeclarationStmt>(stmt.init)) {
    outside = declaration(*declared, true);
    if (!outside.empty()) { // declarations of other types are moved before the loop
      if (outside.back().is(StatementKind::Declaration))
        made.init = {outside.back()};
      outside.pop_back();
    }
  } else if (auto *expression = dynCast<typed::ExpressionStmt>(stmt.init)) {
    made.init = {statement(printer.expressions.apart(*expression->expr, Binding::Comma))};
  }
  if (stmt.condition)
    made.value = printer.expressions.apart(*stmt.condition, Binding::Comma);
  if (stmt.step) {
    Statements hoisted;
    Statements *outer = printer.before;
    printer.before = &hoisted;
    made.step = stepOf(*stmt.step);
    printer.before = outer;
    if (!hoisted.empty()) {
      if (made.step)
        hoisted.push_back(statement(discarded(made.step)));
      made.step = lambda(std::move(hoisted));
    }
  }
  nest(stmt.body, made);
  if (outside.empty())
    return made;
  outside.push_back(made);
  return cpp::block(std::move(outside));
}

/// May control reach what follows the statements?
static bool mayComplete(const std::vector<typed::StmtPtr> &statements);
static bool mayComplete(const typed::Stmt *stmt) {
  if (!stmt)
    return true;
  switch (stmt->kind) {
  case StmtKind::Break:
  case StmtKind::Continue:
  case StmtKind::Return:
    return false;
  case StmtKind::Compound:
    return mayComplete(cast<typed::CompoundStmt>(*stmt).body);
  case StmtKind::If: {
    const auto &branch = cast<typed::IfStmt>(*stmt);
    return mayComplete(branch.thenStmt.get()) || mayComplete(branch.elseStmt.get());
  }
  default:
    return true;
  }
}
static bool mayComplete(const std::vector<typed::StmtPtr> &statements) {
  return std::all_of(statements.begin(), statements.end(),
                     [](const typed::StmtPtr &stmt) { return mayComplete(stmt.get()); });
}

// A variable that is declared in one arm is in scope in later arms, and C++ allows no jump past its
// declaration: such a variable is declared before the switch. If no later arm mentions it, the arm
// gets braces instead.
Statement StatementPrinter::switchStatement(const typed::SwitchStmt &stmt) {
  Statement made = simple(StatementKind::Switch);
  Statements declared;
  std::vector<bool> needsBraces(stmt.arms.size(), false);
  for (std::size_t i = 0; i < stmt.arms.size(); ++i)
    for (const typed::StmtPtr &inner : stmt.arms[i].body)
      if (auto *declaration = dynCast<typed::DeclarationStmt>(inner))
        for (const typed::Variable *variable : declaration->variables) {
          bool isSeenBelow = false;
          for (std::size_t j = i + 1; j < stmt.arms.size(); ++j)
            for (const typed::StmtPtr &other : stmt.arms[j].body)
              forEachExpr(*other, [&](const typed::Expr &expr) {
                auto *use = dynCast<typed::VariableExpr>(&expr);
                isSeenBelow |= use && use->variable == variable;
              });
          if (!isSeenBelow) {
            needsBraces[i] = true;
            continue;
          }
          printer.hoistedDeclarations.insert(variable);
          declared.push_back(cpp::declaration(context.types.of(variable->type),
                                              context.names.of(variable), list("", {})));
        }
  made.value = printer.expressions.operand(*stmt.value, Binding::Comma);
  const bool isUnsigned = stmt.value->type->is(TypeKind::UInt);
  for (std::size_t i = 0; i < stmt.arms.size(); ++i) {
    const auto &source = stmt.arms[i];
    Arm &arm = made.arms.emplace_back();
    for (std::int64_t value : source.values)
      arm.labels.push_back(isUnsigned
                               ? cpp::literal(fmt::format("{}u", static_cast<std::uint32_t>(value)))
                               : integer(value));
    arm.isDefault = source.isDefault;
    const std::size_t known = printer.temporaries.size();
    arm.body = block(source.body);
    arm.hasBraces = needsBraces[i] || printer.temporaries.size() != known;
    if (i + 1 < stmt.arms.size() && mayComplete(source.body))
      arm.body.push_back(simple(StatementKind::Fallthrough));
    else if (arm.body.empty() && i + 1 == stmt.arms.size())
      arm.body.push_back(simple(StatementKind::Break));
  }
  if (declared.empty())
    return made;
  declared.push_back(made);
  return cpp::block(std::move(declared));
}

Statement lightLoop(const std::string &lights, std::vector<Code> arguments) {
  arguments.insert(arguments.begin(), name("rt"));
  Statement made = simple(StatementKind::For);
  made.init = {
      declaration("rtsl::Lights", lights, construct("rtsl::Lights", std::move(arguments)))};
  made.init.front().declarators.front().isDirect = true;
  made.value = callMember(name(lights), "next", {});
  return made;
}

Statement StatementPrinter::illuminance(const typed::IlluminanceStmt &stmt) {
  std::vector<const typed::Expr *> pointers = {stmt.point.get()};
  if (stmt.normal && stmt.angle) {
    pointers.push_back(stmt.normal.get());
    pointers.push_back(stmt.angle.get());
  }
  std::vector<Code> args = printer.expressions.operands(pointers, Binding::Assignment);
  if (stmt.angle)
    if (const auto *angle = dynCast<typed::LiteralExpr>(stmt.angle.get())) {
      constexpr float pi = 3.14159265358979323846F;
      const float known = std::min(std::max(angle->value.scalars.front().f, 0.0F), pi);
      args.push_back(remark("cosine=", floatLiteral(device::cos(known))));
    }
  Statement made = lightLoop("lights", std::move(args));
  nest(stmt.body, made);
  return made;
}

} // namespace rtsl::cpp
