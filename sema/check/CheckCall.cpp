//===- CheckCall.cpp - calls ----------------------------------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/check/Suggest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rtsl {

using typed::Builtin;
using typed::ExprPtr;

static Signature signatureOf(const typed::Function &function) {
  Signature signature;
  signature.result = function.returnType;
  for (const std::unique_ptr<typed::Variable> &parameter : function.parameters)
    signature.parameters.push_back({parameter->type, parameter->direction});
  return signature;
}

static bool anyBroken(const std::vector<ExprPtr> &args) {
  return std::any_of(args.begin(), args.end(),
                     [](const ExprPtr &arg) { return arg->type->isError(); });
}

/// Is this a public or private member of the method's own object, or a part of one?
static bool isOfMember(const typed::Expr &expr) {
  const typed::Expr *at = &expr;
  while (true) {
    switch (at->kind) {
    case typed::ExprKind::Member: // a scratch reference may be to any object
      return static_cast<const typed::MemberExpr *>(at)->member->access != ast::Access::Scratch;
    case typed::ExprKind::Field:
      at = static_cast<const typed::FieldExpr *>(at)->base.get();
      break;
    case typed::ExprKind::Index:
      at = static_cast<const typed::IndexExpr *>(at)->base.get();
      break;
    default:
      return false;
    }
  }
}

ExprPtr FunctionChecker::checkCall(const ast::CallExpr &expr) {
  if (!expr.base.text.empty())
    return checkBaseCall(expr);
  return expr.receiver ? checkReceiverCall(expr) : checkPlainCall(expr);
}

//===----------------------------------------------------------------------===//
// Finding the function
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkPlainCall(const ast::CallExpr &expr) {
  const std::string &name = expr.callee.text;
  auto notAFunction = [&](const char *what, SourceRange where) {
    Diagnostic &diagnostic = diagnostics.report(Code::notAFunction, expr.callee.range, name, what);
    diagnostic.label(where, "declared here");
    if (program.builtins.find(name))
      diagnostic.note("it hides the built-in function `" + name + "`");
    return errorExpr(expr.range);
  };
  if (const typed::Variable *variable = locals.find(name))
    return notAFunction(variable->kind == typed::Variable::Kind::Parameter ? "a parameter"
                                                                           : "a variable",
                        variable->range);
  if (scope) {
    if (const typed::Member *member = program.findMember(scope, name))
      return notAFunction("a member", member->range);
    const std::vector<const typed::Function *> methods = program.findMethods(scope, name);
    if (!methods.empty())
      return checkUserCall(expr, methods, nullptr);
  }
  if (!facts && program.namesFunction(scope, name, expr.callee.range)) {
    diagnostics.report(Code::useOutsideFunction, expr.callee.range, name);
    return errorExpr(expr.range);
  }
  if (const Type *type = types.named(name))
    return checkConstruct(type, expr.callee.range, expr.args, expr.range);
  if (const Symbol *symbol = program.findSymbol(name, expr.callee.range)) {
    if (symbol->kind == Symbol::Kind::Struct) {
      const typed::Struct *structure = program.structure(name, expr.callee.range);
      const Type *type = structure ? types.structure(structure) : types.error;
      return checkConstruct(type, expr.callee.range, expr.args, expr.range);
    }
    if (symbol->kind == Symbol::Kind::Class)
      return checkConstruct(types.reference(program.classes.at(name)->definition),
                            expr.callee.range, expr.args, expr.range);
    if (symbol->kind == Symbol::Kind::Constant)
      return notAFunction("a constant", symbol->range);
    return checkUserCall(expr, program.findFunctions(name, expr.callee.range), nullptr);
  }
  if (rootModel(name))
    return checkConstruct(types.reference(name), expr.callee.range, expr.args, expr.range);
  if (name == "print")
    return checkPrint(expr);
  if (name == "trace" && expr.args.size() > 2)
    return checkTracePayload(expr);
  if (const std::optional<Builtin> atomic = atomicNamed(name))
    return checkAtomic(expr, *atomic);
  if (const BuiltinOverloads *overloads = program.builtins.find(name))
    return checkBuiltinCall(expr, *overloads);
  reportUnknownFunction(expr.callee, expr.range);
  for (const ast::ExprPtr &arg : expr.args)
    checkExpr(*arg);
  return errorExpr(expr.range);
}

