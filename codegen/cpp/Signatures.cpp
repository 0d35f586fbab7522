#include "codegen/cpp/Signatures.h"

#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

bool Signatures::takesState(const typed::Function &function) {
  return function.isStateMethod || effects.function(function).usesRay;
}

bool Signatures::takesScratch(const typed::Function &function) {
  const typed::Effects &inside = effects.function(function);
  if (!function.owner)
    return inside.reportsHit;
  if (!scratch.has(*function.owner))
    return false;
  return inside.usesScratch || inside.reportsHit ||
         (function.isStateMethod && function.name == "intersect");
}

bool Signatures::isByReference(const typed::Variable &parameter, const typed::Function &function) {
  const Type *type = parameter.type;
  const bool isLarge = type->is(TypeKind::Struct) || type->is(TypeKind::Array) || type->isMatrix();
  if (parameter.direction != ast::Direction::In || !isLarge)
    return false;
  const auto position = std::find_if(function.parameters.begin(), function.parameters.end(),
                                     [&](const auto &one) { return one.get() == &parameter; }) -
                        function.parameters.begin();
  auto assigns = [&](const typed::Function &method) {
    return method.body &&
           assignedVariables(*method.body)
                   .count(method.parameters[static_cast<std::size_t>(position)].get()) != 0;
  };
  if (!function.owner || function.isConstructor || isCalledByEngineAlone(function))
    return !assigns(function);
  // Overriding methods have the parameters of the method that they override.
  const typed::Function &top = overridden(function);
  return std::none_of(module.classes.begin(), module.classes.end(), [&](const auto &definition) {
    return definition->derivesFrom(top.owner) &&
           std::any_of(definition->functions.begin(), definition->functions.end(),
                       [&](const auto &method) {
                         return method->name == top.name && typed::sameParameters(*method, top) &&
                                assigns(*method);
                       });
  });
}

/// Does some part of the statement or expression name the variable?
template <typename Tree>
static bool mentions(const Tree &tree, const typed::Variable &variable) {
  bool found = false;
  forEachExpr(tree, [&](const typed::Expr &expr) {
    auto *named = dynCast<typed::VariableExpr>(&expr);
    found = found || (named && named->variable == &variable);
  });
  return found;
}

bool Signatures::beginsAsZero(const typed::Variable &parameter,
                              const typed::Function &function) const {
  if (parameter.direction != ast::Direction::Out || !function.body)
    return false;
  for (const typed::StmtPtr &stmt : cast<typed::CompoundStmt>(*function.body).body) {
    const bool isPlain = stmt && (stmt->kind == ast::StmtKind::Expression ||
                                  stmt->kind == ast::StmtKind::Declaration);
    if (!stmt || (isPlain && !mentions(*stmt, parameter)))
      continue;
    auto *expression = dynCast<typed::ExpressionStmt>(stmt);
    auto *assign = expression ? dynCast<typed::AssignExpr>(expression->expr) : nullptr;
    auto *target = assign ? dynCast<typed::VariableExpr>(assign->target) : nullptr;
    return !target || target->variable != &parameter || assign->compound ||
           mentions(*assign->value, parameter);
  }
  return true;
}

std::string Signatures::parameterName(const typed::Function &function, std::size_t number) const {
  const std::string &name = names.of(function.parameters[number].get());
  return name.empty() ? fmt::format("unnamed{}", number + 1) : name;
}

/// The parameters and the state that the body of a function uses.
struct Signatures::Mentions {
  std::set<const typed::Variable *> variables, read;
  bool ray = false, scratch = false;
};

Signatures::Mentions Signatures::mentionsOf(const typed::Function &function) {
  Mentions found;
  if (!function.body)
    return found;
  const typed::Effects own = effects.statement(*function.body);
  found.ray = own.usesRay;
  found.scratch = own.usesScratch || own.reportsHit;
  std::set<const typed::Expr *> onlyWritten;
  effects.forEachEvaluated(*function.body, [&](const typed::Expr &expr) {
    if (auto *assign = dynCast<typed::AssignExpr>(&expr))
      onlyWritten.insert(assign->target.get());
    if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
      onlyWritten.insert(incDec->target.get());
    if (auto *variable = dynCast<typed::VariableExpr>(&expr)) {
      found.variables.insert(variable->variable);
      if (!onlyWritten.count(&expr))
        found.read.insert(variable->variable);
    }
    if (auto *call = dynCast<typed::CallExpr>(&expr)) {
      found.ray |= takesState(*call->function);
      found.scratch |= takesScratch(*call->function);
    }
  });
  return found;
}

Parameter Signatures::parameter(const typed::Function &function, std::size_t number,
                                const Mentions &mentions) {
  const typed::Variable &source = *function.parameters[number];
  const bool isSet = beginsAsZero(source, function);
  Parameter made =
      byValue(types.of(source.type), isSet ? parameterName(function, number) : names.of(&source));
  if (source.direction != ast::Direction::In)
    made.pass = Parameter::Pass::Reference;
  else if (isByReference(source, function))
    made = byConstReference(made.type, made.name);
  else
    made.isConst = source.isConst;
  made.isCommented = !mentions.variables.count(&source) && !isSet;
  made.isUnread =
      !made.isCommented && !mentions.read.count(&source) && source.direction == ast::Direction::In;
  return made;
}

Function Signatures::of(const typed::Function &function, bool isMethod) {
  const Mentions mentions = mentionsOf(function);
  Function made;
  made.result = types.of(function.returnType);
  made.name = names.of(&function);
  if (takesState(function))
    made.parameters.push_back(byReference("State", mentions.ray ? "rt" : ""));
  if (takesScratch(function)) {
    const typed::Effects &inside = effects.function(function);
    const bool writes = inside.writesScratch || inside.reportsHit || function.name == "intersect";
    Parameter taken = byReference(function.owner ? "Scratch" : "rtsl::Scratch",
                                  mentions.scratch ? "scratch" : "");
    taken.isConst = !writes;
    made.parameters.push_back(taken);
  }
  for (std::size_t number = 0; number != function.parameters.size(); ++number)
    made.parameters.push_back(parameter(function, number, mentions));
  if (isMethod) {
    made.isConst = !function.isConstructor && !effects.function(function).writesMembers;
    made.isOverride = split.overridesVirtual(function);
    if (!made.isOverride && split.isVirtual(function))
      made.specifiers = "virtual";
  }
  return made;
}

// A function is printed once for all classes that inherit it.
bool Signatures::mayAnswerHit(const typed::Function &function) {
  return function.owner ? hitAnswers.mayAnswerOf(function)
                        : hitAnswers.mayAnswer(function, nullptr);
}

} // namespace rtsl::cpp
