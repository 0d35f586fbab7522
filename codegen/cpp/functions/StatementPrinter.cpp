#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

namespace rtsl::cpp {

using ast::StmtKind;
using typed::ExprKind;

//===----------------------------------------------------------------------===//
// The whole body
//===----------------------------------------------------------------------===//

Statements StatementPrinter::body() {
  const auto &statements = cast<typed::CompoundStmt>(*printer.function->body).body;
  // The variables that are read: compilers warn of others.
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
  Statements all; // hoisted statements, then the statement itself
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
    // Hoisted statements must stay after the earlier declarations.
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

} // namespace rtsl::cpp