void FunctionChecker::reportUnknownFunction(const ast::Name &callee, SourceRange call) {
  Diagnostic &diagnostic = diagnostics.report(Code::unknownFunction, callee.range, callee.text);
  if (const ForeignSpelling *foreign = foreignSpelling(callee.text)) {
    suggestSpelling(diagnostic, *foreign, whyNotHere(foreign->replacement),
                    program.imports(foreign->module), callee.range, call);
    return;
  }
  if (program.suggestImport(diagnostic, callee.text))
    return;
  std::vector<std::string> candidates = whatMayStandHere(builtinNames());
  for (const auto &entry : program.functions)
    candidates.push_back(entry.first);
  for (const ClassScope *at = scope; at; at = at->base)
    for (const auto &entry : at->functions)
      candidates.push_back(entry.first);
  candidates.insert(candidates.end(), program.structOrder.begin(), program.structOrder.end());
  std::sort(candidates.begin(), candidates.end());
  if (const std::string closest = closestName(callee.text, candidates); !closest.empty())
    diagnostic.fix(callee.range, closest);
}

//===----------------------------------------------------------------------===//
// Arguments and the choice between overloads
//===----------------------------------------------------------------------===//

FunctionChecker::Access FunctionChecker::accessOf(const std::vector<Signature> &candidates,
                                                  std::size_t count, std::size_t index) {
  bool isRead = false, isWritten = false, isOnlyWritten = true;
  for (const Signature &candidate : candidates) {
    if (candidate.parameters.size() != count)
      continue;
    const ast::Direction direction = candidate.parameters[index].direction;
    (direction == ast::Direction::In ? isRead : isWritten) = true;
    isOnlyWritten &= direction == ast::Direction::Out;
  }
  if (isRead || !isWritten)
    return Access::Read;
  return isOnlyWritten ? Access::Write : Access::ReadWrite;
}

std::vector<ExprPtr> FunctionChecker::checkArguments(const std::vector<ast::ExprPtr> &args,
                                                     const std::vector<Signature> &candidates) {
  std::vector<ExprPtr> values;
  for (std::size_t i = 0; i != args.size(); ++i)
    values.push_back(checkValue(*args[i], accessOf(candidates, args.size(), i)));
  return values;
}

void FunctionChecker::checkWritten(const std::vector<ast::ExprPtr> &args,
                                   const std::vector<Signature> &candidates, int chosen,
                                   std::vector<ExprPtr> &values) {
  const Signature &signature = candidates[static_cast<std::size_t>(chosen)];
  for (std::size_t i = 0; i != args.size(); ++i)
    if (const Access access = accessOf({signature}, args.size(), i);
        access != Access::Read && accessOf(candidates, args.size(), i) == Access::Read)
      values[i] = checkValue(*args[i], access);
}

int FunctionChecker::choose(const ast::Name &callee, const std::vector<Signature> &candidates,
                            const std::vector<ExprPtr> &args,
                            const std::vector<SourceRange> &places, SourceRange range) {
  if (anyBroken(args))
    return -1;
  std::vector<const Type *> argTypes;
  for (const ExprPtr &arg : args)
    argTypes.push_back(arg->type);
  const Resolution resolution = resolveOverload(candidates, argTypes);
  if (resolution.chosen >= 0)
    return resolution.chosen;

  const bool ambiguous = !resolution.ties.empty();
  if (!ambiguous && candidates.size() == 1 && candidates[0].parameters.size() == args.size()) {
    // Only one function can be meant: report which argument is wrong.
    for (std::size_t i = 0; i != args.size(); ++i) {
      const Signature::Parameter &parameter = candidates[0].parameters[i];
      const Conversion conversion = implicitConversion(args[i]->type, parameter.type);
      if (conversion == Conversion::Exact ||
          (conversion == Conversion::Implicit && parameter.direction == ast::Direction::In))
        continue;
      Diagnostic &diagnostic =
          diagnostics.report(Code::badArgument, args[i]->range, i + 1, callee.text,
                             toString(parameter.type), toString(args[i]->type));
      if (!places.empty())
        diagnostic.label(places[0],
                         "`" + describe(callee.text, candidates[0]) + "` is defined here");
      if (parameter.direction == ast::Direction::In)
        explainConversion(diagnostic, *args[i], parameter.type);
      else
        diagnostic.note("an `out` or `inout` argument must have exactly the type of the parameter");
    }
    return -1;
  }

  Diagnostic &diagnostic = ambiguous ? diagnostics.report(Code::ambiguousCall, callee.range,
                                                          callee.text, describe(argTypes))
                                     : diagnostics.report(Code::noMatchingFunction, callee.range,
                                                          callee.text, describe(argTypes));
  std::vector<int> shown = resolution.ties;
  for (std::size_t i = 0; !ambiguous && i != candidates.size(); ++i)
    if (candidates[i].parameters.size() == args.size())
      shown.push_back(static_cast<int>(i));
  if (shown.empty()) // all of them
    for (std::size_t i = 0; i != candidates.size(); ++i)
      shown.push_back(static_cast<int>(i));
  constexpr std::size_t maxShown = 8;
  for (std::size_t i = 0; i != std::min(shown.size(), maxShown); ++i) {
    const auto candidate = static_cast<std::size_t>(shown[i]);
    const std::string text = "candidate: `" + describe(callee.text, candidates[candidate]) + "`";
    if (candidate < places.size())
      diagnostic.label(places[candidate], text);
    else
      diagnostic.note(text);
  }
  if (shown.size() > maxShown)
    diagnostic.note("and " + std::to_string(shown.size() - maxShown) + " more");
  if (std::any_of(argTypes.begin(), argTypes.end(),
                  [](const Type *type) { return type->is(TypeKind::Color); }) &&
      places.empty())
    diagnostic.note(fmt::format("the built-in functions for colors are `{}`",
                                fmt::join(colorFunctionNames(), "`, `")));
  return -1;
}

