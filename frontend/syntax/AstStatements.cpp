//===- AstStatements.cpp - parse tree to syntax tree: statements ----------===//
#include "frontend/syntax/AstBuilder.h"

namespace rtsl {

using namespace ast;

/// The statement; null for a broken one, which has been reported.
StmtPtr AstBuilder::buildStatement(Parser::StatementContext *context) {
  if (!context)
    return nullptr;
  StmtPtr statement = buildStatementBody(context);
  if (statement)
    statement->comment = commentAbove(context);
  return statement;
}

/// A broken statement where one is required becomes an empty one.
StmtPtr AstBuilder::orEmpty(Parser::StatementContext *context) {
  if (StmtPtr statement = buildStatement(context))
    return statement;
  auto empty = std::make_unique<EmptyStmt>();
  if (context)
    empty->range = range(context);
  return empty;
}

std::vector<StmtPtr>
AstBuilder::buildBody(const std::vector<Parser::StatementContext *> &contexts) {
  std::vector<StmtPtr> body;
  for (auto *context : contexts)
    if (StmtPtr statement = buildStatement(context))
      body.push_back(std::move(statement));
  return body;
}

std::unique_ptr<CompoundStmt> AstBuilder::buildBlock(Parser::BlockContext *context) {
  auto block = make<CompoundStmt>(context);
  block->body = buildBody(context->statement());
  return block;
}

StmtPtr AstBuilder::buildSimple(Parser::SimpleStatementContext *context) {
  if (!context)
    return nullptr;
  if (auto *declaration = context->localDeclaration()) {
    // A broken one keeps the variables that it did declare: their uses are not mistakes.
    auto statement = make<DeclarationStmt>(declaration);
    addVariables(declaration, declaration->qualifier(), declaration->typeName(),
                 declaration->declarator(), Place::Local, statement->variables);
    for (VariableDecl &variable : statement->variables)
      variable.comment.clear(); // it is the statement's
    return statement->variables.empty() ? nullptr : StmtPtr(std::move(statement));
  }
  if (context->exception)
    return nullptr;
  if (auto *expression = context->expressionStatement()) {
    if (expression->exception)
      return nullptr;
    auto statement = make<ExpressionStmt>(expression);
    statement->expr = buildExpression(expression->expression());
    return statement;
  }
  return make<EmptyStmt>(context);
}

StmtPtr AstBuilder::buildStatementBody(Parser::StatementContext *context) {
  if (auto *simple = context->simpleStatement())
    return buildSimple(simple);
  if (context->exception)
    return nullptr;
  if (auto *block = context->block())
    return buildBlock(block);
  if (auto *branch = context->ifStatement()) {
    auto statement = make<IfStmt>(branch);
    statement->condition = buildCondition(branch->condition(), statement->range);
    const auto branches = branch->statement();
    statement->thenStmt = orEmpty(branches.empty() ? nullptr : branches[0]);
    if (branches.size() > 1)
      statement->elseStmt = orEmpty(branches[1]);
    return statement;
  }
  if (auto *loop = context->forStatement()) {
    auto statement = make<ForStmt>(loop);
    statement->init = buildSimple(loop->simpleStatement());
    if (!statement->init) {
      auto empty = std::make_unique<EmptyStmt>();
      empty->range = statement->range;
      statement->init = std::move(empty);
    }
    // The second semicolon separates condition and step; the first one belongs to the statement.
    bool isStep = false;
    for (auto *child : loop->children) {
      if (auto *word = dynamic_cast<antlr4::tree::TerminalNode *>(child))
        isStep |= word->getSymbol()->getType() == Parser::SEMICOLON;
      else if (auto *expression = dynamic_cast<Parser::ExpressionContext *>(child))
        (isStep ? statement->step : statement->condition) = buildExpression(expression);
    }
    statement->body = orEmpty(loop->statement());
    return statement;
  }
  if (auto *loop = context->whileStatement()) {
    auto statement = make<WhileStmt>(loop);
    statement->condition = buildCondition(loop->condition(), statement->range);
    statement->body = orEmpty(loop->statement());
    return statement;
  }
  if (auto *loop = context->doStatement()) {
    auto statement = make<DoWhileStmt>(loop);
    statement->body = orEmpty(loop->statement());
    statement->condition = buildCondition(loop->condition(), statement->range);
    return statement;
  }
  if (auto *choice = context->switchStatement()) {
    auto statement = make<SwitchStmt>(choice);
    statement->value = buildCondition(choice->condition(), statement->range);
    statement->body = buildBody(choice->statement());
    return statement;
  }
  if (auto *label = context->caseLabel()) {
    auto statement = make<CaseStmt>(label);
    if (label->CASE())
      statement->value = buildExpression(label->expression());
    return statement;
  }
  if (auto *leave = context->breakStatement())
    return make<BreakStmt>(leave);
  if (auto *next = context->continueStatement())
    return make<ContinueStmt>(next);
  if (auto *result = context->returnStatement()) {
    auto statement = make<ReturnStmt>(result);
    if (auto *value = result->expression())
      statement->value = buildExpression(value);
    return statement;
  }
  if (auto *loop = context->illuminanceStatement()) {
    auto statement = make<IlluminanceStmt>(loop);
    statement->args = buildArguments(loop->arguments());
    statement->body = orEmpty(loop->statement());
    return statement;
  }
  return nullptr;
}

} // namespace rtsl
