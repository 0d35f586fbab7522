//===- CheckStmt.cpp - statements -----------------------------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/TypeProperties.h"

#include <unordered_map>

namespace rtsl {

using typed::ExprPtr;
using typed::StmtPtr;

template <typename T>
static std::unique_ptr<T> makeStmt(const ast::Stmt &source) {
  auto stmt = std::make_unique<T>();
  stmt->range = source.range;
  stmt->comment = source.comment;
  return stmt;
}

FunctionChecker::FunctionChecker(Program &program, const ClassScope *scope,
                                 typed::Function *function)
    : program(program), diagnostics(program.diagnostics), types(program.types), scope(scope),
      function(function) {
  if (!function)
    return;
  facts = &program.facts[function];
  if (!scope || !scope->root)
    return;
  if (function->isConstructor)
    rules = &constructorModel();
  else if (function->isStateMethod)
    rules = scope->root->method(function->name, !function->parameters.empty());
}

void FunctionChecker::checkBody(const ast::FunctionDecl &declaration) {
  const std::size_t errorsBefore = diagnostics.errorCount();
  // Parameters and body are one scope (GLSL 4.60, 4.2.2).
  locals.push();
  for (const std::unique_ptr<typed::Variable> &parameter : function->parameters) {
    if (parameter->name.empty())
      continue;
    if (const typed::Variable *other = locals.declare(parameter.get()))
      diagnostics.report(Code::redefinition, parameter->range, parameter->name)
          .label(other->range, "first defined here");
  }
  for (const std::unique_ptr<typed::Variable> &parameter : function->parameters)
    checkLocalSize(*parameter);
  function->body = checkCompound(*declaration.body, false);
  locals.pop();
  if (diagnostics.errorCount() != errorsBefore)
    return;
  for (const std::unique_ptr<typed::Variable> &local : function->locals)
    if (!mentioned.count(local.get()) && !local->type->isError())
      diagnostics.report(Code::unusedVariable, local->range, local->name);
}

StmtPtr FunctionChecker::checkStmt(const ast::Stmt &stmt) {
  if (recursion >= maxRecursion) {
    diagnostics.report(Code::statementTooDeep, stmt.range, maxRecursion);
    return makeStmt<typed::CompoundStmt>(stmt);
  }
  ++recursion;
  StmtPtr result = dispatchStmt(stmt);
  --recursion;
  return result;
}

/// A statement that is a scope of its own.
StmtPtr FunctionChecker::checkScoped(const ast::Stmt &stmt) {
  locals.push();
  StmtPtr result = checkStmt(stmt);
  locals.pop();
  return result;
}

StmtPtr FunctionChecker::dispatchStmt(const ast::Stmt &stmt) {
  switch (stmt.kind) {
  case ast::StmtKind::Compound:
    return checkCompound(cast<ast::CompoundStmt>(stmt), true);
  case ast::StmtKind::Declaration:
    return checkDeclaration(cast<ast::DeclarationStmt>(stmt));
  case ast::StmtKind::Expression: {
    auto node = makeStmt<typed::ExpressionStmt>(stmt);
    node->expr = checkOperand(*cast<ast::ExpressionStmt>(stmt).expr);
    const typed::ExprKind kind = node->expr->kind;
    const bool hasEffect = kind == typed::ExprKind::Assign || kind == typed::ExprKind::IncDec ||
                           kind == typed::ExprKind::Call || kind == typed::ExprKind::MethodCall ||
                           kind == typed::ExprKind::Builtin || kind == typed::ExprKind::Comma ||
                           kind == typed::ExprKind::Conditional;
    if (!hasEffect && !node->expr->type->isError())
      diagnostics.report(Code::noEffect, node->expr->range);
    return node;
  }
  case ast::StmtKind::If:
    return checkIf(cast<ast::IfStmt>(stmt));
  case ast::StmtKind::For:
    return checkFor(cast<ast::ForStmt>(stmt));
  case ast::StmtKind::While: {
    const auto &loop = cast<ast::WhileStmt>(stmt);
    auto node = makeStmt<typed::WhileStmt>(stmt);
    node->condition = checkCondition(*loop.condition);
    ++loops;
    node->body = checkScoped(*loop.body);
    --loops;
    return node;
  }
  case ast::StmtKind::DoWhile: {
    const auto &loop = cast<ast::DoWhileStmt>(stmt);
    auto node = makeStmt<typed::DoWhileStmt>(stmt);
    ++loops;
    node->body = checkScoped(*loop.body);
    --loops;
    node->condition = checkCondition(*loop.condition);
    return node;
  }
  case ast::StmtKind::Switch:
    return checkSwitch(cast<ast::SwitchStmt>(stmt));
  case ast::StmtKind::Case: // direct labels are handled by the switch; in a nested
                            // block they are not allowed
    diagnostics.report(Code::nestedCase, stmt.range);
    return makeStmt<typed::CompoundStmt>(stmt);
  case ast::StmtKind::Break:
  case ast::StmtKind::Continue:
    return checkJump(stmt);
  case ast::StmtKind::Return:
    return checkReturn(cast<ast::ReturnStmt>(stmt));
  case ast::StmtKind::Illuminance:
    return checkIlluminance(cast<ast::IlluminanceStmt>(stmt));
  case ast::StmtKind::Empty:
    break;
  }
  return makeStmt<typed::CompoundStmt>(stmt);
}

StmtPtr FunctionChecker::checkCompound(const ast::CompoundStmt &stmt, bool ownScope) {
  auto node = makeStmt<typed::CompoundStmt>(stmt);
  if (ownScope)
    locals.push();
  for (const ast::StmtPtr &inner : stmt.body)
    if (inner->kind != ast::StmtKind::Empty)
      node->body.push_back(checkStmt(*inner));
  if (ownScope)
    locals.pop();
  return node;
}

//===----------------------------------------------------------------------===//
// Declarations
//===----------------------------------------------------------------------===//

StmtPtr FunctionChecker::checkDeclaration(const ast::DeclarationStmt &stmt) {
  auto node = makeStmt<typed::DeclarationStmt>(stmt);
  for (const ast::VariableDecl &declaration : stmt.variables)
    if (const typed::Variable *variable = checkVariable(declaration))
      node->variables.push_back(variable);
  return node;
}

/// `auto x = value;`
bool FunctionChecker::isDeduced(const ast::VariableDecl &declaration) const {
  const std::string &type = declaration.type.name.text;
  return (type == "auto" || type == "let" || type == "var") && declaration.init &&
         declaration.init->kind != ast::ExprKind::InitializerList &&
         declaration.type.dimensions.empty() &&
         !program.findSymbol(type, declaration.type.name.range);
}

/// The type can be deduced, and is suggested as a fix.
const Type *FunctionChecker::reportDeduced(const ast::VariableDecl &declaration, ExprPtr &init) {
  init = checkValue(*declaration.init);
  const ast::Name &name = declaration.type.name;
  Diagnostic &diagnostic = diagnostics.report(Code::unknownType, name.range, name.text);
  if (!init->type->isError() && !init->type->is(TypeKind::Void))
    diagnostic.fix(name.range, toString(init->type), true);
  return init->type->is(TypeKind::Void) ? types.error : init->type;
}

const typed::Variable *FunctionChecker::checkVariable(const ast::VariableDecl &declaration) {
  auto owned = std::make_unique<typed::Variable>();
  typed::Variable &variable = *owned;
  variable.name = declaration.name.text;
  variable.range = declaration.name.range;
  variable.comment = declaration.comment;
  variable.isConst = declaration.isConst;
  if (declaration.access != ast::Access::None)
    diagnostics.report(Code::accessOnLocal, declaration.accessRange,
                       sourceText(declaration.accessRange));

  const bool unsized =
      std::any_of(declaration.type.dimensions.begin(), declaration.type.dimensions.end(),
                  [](const ast::ArrayDimension &dimension) { return !dimension.size; });
  if (unsized) {
    variable.type = deduceUnsized(declaration, variable.init);
  } else if (isDeduced(declaration)) {
    variable.type = reportDeduced(declaration, variable.init);
  } else {
    variable.type = resolveType(declaration.type, &declaration.name);
    if (variable.type->is(TypeKind::Void)) {
      diagnostics.report(Code::voidVariable, declaration.type.range, variable.name);
      variable.type = types.error;
    }
    // The name is not visible in its own initialiser.
    if (declaration.init)
      variable.init = checkInitializer(*declaration.init, variable.type);
  }
  if (variable.isConst && !declaration.init) {
    diagnostics.report(Code::constNeedsValue, variable.range, variable.name);
    variable.type = types.error;
  }
  if (variable.isConst && variable.init && !variable.type->isError())
    if (std::optional<typed::Constant> value = evaluate(*variable.init))
      variable.constant = std::make_unique<typed::Constant>(std::move(*value));
  if (variable.name.compare(0, 3, "rt_") == 0 && !variable.type->isError())
    diagnostics.report(Code::reservedName, variable.range, variable.name);
  checkLocalSize(variable);
  if (const typed::Variable *other = locals.declare(&variable); other && !variable.type->isError())
    diagnostics.report(Code::redefinition, variable.range, variable.name)
        .label(other->range, "first defined here");
  function->locals.push_back(std::move(owned));
  return &variable;
}

void FunctionChecker::checkLocalSize(const typed::Variable &variable) {
  if (variable.type->isError())
    return;
  const std::uint64_t bytes = sizeInBytes(variable.type);
  if (bytes > maxLocalBytes)
    diagnostics.report(Code::localTooLarge, variable.range, variable.name, bytes, maxLocalBytes)
        .note("every ray has its own locals; put shared data into a buffer: `public "
              "float data[];`");
  else if (bytes > largeLocalBytes)
    diagnostics.report(Code::localLarge, variable.range, variable.name, bytes)
        .note("every ray has its own copy; on a GPU many thousands run at once");
}

//===----------------------------------------------------------------------===//
// Control flow
//===----------------------------------------------------------------------===//

/// `else if` chains may be long: they are processed in a loop.
StmtPtr FunctionChecker::checkIf(const ast::IfStmt &stmt) {
  auto first = makeStmt<typed::IfStmt>(stmt);
  typed::IfStmt *node = first.get();
  unsigned length = 0;
  for (const ast::IfStmt *at = &stmt;;) {
    if (++length > maxRecursion) {
      diagnostics.report(Code::statementTooDeep, at->range, maxRecursion);
      return first;
    }
    node->condition = checkCondition(*at->condition);
    node->thenStmt = checkScoped(*at->thenStmt);
    const ast::IfStmt *next = dynCast<ast::IfStmt>(at->elseStmt);
    if (!next) {
      if (at->elseStmt)
        node->elseStmt = checkScoped(*at->elseStmt);
      return first;
    }
    auto inner = makeStmt<typed::IfStmt>(*next);
    typed::IfStmt *innerNode = inner.get();
    node->elseStmt = std::move(inner);
    node = innerNode;
    at = next;
  }
}

StmtPtr FunctionChecker::checkFor(const ast::ForStmt &stmt) {
  auto node = makeStmt<typed::ForStmt>(stmt);
  locals.push();
  if (stmt.init && stmt.init->kind != ast::StmtKind::Empty)
    node->init = checkStmt(*stmt.init);
  if (stmt.condition)
    node->condition = checkCondition(*stmt.condition);
  if (stmt.step)
    node->step = checkOperand(*stmt.step);
  ++loops;
  // The body is in the scope of the loop's variables (GLSL 4.60, 4.2.2).
  node->body = stmt.body->kind == ast::StmtKind::Compound
                   ? checkCompound(cast<ast::CompoundStmt>(*stmt.body), false)
                   : checkStmt(*stmt.body);
  --loops;
  locals.pop();
  return node;
}

StmtPtr FunctionChecker::checkSwitch(const ast::SwitchStmt &stmt) {
  auto node = makeStmt<typed::SwitchStmt>(stmt);
  node->value = checkValue(*stmt.value);
  const Type *type = node->value->type;
  if (!type->isError() && !type->is(TypeKind::Int) && !type->is(TypeKind::UInt)) {
    diagnostics.report(Code::switchNotInteger, node->value->range, toString(type));
    type = types.error;
  }
  std::unordered_map<std::int64_t, SourceRange> seen;
  SourceRange defaultRange;
  bool open = false; // there is a label without a statement after it yet
  ++switches;
  locals.push();
  for (const ast::StmtPtr &inner : stmt.body) {
    if (inner->kind == ast::StmtKind::Empty)
      continue;
    const auto *label = dynCast<ast::CaseStmt>(inner);
    if (!label) {
      if (node->arms.empty()) {
        diagnostics.report(Code::statementBeforeCase, inner->range);
        checkStmt(*inner);
        continue;
      }
      node->arms.back().body.push_back(checkStmt(*inner));
      open = false;
      continue;
    }
    if (!open) {
      node->arms.emplace_back();
      node->arms.back().range = label->range;
      open = true;
    }
    typed::SwitchStmt::Arm &arm = node->arms.back();
    if (!label->value) {
      if (defaultRange.isValid())
        diagnostics.report(Code::duplicateDefault, label->range).label(defaultRange, "first here");
      defaultRange = label->range;
      arm.isDefault = true;
      continue;
    }
    ExprPtr value = coerce(checkValue(*label->value), type);
    if (value->type->isError())
      continue;
    const typed::Expr *obstacle = nullptr;
    const std::optional<std::int64_t> number = evaluateInteger(*value, &obstacle);
    if (!number) {
      diagnostics.report(Code::notConstant, obstacle ? obstacle->range : value->range,
                         "a case label");
      continue;
    }
    if (auto [other, fresh] = seen.emplace(*number, value->range); !fresh) {
      diagnostics.report(Code::duplicateCase, value->range, *number)
          .label(other->second, "first here");
      continue;
    }
    arm.values.push_back(*number);
  }
  locals.pop();
  --switches;
  if (open)
    diagnostics.report(Code::emptyLastCase, node->arms.back().range)
        .note("write `break;` after the label");
  return node;
}

StmtPtr FunctionChecker::checkJump(const ast::Stmt &stmt) {
  if (stmt.kind == ast::StmtKind::Break) {
    if (loops + switches + illuminances == 0)
      diagnostics.report(Code::misplacedBreak, stmt.range);
    return makeStmt<typed::BreakStmt>(stmt);
  }
  if (loops + illuminances == 0)
    diagnostics.report(Code::misplacedContinue, stmt.range);
  return makeStmt<typed::ContinueStmt>(stmt);
}

StmtPtr FunctionChecker::checkReturn(const ast::ReturnStmt &stmt) {
  auto node = makeStmt<typed::ReturnStmt>(stmt);
  const Type *wanted = function->returnType;
  if (!stmt.value) {
    if (!wanted->is(TypeKind::Void) && !wanted->isError())
      diagnostics.report(Code::returnNeedsValue, stmt.range, function->name, toString(wanted))
          .label(function->range, "declared here");
    return node;
  }
  ExprPtr value = checkExpr(*stmt.value);
  if (wanted->is(TypeKind::Void)) {
    if (!value->type->isError())
      diagnostics.report(Code::returnFromVoid, value->range, function->name)
          .label(function->range, "declared here");
    return node;
  }
  value = requireValue(std::move(value));
  node->value =
      coerce(std::move(value), wanted,
             Label{function->range, "`" + function->name + "` returns `" + toString(wanted) + "`"});
  return node;
}

/// `illuminance (P [, N, angle]) statement`.
StmtPtr FunctionChecker::checkIlluminance(const ast::IlluminanceStmt &stmt) {
  auto node = makeStmt<typed::IlluminanceStmt>(stmt);
  SourceRange keyword = stmt.range;
  keyword.end = keyword.begin + static_cast<std::uint32_t>(std::string("illuminance").size());
  recordSpecial(Ability::Illuminance, "illuminance", keyword);
  if (illuminances != 0)
    diagnostics.report(Code::nestedIlluminance, keyword)
        .note("the inner loop would overwrite the light of the outer one");
  const Type *vec3 = types.vector(types.floatType, 3);
  const Type *const wanted[] = {vec3, vec3, types.floatType};
  ExprPtr *const places[] = {&node->point, &node->normal, &node->angle};
  if (stmt.args.size() != 1 && stmt.args.size() != 3)
    diagnostics.report(Code::badIlluminance, keyword, stmt.args.size())
        .note("`illuminance (P) statement` or `illuminance (P, N, angle) statement`");
  for (std::size_t i = 0; i != stmt.args.size(); ++i) {
    ExprPtr value = checkValue(*stmt.args[i]);
    if (i < 3)
      *places[i] = coerce(std::move(value), wanted[i]);
  }
  ++illuminances;
  node->body = checkScoped(*stmt.body);
  --illuminances;
  return node;
}

} // namespace rtsl