void FunctionChecker::convertArguments(const Signature &signature, std::vector<ExprPtr> &args) {
  for (std::size_t i = 0; i != args.size(); ++i)
    args[i] = convertImplicitly(std::move(args[i]), signature.parameters[i].type);
}

//===----------------------------------------------------------------------===//
// User functions
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkUserCall(const ast::CallExpr &expr,
                                       const std::vector<const typed::Function *> &candidates,
                                       ExprPtr receiver) {
  std::vector<Signature> signatures;
  std::vector<SourceRange> places;
  bool broken = false;
  for (const typed::Function *candidate : candidates) {
    signatures.push_back(signatureOf(*candidate));
    places.push_back(candidate->range);
    broken |= candidate->returnType->isError();
    for (const Signature::Parameter &parameter : signatures.back().parameters)
      broken |= parameter.type->isError();
  }
  std::vector<ExprPtr> args = checkArguments(expr.args, signatures);
  if (broken && candidates.size() == 1)
    return errorExpr(expr.range);
  const int chosen = choose(expr.callee, signatures, args, places, expr.range);
  if (chosen < 0)
    return errorExpr(expr.range);
  checkWritten(expr.args, signatures, chosen, args);
  if (anyBroken(args))
    return errorExpr(expr.range);
  const typed::Function &callee = *candidates[static_cast<std::size_t>(chosen)];
  const Signature &signature = signatures[static_cast<std::size_t>(chosen)];
  if (signature.result->isError())
    return errorExpr(expr.range);
  const bool isOfBase = !expr.base.text.empty();
  if (isOfBase && !requireSameMethod(callee, expr.base.range.to(expr.callee.range)))
    return errorExpr(expr.range);
  if (!isOfBase && !requireCallable(callee, expr.callee.range, receiver != nullptr))
    return errorExpr(expr.range);
  for (std::size_t i = 0; i != args.size(); ++i)
    if (signature.parameters[i].direction != ast::Direction::In &&
        !requireTarget(*expr.args[i], *args[i], "write to"))
      return errorExpr(expr.range);
  if (!facts) {
    diagnostics.report(Code::useOutsideFunction, expr.callee.range, callee.name);
    return errorExpr(expr.range);
  }
  facts->calls.push_back({&callee, callee.owner != nullptr && !isOfBase, receiver != nullptr,
                          receiver && isOfMember(*receiver), expr.callee.range});
  convertArguments(signature, args);
  if (receiver) {
    auto node = makeExpr<typed::MethodCallExpr>(signature.result, expr.range);
    node->receiver = std::move(receiver);
    node->method = callee.name;
    node->function = &callee;
    node->args = std::move(args);
    return node;
  }
  auto node = makeExpr<typed::CallExpr>(signature.result, expr.range);
  node->function = &callee;
  node->onSelf = callee.owner != nullptr;
  node->isOfBase = isOfBase;
  node->args = std::move(args);
  return node;
}

/// Constructors and most methods of the table are called by the engine alone; a few may also be
/// called by other methods of the same object, if these are allowed all that the called method
/// does.
bool FunctionChecker::requireCallable(const typed::Function &callee, SourceRange range,
                                      bool onOtherObject) {
  if (!callee.isConstructor && !callee.isStateMethod)
    return true;
  if (const RootModel *root = rootModel(callee.owner->root); root && !onOtherObject)
    if (const MethodModel *method = root->method(callee.name, !callee.parameters.empty()))
      if (const std::optional<Ability> ability = method->calledBy())
        return recordSpecial(*ability, callee.name, range);
  diagnostics.report(Code::engineCalls, range, callee.name)
      .label(callee.range, "defined here")
      .note(callee.isConstructor ? "the constructor runs once, when the scene creates the object"
                                 : "move the common code into a function of its own");
  return false;
}

