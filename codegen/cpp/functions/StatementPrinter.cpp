#include "codegen/cpp/functions/FunctionPrinter.h"

#include "math/Elementary.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

using ast::StmtKind;
using typed::ExprKind;

//===----------------------------------------------------------------------===//
// The whole body
//===----------------------------------------------------------------------===//

Statements StatementPrinter::body() {
  const auto &statements = cast<typed::CompoundStmt>(*printer.function->body).body;
  // Which variables are read? Compilers warn of the others.
  std::set<const typed::Expr *> onlyWritten;
  context.effects.forEachEvaluated(*printer.function->body, [&](const typed::Expr &expr) {
    auto skip = [&](const typed::Expr *place) {
      while (auto *swizzle = dynCast<typed::SwizzleExpr>(place))
        place = swizzle->base.get();
      onlyWritten.insert(place);
    };
    if (auto *assign = dynCast<typed::AssignExpr>(&expr))
      skip(assign->target.get());
    else if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
      skip(incDec->target.get());
    if (auto *variable = dynCast<typed::VariableExpr>(&expr)) {
      if (!onlyWritten.count(&expr))
        printer.readVariables.insert(variable->variable);
    }
    if (auto *literal = dynCast<typed::LiteralExpr>(&expr))
      if (auto *named =
              static_cast<const typed::Variable *>(printer.literals.namedConstant(*literal)))
        printer.readVariables.insert(named);
  });
  Statements all;
  for (std::size_t i = 0; i != printer.function->parameters.size(); ++i)
    if (const typed::Variable &parameter = *printer.function->parameters[i];
        context.signatures.beginsAsZero(parameter, *printer.function))
      all.push_back(
          statement(cpp::assign(name(context.signatures.parameterName(*printer.function, i)),
                                context.types.zero(parameter.type))));
  print(statements, all);
  return all;
}

void StatementPrinter::print(const std::vector<typed::StmtPtr> &statements, Statements &out) {
  for (std::size_t i = 0; i < statements.size(); ++i) {
    if (!statements[i])
      continue;
    const std::size_t first = out.size();
    print(*statements[i], out);
    const SourceRange previous =
        i > 0 && statements[i - 1] ? statements[i - 1]->range : SourceRange();
    if (i > 0 && first < out.size() &&
        context.notes.followsEmptyLine(statements[i]->range, previous))
      out[first].hasSpace = true;
  }
}

Statements StatementPrinter::block(const std::vector<typed::StmtPtr> &statements) {
  Statements inner;
  print(statements, inner);
  return inner;
}

Statements StatementPrinter::construct(const typed::Stmt &stmt) {
  switch (stmt.kind) {
  case StmtKind::Compound:
    return {cpp::block(block(cast<typed::CompoundStmt>(stmt).body))};
  case StmtKind::Declaration:
    return declaration(cast<typed::DeclarationStmt>(stmt), false);
  case StmtKind::Expression:
    return expressionStatement(*cast<typed::ExpressionStmt>(stmt).expr);
  case StmtKind::If:
    return {ifStatement(cast<typed::IfStmt>(stmt))};
  case StmtKind::For:
    return {forStatement(cast<typed::ForStmt>(stmt))};
  case StmtKind::While: {
    const auto &source = cast<typed::WhileStmt>(stmt);
    Statement made = simple(StatementKind::While);
    made.value = printer.expressions.apart(*source.condition, Binding::Comma);
    nest(source.body, made);
    return {made};
  }
  case StmtKind::DoWhile: {
    const auto &source = cast<typed::DoWhileStmt>(stmt);
    Statement made = simple(StatementKind::DoWhile);
    nest(source.body, made);
    made.value = printer.expressions.apart(*source.condition, Binding::Comma);
    return {made};
  }
  case StmtKind::Switch:
    return {switchStatement(cast<typed::SwitchStmt>(stmt))};
  case StmtKind::Break:
    return {simple(StatementKind::Break)};
  case StmtKind::Continue:
    return {simple(StatementKind::Continue)};
  case StmtKind::Return: {
    const auto &value = cast<typed::ReturnStmt>(stmt).value;
    return {returning(value ? printer.expressions.operand(*value, Binding::Assignment) : Code())};
  }
  case StmtKind::Illuminance:
    return {illuminance(cast<typed::IlluminanceStmt>(stmt))};
  case StmtKind::Case:
  case StmtKind::Empty:
    return {simple(StatementKind::Empty)};
  }
  return {};
}

/// May a comment of the author's stand after it on its last line?
static bool endsWithLine(StmtKind kind) {
  return kind == StmtKind::Declaration || kind == StmtKind::Expression || kind == StmtKind::Break ||
         kind == StmtKind::Continue || kind == StmtKind::Return;
}

void StatementPrinter::print(const typed::Stmt &stmt, Statements &out) {
  Statements all; // what goes before it, then the statement
  Statements *outer = printer.before;
  printer.before = &all;
  const Statements own = construct(stmt);
  printer.before = outer;
  all.insert(all.end(), own.begin(), own.end());
  if (!own.empty() && endsWithLine(stmt.kind))
    all.back().trailing = context.notes.trailingComment(stmt.range);
  std::optional<SourcePlace> place = context.lineDirective(stmt.range);
  if (all.empty() && stmt.comment.empty() && !place)
    return;
  if (all.empty())
    all.push_back(simple(StatementKind::Nothing));
  all.front().comment = stmt.comment;
  all.front().place = std::move(place);
  out.insert(out.end(), all.begin(), all.end());
}

