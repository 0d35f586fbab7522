//===- AstDeclarations.cpp - parse tree to syntax tree: declarations ------===//
#include "frontend/syntax/AstBuilder.h"

#include <algorithm>

namespace rtsl {

using namespace ast;

void AstBuilder::addItem(Parser::FileItemContext *item) {
  // A broken class head may be followed by members.
  for (const antlr4::tree::ParseTree *child : item->children)
    if (auto *part = dynamic_cast<const antlr4::ParserRuleContext *>(child))
      hasBrokenItem |= part->exception != nullptr;
  if (auto *import = item->importDeclaration()) {
    addImport(import);
  } else if (auto *declared = item->structDeclaration()) {
    addStruct(declared);
  } else if (auto *declared = item->classDeclaration()) {
    addClass(declared);
  } else if (auto *declaration = item->declaration()) {
    if (hasFileClass) {
      ClassDecl &owner = unit->classes.back();
      addDeclaration(declaration, placeIn(owner), owner.members, &owner.functions);
      owner.range.end = range(declaration).end;
    } else {
      addDeclaration(declaration, Place::File, unit->constants, &unit->functions);
    }
  }
}

/// Reports what follows `class Name : Base;` and cannot be a member: all that follows it belongs to
/// the class.
void AstBuilder::checkFollowsFileClass(SourceRange where, const char *what) {
  if (!hasFileClass)
    return;
  const ClassDecl &owner = unit->classes.back();
  diagnostics.report(Code::fileFormNotAlone, where, owner.name.text, owner.base.text, what)
      .label(owner.name.range, "begins here")
      .note(fmt::format("a file of several declarations is written `class {} : {} {{ ... }};`",
                        owner.name.text, owner.base.text));
}

void AstBuilder::addImport(Parser::ImportDeclarationContext *context) {
  checkFollowsFileClass(range(context->IMPORT()), "an import");
  ImportDecl import;
  import.range = range(context);
  if (auto *path = context->modulePath()) {
    if (path->exception)
      return;
    for (auto *part : path->IDENTIFIER())
      import.path += (import.path.empty() ? "" : ".") + text(range(part));
  } else if (auto *quoted = context->STRING_LITERAL()) {
    const SourceRange where = range(quoted);
    if (tokens[quoted->getSymbol()->getTokenIndex()].isBroken)
      return;
    import.path = text({file, where.begin + 1, where.end - 1});
    import.isFile = true;
  } else {
    return;
  }
  unit->imports.push_back(std::move(import));
}

void AstBuilder::addStruct(Parser::StructDeclarationContext *context) {
  checkFollowsFileClass(range(context->STRUCT()), "a struct");
  if (!context->IDENTIFIER())
    return;
  StructDecl declared;
  declared.comment = commentAbove(context);
  declared.name = name(context->IDENTIFIER());
  declared.range = range(context);
  for (auto *field : context->declaration())
    addDeclaration(field, Place::Field, declared.fields, nullptr);
  unit->structs.push_back(std::move(declared));
}

void AstBuilder::addClass(Parser::ClassDeclarationContext *context) {
  if (!context->CLASS()) { // `default`, and something else
    hasBrokenItem = true;  // members may follow
    return;
  }
  checkFollowsFileClass(range(context->CLASS()), "a class");
  const auto names = context->IDENTIFIER();
  const bool isHelper = !context->COLON();
  if (names.size() < (isHelper ? 1 : 2))
    return;
  if (isHelper && !context->LEFT_BRACE()) {
    hasBrokenItem = true; // its members may follow
    if (!context->exception)
      diagnostics
          .report(Code::classWithoutBase, SourceRange(range(context->CLASS())).to(range(names[0])),
                  text(range(names[0])))
          .note(
              fmt::format("`class {0} : rt_Material;`, or `class {0} {{ ... }};` for a class that "
                          "others refer to and the engine does not use",
                          text(range(names[0]))));
    return;
  }
  ClassDecl declared;
  declared.comment = commentAbove(context);
  declared.name = name(names[0]);
  if (!isHelper)
    declared.base = name(names[1]);
  declared.fileForm = !context->LEFT_BRACE();
  if (context->DEFAULT())
    declared.defaultRange = range(context->DEFAULT());
  declared.range = range(context);
  for (auto *member : context->declaration())
    addDeclaration(member, placeIn(declared), declared.members, &declared.functions);
  hasFileClass |= declared.fileForm;
  unit->classes.push_back(std::move(declared));
}

//===----------------------------------------------------------------------===//
// Qualifiers
//===----------------------------------------------------------------------===//

/// The range of a qualifier, including the space after it.
SourceRange AstBuilder::removal(SourceRange where) const {
  const std::string_view source = sources.text(file);
  std::uint32_t end = where.end;
  while (end < source.size() && source[end] == ' ')
    ++end;
  return {file, where.begin, end};
}

void AstBuilder::refuseQualifier(SourceRange where, const std::string &reason) {
  diagnostics.report(Code::misplacedQualifier, where, sources.text(where), reason)
      .fix(removal(where), "");
}

/// Reports a qualifier that makes no sense without a class, of a variable at file scope: without
/// the qualifier, it would be as wrong.
void AstBuilder::refuseVariable(SourceRange where, const std::string &reason) {
  diagnostics.report(Code::misplacedQualifier, where, sources.text(where), reason)
      .note("a variable must be a member of a class, or local to a function");
}

/// Reports a qualifier of another language. `replacement` is that of RTSL for such a declaration;
/// empty: it needs none.
void AstBuilder::refuseForeign(SourceRange where, const char *replacement) {
  Diagnostic &diagnostic = diagnostics.report(Code::foreignQualifier, where, sources.text(where));
  if (*replacement)
    diagnostic.fix(where, replacement);
  else
    diagnostic.fix(removal(where), "");
}

/// Reads qualifiers; reports those that are not allowed at `place` and that the next stage could
/// not see.
Qualifiers AstBuilder::buildQualifiers(const std::vector<Parser::QualifierContext *> &contexts,
                                       Place place) {
  const auto isForeign = [&](const Parser::QualifierContext *context) {
    return tokens[context->start->getTokenIndex()].isForeign;
  };
  const auto isAccess = [](std::size_t type) {
    return type == Parser::PUBLIC || type == Parser::PRIVATE || type == Parser::SCRATCH;
  };
  const auto has = [&](const auto &isOne) {
    return std::any_of(contexts.begin(), contexts.end(), isOne);
  };
  const bool isConst = has([](const auto *one) { return one->start->getType() == Parser::CONST; });
  const bool hasConst = has(
      [&](const auto *one) { return one->start->getType() == Parser::CONST && !isForeign(one); });
  const bool hasAccess =
      has([&](const auto *one) { return isAccess(one->start->getType()) && !isForeign(one); });
  const bool isBrokenMember = place == Place::File && hasBrokenItem;
  // Neither a constant nor a member: whatever else is wrong, it cannot be there.
  const bool isVariableOfFile = place == Place::File && !hasBrokenItem && !isConst;
  const auto refuse = [&](SourceRange where, const std::string &reason) {
    if (isVariableOfFile)
      refuseVariable(where, reason);
    else
      refuseQualifier(where, reason);
  };
  Qualifiers result;
  SourceRange direction; // the first one; not valid: absent
  for (auto *context : contexts) {
    const SourceRange where = range(context);
    const auto isSecond = [&](SourceRange first) {
      if (first.isValid())
        diagnostics.report(Code::repeatedQualifier, where, sources.text(where), sources.text(first))
            .label(first, "the first one");
      return first.isValid();
    };
    switch (const std::size_t type = context->start->getType()) {
    case Parser::CONST:
      if (isForeign(context)) {
        const bool isNeeded = place != Place::Field && !hasConst && !result.isConst;
        refuseForeign(where, isNeeded ? "const" : "");
        result.isConst |= isNeeded;
        break;
      }
      if (isSecond(result.constRange))
        break;
      result.constRange = where;
      if (place == Place::Field)
        refuseQualifier(where, "the fields of a struct have no qualifiers");
      else
        result.isConst = true;
      break;
    case Parser::OPTIONAL:
      if (isSecond(result.optionalRange))
        break;
      if (place == Place::Member || place == Place::File)
        result.optionalRange = where;
      if (place != Place::Member)
        refuse(where, "it is for members of classes");
      break;
    case Parser::IN:
    case Parser::OUT:
    case Parser::INOUT:
      if (isSecond(direction))
        break;
      direction = where;
      if (place != Place::Member || type != Parser::IN)
        result.directionRange = where;
      if (place != Place::Parameter && (place != Place::Member || type == Parser::IN))
        refuse(where, type == Parser::IN ? "it is for parameters"
                                         : "it is for parameters and output buffers");
      else
        result.direction = type == Parser::OUT     ? Direction::Out
                           : type == Parser::INOUT ? Direction::InOut
                                                   : Direction::In;
      break;
    default: // access
      if (isForeign(context) && isVariableOfFile) {
        diagnostics.report(Code::foreignQualifier, where, sources.text(where))
            .note(type == Parser::PUBLIC
                      ? "what a scene sets is a `public` member of a class"
                      : "what `intersect` passes on is a `scratch` member of a class");
        result.accessRange = where;
        break;
      }
      if (isForeign(context)) {
        const bool isMissing = (place == Place::Member || isBrokenMember) && !isConst &&
                               !hasAccess && !result.accessRange.isValid();
        refuseForeign(where, !isMissing ? "" : type == Parser::PUBLIC ? "public" : "scratch");
        if (!isMissing)
          break;
      } else if (isSecond(result.accessRange)) {
        break;
      }
      result.accessRange = where;
      if (place == Place::Member || place == Place::Local)
        result.access = type == Parser::PUBLIC    ? Access::Public
                        : type == Parser::PRIVATE ? Access::Private
                                                  : Access::Scratch;
      else if (!isBrokenMember)
        refuse(where, "it is for members of classes");
    }
  }
  return result;
}

//===----------------------------------------------------------------------===//
// Variables
//===----------------------------------------------------------------------===//

void AstBuilder::addDimensions(const std::vector<Parser::DimensionContext *> &contexts,
                               std::vector<ArrayDimension> &dimensions) {
  for (auto *context : contexts) {
    ArrayDimension dimension;
    dimension.range = range(context);
    if (context->exception)
      dimension.size = error(dimension.range);
    else if (auto *size = context->expr())
      dimension.size = buildExpr(size);
    dimensions.push_back(std::move(dimension));
  }
}

TypeName AstBuilder::buildType(Parser::TypeNameContext *context,
                               const std::vector<Parser::DimensionContext *> &outer) {
  TypeName type;
  type.name = name(context->IDENTIFIER());
  type.range = range(context);
  addDimensions(outer, type.dimensions);
  addDimensions(context->dimension(), type.dimensions);
  return type;
}

/// The range of a member or parameter. Those of other variables are reported and left out.
ValueRange AstBuilder::buildRange(Parser::RangeContext *context, Place place) {
  ValueRange values;
  const auto bounds = context->expr();
  if (context->exception || bounds.size() != 2)
    return values;
  values.range = range(context);
  if (place != Place::Member && place != Place::Parameter) {
    diagnostics.report(Code::misplacedRange, values.range, "it is for public members of classes")
        .fix(values.range, "");
    return values;
  }
  values.low = buildExpr(bounds[0]);
  values.high = buildExpr(bounds[1]);
  values.includesLow = context->LEFT_BRACKET() != nullptr;
  values.includesHigh = context->RIGHT_BRACKET() != nullptr;
  values.lowBracket = range(values.includesLow ? context->LEFT_BRACKET() : context->LEFT_PAREN());
  values.highBracket =
      range(values.includesHigh ? context->RIGHT_BRACKET() : context->RIGHT_PAREN());
  return values;
}

void AstBuilder::addVariables(const antlr4::ParserRuleContext *context,
                              const std::vector<Parser::QualifierContext *> &qualifierContexts,
                              Parser::TypeNameContext *typeName,
                              const std::vector<Parser::DeclaratorContext *> &declarators,
                              Place place, std::vector<VariableDecl> &variables) {
  if (!typeName || typeName->exception)
    return;
  const Qualifiers qualifiers = buildQualifiers(qualifierContexts, place);
  const std::string comment = commentAbove(context);
  for (auto *declarator : declarators) {
    if (!declarator->IDENTIFIER())
      continue;
    const bool isFirst = declarator == declarators.front();
    VariableDecl variable;
    variable.comment = isFirst ? comment : std::string();
    variable.access = qualifiers.access;
    variable.accessRange = qualifiers.accessRange;
    variable.isConst = qualifiers.isConst;
    variable.optionalRange = qualifiers.optionalRange;
    variable.direction = qualifiers.direction;
    variable.directionRange = qualifiers.directionRange;
    variable.type = buildType(typeName, declarator->dimension());
    variable.name = name(declarator->IDENTIFIER());
    if (auto *values = declarator->range())
      variable.values = buildRange(values, place);
    if (auto *initializer = declarator->initializer())
      variable.init = buildInitializer(initializer);
    variable.range = range(declarator);
    if (isFirst)
      variable.range.begin = range(context).begin;
    variables.push_back(std::move(variable));
  }
}

VariableDecl AstBuilder::buildParameter(Parser::ParameterContext *context) {
  const Qualifiers qualifiers = buildQualifiers(context->qualifier(), Place::Parameter);
  VariableDecl parameter;
  parameter.isConst = qualifiers.isConst;
  parameter.direction = qualifiers.direction;
  parameter.type = buildType(context->typeName(), context->dimension());
  if (auto *identifier = context->IDENTIFIER())
    parameter.name = name(identifier);
  if (auto *values = context->range())
    parameter.values = buildRange(values, Place::Parameter);
  if (auto *initializer = context->initializer())
    parameter.init = buildInitializer(initializer);
  parameter.range = range(context);
  return parameter;
}

//===----------------------------------------------------------------------===//
// Functions
//===----------------------------------------------------------------------===//

/// Adds what a declaration declares. `functions` is null where none are allowed.
bool AstBuilder::addDeclaration(Parser::DeclarationContext *context, Place place,
                                std::vector<VariableDecl> &variables,
                                std::vector<FunctionDecl> *functions) {
  if (!context->typeName() || context->typeName()->exception)
    return false; // broken, or a stray semicolon
  if (!context->IDENTIFIER()) {
    addVariables(context, context->qualifier(), context->typeName(), context->declarator(),
                 place == Place::MemberOfDefault ? Place::Member : place, variables);
    return true;
  }
  if (!functions) {
    diagnostics.report(Code::unexpectedToken, range(context->IDENTIFIER()), "a field",
                       fmt::format("function `{}`", text(range(context->IDENTIFIER()))));
    return false;
  }
  addFunction(context, place, *functions);
  return true;
}

void AstBuilder::addFunction(Parser::DeclarationContext *context, Place place,
                             std::vector<FunctionDecl> &functions) {
  for (auto *qualifier : context->qualifier())
    refuseQualifier(range(qualifier), "functions have no qualifiers");
  FunctionDecl function;
  function.comment = commentAbove(context);
  function.returnType = buildType(context->typeName());
  function.name = name(context->IDENTIFIER());
  function.range = range(context);

  auto *parameters = context->parameters();
  if (!parameters)
    return;
  const auto list = parameters->parameter();
  for (auto *parameter : list)
    if (!parameter->exception && parameter->typeName())
      function.parameters.push_back(buildParameter(parameter));
  // `f(void)` is C for `f()`.
  if (function.parameters.size() == 1) {
    const VariableDecl &only = function.parameters.front();
    if (only.type.name.text == "void" && only.name.text.empty() && only.type.dimensions.empty())
      function.parameters.clear();
  }

  auto *body = context->functionBody();
  if (body && body->block()) {
    function.body = buildBlock(body->block());
  } else if (!body || body->exception || place == Place::Member) {
    const bool isPrototype = body && !body->exception;
    if (isPrototype)
      diagnostics.report(Code::missingFunctionBody, function.name.range, function.name.text);
    // Reported: a body that causes no further messages.
    auto result = std::make_unique<ReturnStmt>();
    result->range = function.name.range;
    result->value = error(function.name.range);
    function.body = std::make_unique<CompoundStmt>();
    function.body->range = function.name.range;
    function.body->body.push_back(std::move(result));
  }
  functions.push_back(std::move(function));
}

} // namespace rtsl