//===----------------------------------------------------------------------===//
// Base::function(...)
//===----------------------------------------------------------------------===//

/// A function that overrides a method of the engine may call the base's definition of that method.
bool FunctionChecker::requireSameMethod(const typed::Function &callee, SourceRange range) {
  if (!callee.isConstructor && !callee.isStateMethod)
    return true;
  const bool isSame = function && function->name == callee.name &&
                      (callee.isConstructor || sameParameters(callee, *function));
  if (!isSame)
    diagnostics
        .report(Code::baseMethodElsewhere, range, callee.owner->name, callee.name, callee.name)
        .label(callee.range, "defined here")
        .note(callee.isConstructor ? "the constructor runs once, when the scene creates the object"
                                   : "move the common code into a function of its own");
  return isSame;
}

ExprPtr FunctionChecker::checkBaseCall(const ast::CallExpr &expr) {
  const ClassScope *base = scope ? scope->base : nullptr;
  while (base && base->definition->name != expr.base.text)
    base = base->base;
  if (base) {
    const std::vector<const typed::Function *> candidates =
        program.findMethods(base, expr.callee.text);
    if (!candidates.empty())
      return checkUserCall(expr, candidates, nullptr);
  }
  for (const ast::ExprPtr &arg : expr.args)
    checkExpr(*arg);
  if (base) {
    Diagnostic &diagnostic = diagnostics.report(Code::unknownMethod, expr.callee.range,
                                                base->definition->name, expr.callee.text);
    std::vector<std::string> names;
    for (const ClassScope *at = base; at; at = at->base)
      for (const auto &entry : at->functions)
        names.push_back(entry.first);
    std::sort(names.begin(), names.end());
    if (const std::string closest = closestName(expr.callee.text, names); !closest.empty())
      diagnostic.fix(expr.callee.range, closest);
    diagnostic.label(base->definition->range, "`" + base->definition->name + "` is defined here");
    return errorExpr(expr.range);
  }
  Diagnostic &diagnostic =
      diagnostics.report(Code::notABase, expr.base.range, expr.base.text,
                         scope ? "`" + scope->definition->name + "`" : "any class here");
  const SourceRange front{expr.base.range.file, expr.base.range.begin, expr.callee.range.begin};
  if (scope && scope->definition->name == expr.base.text)
    diagnostic.fix(front, "");
  else if (scope && scope->root && scope->root->name == expr.base.text)
    diagnostic.note("the rt_ classes define no functions");
  else if (scope) {
    std::vector<std::string> bases;
    for (const ClassScope *at = scope->base; at; at = at->base)
      bases.push_back(at->definition->name);
    if (const std::string closest = closestName(expr.base.text, bases); !closest.empty())
      diagnostic.fix(expr.base.range, closest);
    else if (scope->base && expr.base.text == "super")
      diagnostic.fix(expr.base.range, scope->base->definition->name);
  }
  return errorExpr(expr.range);
}

//===----------------------------------------------------------------------===//
// Built-in functions
//===----------------------------------------------------------------------===//

/// May this function run both for hits and elsewhere? Elsewhere derivatives are 0 (sema/derive).
bool FunctionChecker::mayRunAnywhere() const {
  return function && (!scope || (scope->root && scope->root->name == typed::helperRoot));
}

ExprPtr FunctionChecker::checkBuiltinCall(const ast::CallExpr &expr,
                                          const BuiltinOverloads &overloads) {
  std::vector<ExprPtr> args = checkArguments(expr.args, overloads.signatures);
  const int chosen = choose(expr.callee, overloads.signatures, args, {}, expr.range);
  if (chosen < 0)
    return errorExpr(expr.range);
  checkWritten(expr.args, overloads.signatures, chosen, args);
  if (anyBroken(args))
    return errorExpr(expr.range);
  const Signature &signature = overloads.signatures[static_cast<std::size_t>(chosen)];
  const Builtin builtin = overloads.builtins[static_cast<std::size_t>(chosen)];
  for (std::size_t i = 0; i != args.size(); ++i)
    if (signature.parameters[i].direction != ast::Direction::In &&
        !requireTarget(*expr.args[i], *args[i], "write to"))
      return errorExpr(expr.range);
  if (const std::optional<Ability> ability = abilityNeeded(typed::name(builtin));
      ability && !(ability == Ability::Derivatives && mayRunAnywhere()) &&
      !recordSpecial(*ability, expr.callee.text, expr.callee.range))
    return errorExpr(expr.range);
  isLit |= has(builtin, typed::effect::Lights);
  convertArguments(signature, args);
  auto node = makeExpr<typed::BuiltinExpr>(signature.result, expr.range);
  node->builtin = builtin;
  node->args = std::move(args);
  return node;
}