Statements StatementPrinter::nested(const typed::StmtPtr &stmt, bool &hasBraces) {
  hasBraces = !stmt || (stmt->kind == StmtKind::Compound && stmt->comment.empty());
  if (!stmt)
    return {};
  if (hasBraces && !context.lineDirective(stmt->range))
    return block(cast<typed::CompoundStmt>(*stmt).body);
  Statements inner;
  print(*stmt, inner);
  const bool isEmpty =
      inner.size() == 1 && inner.front().is(StatementKind::Empty) && inner.front().comment.empty();
  return isEmpty ? Statements() : inner;
}

void StatementPrinter::nest(const typed::StmtPtr &stmt, Statement &under) {
  under.body = nested(stmt, under.hasBraces);
}

//===----------------------------------------------------------------------===//
// Declarations and expressions
//===----------------------------------------------------------------------===//

Statements StatementPrinter::declaration(const typed::DeclarationStmt &stmt, bool inHeader) {
  Statements all;
  const Type *lineType = nullptr; // of the last declaration, if another variable may join it
  Statements *const outer = printer.before;
  for (const typed::Variable *variable : stmt.variables) {
    Statements hoisted;
    printer.before = &hoisted;
    const std::string &own = context.names.of(variable);
    const Code value = variable->init ? printer.expressions.argument(*variable->init)
                                      : context.types.zero(variable->type);
    printer.before = outer;
    // What goes before must not overtake the others.
    Statements &above = all.empty() ? *outer : all;
    above.insert(above.end(), hoisted.begin(), hoisted.end());
    if (!hoisted.empty())
      lineType = nullptr;
    if (printer.hoistedDeclarations.count(variable)) {
      lineType = nullptr;
      if (variable->init)
        all.push_back(statement(cpp::assign(name(own), value)));
      continue;
    }
    const bool isUnread = !printer.readVariables.count(variable);
    const bool isTableOf =
        variable->isConst && variable->init && printer.literals.isTable(*variable->init);
    const std::string constness = isTableOf ? "static constexpr" : variable->isConst ? "const" : "";
    const std::string qualifiers = !isUnread           ? constness
                                   : constness.empty() ? "[[maybe_unused]]"
                                                       : "[[maybe_unused]] " + constness;
    if (lineType == variable->type && !isUnread && all.back().qualifiers == qualifiers) {
      all.back().declarators.push_back({own, value}); // declarators of one type share a line
      continue;
    }
    all.push_back(cpp::declaration(qualifiers, context.types.of(variable->type), own, value));
    lineType = isUnread ? nullptr : variable->type;
  }
  if (inHeader && !all.empty() && !all.back().is(StatementKind::Declaration))
    all.push_back(simple(StatementKind::Nothing));
  return all;
}

Statements StatementPrinter::expressionStatement(const typed::Expr &expr) {
  Code code;
  if (auto *value = dynCast<typed::AssignExpr>(&expr)) {
    code = printer.assignments.assign(*value, false);
    const bool isToItself = code && !code->compound && same(code->parts[0], code->parts[1]);
    return code && !isToItself ? Statements{statement(code)} : Statements();
  }
  if (auto *value = dynCast<typed::IncDecExpr>(&expr)) {
    code = printer.assignments.incDec(*value, false);
    const typed::Expr *vector = nullptr;
    return printer.lvalues.components(*value->target, vector).size() > 1
               ? Statements()
               : Statements{statement(code)};
  }
  if (auto *comma = dynCast<typed::CommaExpr>(&expr)) { // two statements
    Statements both = expressionStatement(*comma->left);
    Statements *outer = printer.before;
    Statements hoisted;
    printer.before = &hoisted;
    const Statements right = expressionStatement(*comma->right);
    printer.before = outer;
    both.insert(both.end(), hoisted.begin(), hoisted.end());
    both.insert(both.end(), right.begin(), right.end());
    return both;
  }
  if (Statements answer = printer.hitAnswers.hitAnswer(expr); !answer.empty())
    return answer;
  code = printer.expressions.expr(expr);
  if (!code)
    return {};
  const bool isCall = (expr.kind == ExprKind::Call || expr.kind == ExprKind::MethodCall ||
                       expr.kind == ExprKind::Builtin) &&
                      code->is(ExpressionKind::Call);
  const bool isUnused =
      !expr.type->is(TypeKind::Void) && (!isCall || context.effects.expression(expr).isPure());
  return {statement(isUnused ? discarded(code) : code)};
}

//===----------------------------------------------------------------------===//
// Control
//===----------------------------------------------------------------------===//

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
    if (!outside.empty()) { // the others, of other types, stand in front
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

// A variable that is declared in one arm is in scope in those below, to which C++ allows no jump:
// such variables are declared before the switch. If no arm below mentions it, the arm gets braces.
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
