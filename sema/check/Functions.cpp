//===- Functions.cpp - the functions of classes and files -----------------===//
#include "sema/check/FunctionChecker.h"

#include <algorithm>

namespace rtsl {

void Program::declareFunctions() {
  for (ClassScope *scope : baseFirst)
    declareMethods(*scope);
  for (const ast::TranslationUnit *unit : units)
    for (const ast::FunctionDecl &declaration : unit->functions)
      declareFreeFunction(declaration);
}

void Program::checkBodies() {
  // A prototype without a body. It is kept, with an empty body: calls refer to it.
  for (const std::unique_ptr<typed::Function> &function : module.functions)
    if (prototypes.count(function.get())) {
      diagnostics.report(Code::prototypeWithoutBody, function->range, function->name);
      function->body = std::make_unique<typed::CompoundStmt>();
    }
  for (const PendingBody &body : bodies) {
    const std::size_t before = diagnostics.errorCount();
    FunctionChecker(*this, body.scope, body.function).checkBody(*body.declaration);
    // Flow warnings for a function with errors would be misleading.
    if (diagnostics.errorCount() == before)
      checkFlow(*body.function, diagnostics);
  }
}

std::unique_ptr<typed::Function> Program::declareFunction(const ast::FunctionDecl &declaration,
                                                          const ClassScope *scope) {
  FunctionChecker checker(*this, scope, nullptr);
  auto function = std::make_unique<typed::Function>();
  function->name = declaration.name.text;
  function->range = declaration.name.range;
  function->comment = declaration.comment;
  function->owner = scope ? scope->definition : nullptr;
  function->returnType = checker.resolveType(declaration.returnType, nullptr);
  for (const ast::VariableDecl &source : declaration.parameters) {
    auto parameter = std::make_unique<typed::Variable>();
    parameter->kind = typed::Variable::Kind::Parameter;
    parameter->name = source.name.text;
    parameter->range = source.name.text.empty() ? source.range : source.name.range;
    parameter->comment = source.comment;
    parameter->isConst = source.isConst;
    parameter->direction = source.direction;
    parameter->type = checker.resolveType(source.type, &source.name);
    if (parameter->type->is(TypeKind::Void)) {
      if (declaration.parameters.size() == 1 && source.name.text.empty())
        break; // `f(void)`
      diagnostics.report(Code::voidVariable, source.type.range, parameter->name);
      parameter->type = types.error;
    }
    if (source.values.isGiven() && !(scope && function->name == "constructor"))
      diagnostics.report(Code::misplacedRange, source.values.range,
                         "of functions, only constructors have parameters that the scene sets");
    else
      parameter->values = rangeOf(checker, source.values, parameter->type);
    if (source.init)
      diagnostics.report(Code::parameterDefault, source.init->range, parameter->name)
          .note("write a second function with fewer parameters");
    if (parameter->isConst && parameter->direction != ast::Direction::In) {
      diagnostics.report(Code::constOutParameter, source.range, parameter->name);
      parameter->isConst = false;
    }
    if (parameter->name.compare(0, 3, "rt_") == 0)
      diagnostics.report(Code::reservedName, parameter->range, parameter->name);
    function->parameters.push_back(std::move(parameter));
  }
  return function;
}

//===----------------------------------------------------------------------===//
// Methods
//===----------------------------------------------------------------------===//

/// Is this a method by which an object lights others, as an rt_Light would?
static bool isOfSurfaceThatShines(const std::string &method) {
  return method == "generateSample" || method == "samplePDF" || method == "emission";
}

void Program::declareMethods(ClassScope &scope) {
  for (const ast::FunctionDecl &declaration : scope.declaration->functions) {
    std::unique_ptr<typed::Function> owned = declareFunction(declaration, &scope);
    typed::Function *function = owned.get();
    const std::string &name = function->name;
    function->isConstructor = name == "constructor";
    const bool inTable = scope.root && scope.root->method(name);
    function->isStateMethod = inTable;
    if (function->isConstructor || inTable) {
      checkTableMethod(scope, declaration, *function);
    } else if (const std::vector<std::string> owners = classesWithMethod(name);
               scope.root && !owners.empty()) {
      foreignMethods.insert(function);
      Diagnostic &diagnostic = diagnostics.report(Code::foreignMethod, function->range, name,
                                                  joinWords(owners), withArticle(scope.root->name));
      std::vector<std::string> methods;
      for (const MethodModel &method : scope.root->methods)
        if (std::find(methods.begin(), methods.end(), "`" + method.name + "`") == methods.end())
          methods.push_back("`" + method.name + "`");
      const SourceRange named = scope.declaration->name.range;
      if (!methods.empty())
        diagnostic.note(withArticle(scope.root->name) + " has " + joinWords(methods));
      if (scope.root->name == "rt_Light" && isOfSurfaceThatShines(name))
        diagnostic.note(
            "a light source with an area is an object whose material has `emission`: a mesh, or "
            "an rt_Primitive with `generateSample` and `samplePDF`");
      else if (owners.size() == 1 && !scope.base)
        diagnostic.fix({named.file, named.end, named.end}, " : " + owners.front());
    }
    if (const typed::Member *member = findMember(&scope, name))
      diagnostics.report(Code::redefinition, function->range, name)
          .label(member->range, "first defined here");

    std::vector<typed::Function *> &overloads = scope.functions[name];
    const typed::Function *twin = nullptr;
    for (const typed::Function *other : overloads)
      if (function->isConstructor || sameParameters(*other, *function))
        twin = other;
    if (twin) {
      diagnostics
          .report(function->isConstructor ? Code::secondConstructor : Code::duplicateFunction,
                  function->range, name)
          .label(twin->range, "first defined here");
      continue;
    }
    if (!function->isConstructor)
      checkOverride(scope, *function);
    overloads.push_back(function);
    scope.definition->functions.push_back(std::move(owned));
    if (declaration.body) {
      bodies.push_back({&declaration, function, &scope});
    } else {
      function->isRequired = true;
      function->body = std::make_unique<typed::CompoundStmt>();
    }
  }
}

/// Engine methods must have the signature that the engine expects.
void Program::checkTableMethod(const ClassScope &scope, const ast::FunctionDecl &declaration,
                               typed::Function &function) {
  if (function.returnType->isError())
    return;
  const std::vector<std::unique_ptr<typed::Variable>> &parameters = function.parameters;
  const bool payload =
      parameters.size() == 1 && parameters[0]->direction == ast::Direction::InOut &&
      (parameters[0]->type->is(TypeKind::Struct) || parameters[0]->type->isError());
  bool fits = function.returnType->is(TypeKind::Void);
  std::string expected;
  if (function.isConstructor) {
    expected = "`void constructor(...)` with `in` parameters";
    for (const std::unique_ptr<typed::Variable> &parameter : parameters)
      fits &= parameter->direction == ast::Direction::In;
  } else {
    bool shapeFits = false;
    std::vector<std::string> shapes;
    for (const MethodModel &method : scope.root->methods) {
      if (method.name != function.name)
        continue;
      shapes.push_back("`" + method.signature() + "`");
      shapeFits |= method.payload == MethodModel::Payload::Required ? payload : parameters.empty();
    }
    fits &= shapeFits;
    expected = joinWords(shapes, "or");
    if (scope.root->methods.size() > 1 && expected.find("inout P") != std::string::npos)
      expected += ", where P is a struct, the payload of the ray";
  }
  if (fits)
    return;
  Diagnostic &diagnostic =
      diagnostics.report(Code::badMethodSignature, function.range, function.name,
                         function.isConstructor ? "every class" : withArticle(scope.root->name));
  diagnostic.note("expected " + expected);
  if (function.name == "anyHit" && parameters.empty())
    diagnostic.note(
        "shadow rays of `illuminance` carry no payload, and no material handles them: "
        "call `illuminate(i, P, false)`, and trace a ray with a payload towards the light");
}

/// An overriding function must have the same signature as that of the base.
void Program::checkOverride(const ClassScope &scope, const typed::Function &function) {
  if (methodNames[function.name] < 2)
    return;
  for (const typed::Function *other : findMethods(scope.base, function.name)) {
    if (!sameParameters(*other, function))
      continue;
    bool same = other->returnType == function.returnType;
    for (std::size_t i = 0; i != function.parameters.size(); ++i)
      same &= other->parameters[i]->direction == function.parameters[i]->direction;
    if (!same && !other->returnType->isError() && !function.returnType->isError())
      diagnostics.report(Code::overrideDiffers, function.range, function.name)
          .label(other->range, "this function of `" + other->owner->name + "` is overridden");
  }
}

//===----------------------------------------------------------------------===//
// Free functions
//===----------------------------------------------------------------------===//

void Program::declareFreeFunction(const ast::FunctionDecl &declaration) {
  if (!declareSymbol(declaration.name, Symbol::Kind::Function))
    return;
  std::unique_ptr<typed::Function> owned = declareFunction(declaration, nullptr);
  std::vector<typed::Function *> &overloads = functions[declaration.name.text];
  for (typed::Function *other : overloads) {
    if (!sameParameters(*other, *owned))
      continue;
    bool same = other->returnType == owned->returnType;
    for (std::size_t i = 0; i != owned->parameters.size(); ++i)
      same &= other->parameters[i]->direction == owned->parameters[i]->direction;
    if (!same) {
      diagnostics.report(Code::prototypeDiffers, owned->range, owned->name)
          .label(other->range, "declared differently here");
      prototypes.erase(other);
      return;
    }
    if (!declaration.body)
      return; // a prototype after the definition adds nothing
    if (!prototypes.count(other)) {
      diagnostics.report(Code::duplicateFunction, owned->range, owned->name)
          .label(other->range, "first defined here");
      return;
    }
    prototypes.erase(other);
    other->parameters = std::move(owned->parameters); // the names are those of the definition
    other->range = owned->range;
    other->comment = owned->comment;
    bodies.push_back({&declaration, other, nullptr});
    return;
  }
  typed::Function *function = owned.get();
  overloads.push_back(function);
  module.functions.push_back(std::move(owned));
  if (declaration.body)
    bodies.push_back({&declaration, function, nullptr});
  else
    prototypes.insert(function);
}

} // namespace rtsl