//===----------------------------------------------------------------------===//
// receiver.function(...)
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkReceiverCall(const ast::CallExpr &expr) {
  ExprPtr receiver = checkExpr(*expr.receiver);
  const Type *type = receiver->type;
  if (type->isError()) {
    for (const ast::ExprPtr &arg : expr.args)
      checkExpr(*arg);
    return errorExpr(expr.range);
  }
  if (type->is(TypeKind::Class))
    return checkReferenceCall(expr, std::move(receiver));
  const bool hasLength = type->is(TypeKind::Array) || type->is(TypeKind::Buffer) ||
                         type->isVector() || type->isMatrix();
  if (hasLength && expr.callee.text == "length")
    return checkLength(expr, std::move(receiver));
  Diagnostic &diagnostic =
      diagnostics.report(Code::noFunctions, expr.callee.range, toString(type), expr.callee.text);
  if (hasLength && (expr.callee.text == "size" || expr.callee.text == "count"))
    diagnostic.fix(expr.callee.range, "length");
  return errorExpr(expr.range);
}

ExprPtr FunctionChecker::checkLength(const ast::CallExpr &expr, ExprPtr receiver) {
  if (!expr.args.empty()) {
    diagnostics.report(Code::wrongArgumentCount, expr.range, "length", "0 arguments",
                       expr.args.size());
    return errorExpr(expr.range);
  }
  if (!receiver->type->is(TypeKind::Buffer)) {
    typed::Constant value;
    value.scalars.resize(1);
    value.scalars[0].i = static_cast<std::int32_t>(receiver->type->count);
    return literal(types.intType, expr.range, std::move(value));
  }
  auto node = makeExpr<typed::LengthExpr>(types.intType, expr.range);
  node->base = std::move(receiver);
  return node;
}

ExprPtr FunctionChecker::checkReferenceCall(const ast::CallExpr &expr, ExprPtr receiver) {
  const Type *type = receiver->type;
  const std::string &method = expr.callee.text;
  const std::string &root = type->classType ? type->classType->root : type->builtinClass;
  if (root == "rt_Texture" && (method == "lookup" || method == "lookupFloat")) {
    if (!expr.args.empty()) {
      diagnostics
          .report(Code::wrongArgumentCount, expr.range, method, "0 arguments", expr.args.size())
          .note("a texture reads `rt_TextureUV` and `rt_TextureUVW`");
      return errorExpr(expr.range);
    }
    if (!recordSpecial(Ability::Lookup, method, expr.callee.range))
      return errorExpr(expr.range);
    auto node = makeExpr<typed::MethodCallExpr>(method == "lookup" ? types.color : types.floatType,
                                                expr.range);
    node->receiver = std::move(receiver);
    node->method = method;
    return node;
  }
  std::vector<const typed::Function *> candidates;
  if (type->classType)
    candidates = program.findMethods(program.scopeOf.at(type->classType), method);
  if (!candidates.empty())
    return checkUserCall(expr, candidates, std::move(receiver));

  const RootModel *model = rootModel(root);
  if (model && model->method(method)) {
    diagnostics.report(Code::engineCalls, expr.callee.range, method)
        .note("of the methods that the engine calls, only a texture's `lookup` may be called by "
              "shaders");
    return errorExpr(expr.range);
  }
  Diagnostic &diagnostic =
      diagnostics.report(Code::unknownMethod, expr.callee.range, toString(type), method);
  std::vector<std::string> names;
  if (root == "rt_Texture")
    names = {"lookup", "lookupFloat"};
  for (const ClassScope *at = type->classType ? program.scopeOf.at(type->classType) : nullptr; at;
       at = at->base)
    for (const auto &entry : at->functions)
      names.push_back(entry.first);
  std::sort(names.begin(), names.end());
  if (const std::string closest = closestName(method, names); !closest.empty())
    diagnostic.fix(expr.callee.range, closest);
  if (type->classType)
    diagnostic.label(type->classType->range, "`" + type->classType->name + "` is defined here");
  return errorExpr(expr.range);
}

} // namespace rtsl
