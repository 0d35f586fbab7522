//===- Declarations.cpp - types, signatures, structs, classes, the file ---===//
#include "codegen/cpp/Printer.h"

#include "codegen/cpp/Format.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rtsl::cpp {

ModulePrinter::ModulePrinter(const typed::Module &module, const ModuleFacts &facts,
                             const Options &options, Diagnostics &diagnostics,
                             const StateProgram *states)
    : module(module), facts(facts), options(options), names(module),
      effects(module, options.prints, options.exceptions && options.checkIndices),
      hitAnswers(module), notes(diagnostics.sources()),
      mayReferToNothing(typed::mayReferToNothing(module)), lookupsNest(typed::lookupsNest(module)),
      states(states), diagnostics(diagnostics) {
  if (!states)
    return;
  findStates();
  findCalledMethods();
}

void ModulePrinter::unsupported(SourceRange range, const std::string &what) {
  diagnostics.report(rtsl::Code::notSupportedYet, range, what);
  failed = true;
}

std::optional<SourcePlace> ModulePrinter::lineDirective(SourceRange range) const {
  return lineDirective(range, range.isValid() ? notes.line(range) : 0);
}

std::optional<SourcePlace> ModulePrinter::lineDirective(SourceRange range, unsigned line) const {
  if (!options.lineDirectives || !range.isValid())
    return std::nullopt;
  return SourcePlace{notes.file(range), line};
}

//===----------------------------------------------------------------------===//
// Types
//===----------------------------------------------------------------------===//

std::string ModulePrinter::type(const Type *type, bool inMemory) {
  switch (type->kind) {
  case TypeKind::Void:
    return "void";
  case TypeKind::Bool:
    return inMemory ? "rtsl::Bool" : "bool";
  case TypeKind::Int:
    return "int";
  case TypeKind::UInt:
    return "unsigned";
  case TypeKind::Float:
    return "float";
  case TypeKind::Vector:
    switch (type->element->kind) {
    case TypeKind::Float:
      return fmt::format("glm::vec{}", type->count);
    case TypeKind::Int:
      return fmt::format("glm::ivec{}", type->count);
    case TypeKind::UInt:
      return fmt::format("glm::uvec{}", type->count);
    default:
      return inMemory ? fmt::format("glm::vec<{}, rtsl::Bool>", type->count)
                      : fmt::format("glm::bvec{}", type->count);
    }
  case TypeKind::Matrix:
    return type->columns() == type->rows()
               ? fmt::format("glm::mat{}", type->columns())
               : fmt::format("glm::mat{}x{}", type->columns(), type->rows());
  case TypeKind::Color:
    return "Color";
  case TypeKind::Struct:
    return names.of(type->structure);
  case TypeKind::Class: {
    const std::string className = type->classType ? type->classType->name : type->builtinClass;
    referenced[className];
    return names.reference(className);
  }
  case TypeKind::Array:
    return fmt::format("rtsl::array<{}, {}>", memoryType(type->element), type->count);
  case TypeKind::Buffer:
    return type->count == 1
               ? fmt::format("rtsl::Buffer<{}>", memoryType(type->element))
               : fmt::format("rtsl::Buffer<{}, {}>", memoryType(type->element), type->count);
  case TypeKind::Error:
  case TypeKind::String:
    break;
  }
  return "void";
}

Code ModulePrinter::zero(const Type *type) {
  switch (type->kind) {
  case TypeKind::Bool:
    return boolean(false);
  case TypeKind::Int:
    return literal("0", true);
  case TypeKind::UInt:
    return literal("0u", true);
  case TypeKind::Float:
    return literal("0.0f", true);
  default:
    return list("", {});
  }
}

Code ModulePrinter::colorOf(std::vector<Code> components) {
  if (components.size() == 3 && options.colorComponents != 3)
    return call(withParameters("rtsl::rgb", {std::to_string(options.colorComponents)}),
                std::move(components));
  return construct("Color", std::move(components));
}

//===----------------------------------------------------------------------===//
// Signatures
//===----------------------------------------------------------------------===//

/// The method that this one overrides, at the top: what one of them takes, all take.
bool ModulePrinter::takesState(const typed::Function &function) {
  return function.isStateMethod || effects.function(function).usesRay;
}

bool ModulePrinter::takesScratch(const typed::Function &function) {
  const Effects &inside = effects.function(function);
  if (!function.owner)
    return inside.reportsHit;
  if (!hasScratch(*function.owner))
    return false;
  return inside.usesScratch || inside.reportsHit ||
         (function.isStateMethod && function.name == "intersect");
}

bool ModulePrinter::isByReference(const typed::Variable &parameter,
                                  const typed::Function &function) {
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
  if (!function.owner || function.isConstructor || function.isStateMethod)
    return !assigns(function);
  // What overrides a method takes what that takes.
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

bool ModulePrinter::beginsAsZero(const typed::Variable &parameter,
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

std::string ModulePrinter::parameterName(const typed::Function &function,
                                         std::size_t number) const {
  const std::string &name = names.of(function.parameters[number].get());
  return name.empty() ? fmt::format("unnamed{}", number + 1) : name;
}

/// What the body of a function does with what it is given.
struct ModulePrinter::Mentions {
  std::set<const typed::Variable *> variables, read;
  bool ray = false, scratch = false;
};

ModulePrinter::Mentions ModulePrinter::mentionsOf(const typed::Function &function) {
  Mentions found;
  if (!function.body)
    return found;
  const Effects own = effects.statement(*function.body);
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

Parameter ModulePrinter::parameter(const typed::Function &function, std::size_t number,
                                   const Mentions &mentions) {
  const typed::Variable &source = *function.parameters[number];
  const bool isSet = beginsAsZero(source, function);
  Parameter made =
      byValue(type(source.type), isSet ? parameterName(function, number) : names.of(&source));
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

Function ModulePrinter::signature(const typed::Function &function, bool isMethod) {
  const Mentions mentions = mentionsOf(function);
  Function made;
  made.result = type(function.returnType);
  made.name = names.of(&function);
  if (takesState(function))
    made.parameters.push_back(byReference("State", mentions.ray ? "rt" : ""));
  if (takesScratch(function)) {
    const Effects &inside = effects.function(function);
    const bool writes = inside.writesScratch || inside.reportsHit || function.name == "intersect";
    Parameter scratch = byReference(function.owner ? "Scratch" : "rtsl::Scratch",
                                    mentions.scratch ? "scratch" : "");
    scratch.isConst = !writes;
    made.parameters.push_back(scratch);
  }
  for (std::size_t number = 0; number != function.parameters.size(); ++number)
    made.parameters.push_back(parameter(function, number, mentions));
  if (isMethod) {
    made.isConst = !function.isConstructor && !effects.function(function).writesMembers;
    made.isOverride = overrides(function);
    if (!made.isOverride && isOverridden(function))
      made.specifiers = "virtual";
  }
  return made;
}

bool ModulePrinter::overrides(const typed::Function &function) const {
  if (function.isConstructor || !function.owner)
    return false;
  for (const typed::Class *base = function.owner->base; base; base = base->base)
    for (const auto &method : base->functions)
      if (method->name == function.name && typed::sameParameters(*method, function) &&
          !isPartOfStates(*method))
        return isOverridden(*method);
  return false;
}

// Only what the author's own code calls on the object itself needs C++'s dispatch: the runtime and
// references know the class.
bool ModulePrinter::isOverridden(const typed::Function &function) const {
  if (function.isConstructor || !function.owner || function.isStateMethod ||
      isPartOfStates(function))
    return false;
  for (const auto &definition : module.classes)
    if (definition.get() != function.owner && definition->derivesFrom(function.owner))
      for (const auto &method : definition->functions)
        if (method->name == function.name && typed::sameParameters(*method, function) &&
            !isPartOfStates(*method))
          return true;
  return false;
}

Declaration ModulePrinter::function(const typed::Function &function, bool isMethod) {
  Function made = signature(function, isMethod);
  if (!isMethod)
    made.specifiers = "inline";
  made.body = FunctionPrinter(*this, &function).body();
  Declaration declared = declare(std::move(made), function.comment);
  declared.place = lineDirective(function.range);
  return declared;
}

//===----------------------------------------------------------------------===//
// Structs and constants
//===----------------------------------------------------------------------===//

/// `friend bool operator==(const Ray &a, const Ray &b)` with this value.
static Declaration comparison(const std::string &type, const char *name, Code value) {
  Function made;
  made.specifiers = "friend";
  made.result = "bool";
  made.name = name;
  made.parameters = {byConstReference(type, "a"), byConstReference(type, "b")};
  made.body = Statements{returning(std::move(value))};
  return declare(std::move(made));
}

/// The operators == and != of a struct.
static Declarations comparisons(const Names &names, const typed::Struct &structure) {
  const Code a = name("a"), b = name("b");
  Code equal;
  for (const typed::Field &field : structure.fields) {
    const std::string &own = names.of(&field);
    const Code part = binary(Operator::Equal, member(a, own), member(b, own));
    equal = equal ? binary(Operator::And, equal, part) : part;
  }
  const std::string &type = names.of(&structure);
  return {comparison(type, "operator==", equal),
          comparison(type, "operator!=", unary(UnaryOperator::Not, binary(Operator::Equal, a, b)))};
}

Declaration ModulePrinter::structure(const typed::Struct &structure) {
  Struct made;
  made.name = names.of(&structure);
  if (std::optional<Declaration> type = rayType(structure))
    made.members.push_back(std::move(*type));
  const bool hasRayType = !made.members.empty();
  for (std::size_t i = 0; i < structure.fields.size(); ++i) {
    const typed::Field &field = structure.fields[i];
    const Code initial = field.type->is(TypeKind::Bool) ? list("", {}) : zero(field.type);
    Declaration declared =
        declare(Variable{{}, memoryType(field.type), {names.of(&field), initial}}, field.comment);
    declared.trailing = notes.trailingComment(field.range);
    declared.hasSpace =
        i == 0 ? hasRayType : notes.followsEmptyLine(field.range, structure.fields[i - 1].range);
    made.members.push_back(std::move(declared));
  }
  const bool isCompared =
      std::any_of(comparedStructs.begin(), comparedStructs.end(),
                  [&](const Type *compared) { return compared->structure == &structure; });
  if (isCompared)
    appendApart(made.members, comparisons(names, structure));
  return declare(std::move(made), structure.comment);
}

/// Whether C++ takes the initialiser for a constant expression: numbers, constants that it takes
/// for such, and what is not division. The header's functions are none, and no infinity may come
/// out.
bool ModulePrinter::isConstexpr(const Type *type, const typed::Constant *value,
                                const std::string &name, const Code &initialiser) {
  if (!type->isScalar() || !value ||
      (type->is(TypeKind::Float) && !std::isfinite(value->scalars.front().f)))
    return false;
  bool isPlain = true;
  forEachPart(initialiser, [&](const ExpressionNode &part) {
    switch (part.kind) {
    case ExpressionKind::Literal:
    case ExpressionKind::Parentheses:
    case ExpressionKind::Unary:
    case ExpressionKind::Conditional:
      break;
    case ExpressionKind::Name:
      isPlain &= constexprNames.count(part.name) != 0;
      break;
    case ExpressionKind::Binary:
      isPlain &= part.op != Operator::Divide && part.op != Operator::Remainder;
      break;
    default:
      isPlain = false;
    }
  });
  if (isPlain)
    constexprNames.insert(name);
  return isPlain;
}

Declaration ModulePrinter::constant(const typed::Variable &constant) {
  FunctionPrinter printer(*this, nullptr);
  const std::string &name = names.of(&constant);
  const Code initialiser = printer.initialiser(*constant.init);
  const bool isPlain = isConstexpr(constant.type, constant.constant.get(), name, initialiser) ||
                       printer.isTable(*constant.init);
  Declaration declared = declare(Variable{isPlain ? "inline constexpr" : "inline const",
                                          type(constant.type),
                                          {name, initialiser}},
                                 constant.comment);
  declared.trailing = notes.trailingComment(constant.init->range);
  return declared;
}

Declarations ModulePrinter::freeFunctions() {
  // Prototypes for those that are called above their definition.
  std::set<const typed::Function *> defined, asked;
  std::vector<const typed::Function *> prototypes;
  for (const auto &function : module.functions) {
    if (!function->body)
      continue;
    forEachExpr(*function->body, [&](const typed::Expr &expr) {
      auto *call = dynCast<typed::CallExpr>(&expr);
      if (call && !call->function->owner && !defined.count(call->function) &&
          call->function != function.get() && asked.insert(call->function).second)
        prototypes.push_back(call->function);
    });
    defined.insert(function.get());
  }
  Declarations functions;
  for (const typed::Function *function : prototypes)
    if (!isPartOfStates(*function))
      functions.push_back(declare(signature(*function, false)));
  for (const auto &function : module.functions)
    if (function->body && !isPartOfStates(*function))
      appendApart(functions, this->function(*function, false));
  return functions;
}

//===----------------------------------------------------------------------===//
// Classes
//===----------------------------------------------------------------------===//

Declaration ModulePrinter::member(const typed::Member &member) {
  FunctionPrinter printer(*this, nullptr, member.owner);
  Variable made;
  Code value = member.init ? printer.initialiser(*member.init) : zero(member.type);
  if (member.isConst) {
    const bool isPlain =
        isConstexpr(member.type, member.constant.get(), names.of(&member), value) ||
        (member.init && printer.isTable(*member.init));
    made.qualifiers = isPlain ? "static constexpr" : "inline static const";
    made.type = type(member.type);
  } else {
    if (member.type->is(TypeKind::Bool)) // converts in braces
      value = member.init ? list("", {value}) : list("", {});
    made.type = memoryType(member.type);
  }
  made.declarator = {names.of(&member), value};
  Declaration declared = declare(std::move(made), member.comment);
  declared.trailing = notes.trailingComment(member.init ? member.init->range : member.range);
  return declared;
}

/// Members but for the scratch members, in the author's groups.
Declarations ModulePrinter::ownMembers(const typed::Class &definition) {
  Declarations members;
  SourceRange previous;
  for (const auto &member : definition.members) {
    if (member->access == ast::Access::Scratch)
      continue;
    Declaration declared = this->member(*member);
    declared.hasSpace = notes.followsEmptyLine(member->range, previous);
    previous = member->range;
    members.push_back(std::move(declared));
  }
  return members;
}

/// `using Base::method;` for methods of bases that overloads in the class would hide. States may
/// have other names.
Declarations ModulePrinter::methodsOfBases(const typed::Class &definition) {
  Declarations named;
  std::set<std::string> shown;
  for (const auto &function : definition.functions)
    for (const typed::Class *at = definition.base; at; at = at->base)
      for (const auto &method : at->functions)
        if (method->name == function->name && !method->isConstructor && !isPartOfStates(*method) &&
            !isPartOfStates(*function) &&
            (!isSplit(*at, *method) || nameOfMachine(*at, *method) == names.of(method.get())) &&
            !typed::sameParameters(*method, *function) && shown.insert(method->name).second)
          appendApart(named, declare(Using{names.of(at) + "::" + names.of(method.get())}));
  return named;
}

Declaration ModulePrinter::classDefinition(const typed::Class &definition) {
  Struct made;
  made.name = names.of(&definition);
  made.base = definition.base ? names.of(definition.base) : "rtsl::" + nameOfRoot(definition.root);
  made.members = ownMembers(definition);
  if (std::optional<Declaration> scratch = scratchStructure(definition))
    appendApart(made.members, std::move(*scratch));
  appendApart(made.members, methodsOfBases(definition));
  for (const auto &function : definition.functions) {
    if (!function->body)
      continue;
    if (isSplit(definition, *function))
      appendApart(made.members, stateMachine(definition, *function));
    else if (!isPartOfStates(*function))
      appendApart(made.members, this->function(*function, true));
  }
  appendApart(made.members, inheritedStateMachines(definition));
  Declaration declared = declare(std::move(made), definition.comment);
  declared.place = lineDirective(definition.range);
  return declared;
}

//===----------------------------------------------------------------------===//
// The file
//===----------------------------------------------------------------------===//

/// What stands above the namespace: how the file was made, macros and includes.
Declarations ModulePrinter::heading() const {
  Declarations all;
  if (options.fast) {
    all.push_back(declare(OnlyComment{},
                          "// Made by rtslc --emit=cpp --fp=fast: what it computes differs in the "
                          "last digits with the compiler\n// and its options."));
    all.push_back(declare(Define{"RTSL_FAST"}));
  } else {
    all.push_back(declare(OnlyComment{},
                          "// Made by rtslc --emit=cpp. Compiled with any options but -ffast-math "
                          "it computes what rtslc's own\n// machine code computes, to the last "
                          "bit."));
  }
  if (!options.whyCalls.empty())
    all.push_back(declare(
        OnlyComment{}, "//\n// Rays are calls, not the ends of states: " + options.whyCalls + "."));
  if (!options.checkIndices) {
    all.push_back(declare(Define{"RTSL_UNCHECKED"}));
    all.back().trailing = "// indices are trusted (--unchecked)";
  }
  all.push_back(declare(Include{"rtsl/shader.h"}));
  return all;
}

/// `extern "C" const RtslShaders *name_shaders()`: its declaration and its definition.
Declarations ModulePrinter::exported() const {
  Function made;
  made.specifiers = "extern \"C\"";
  made.result = "const RtslShaders *";
  made.name = options.name + "_shaders";
  Declarations both = {declare(made, "/// For rtsl::program in C++, and rtslSceneCreate in C.")};
  made.specifiers = {};
  made.body = Statements{
      declaration("static const", "RtslShaders", "shaders", call(options.name + "::describe", {})),
      returning(unary(UnaryOperator::Address, cpp::name("shaders")))};
  both.push_back(declare(std::move(made)));
  return both;
}

/// Numbers of the classes, from 1.
Declaration ModulePrinter::classNumbers() const {
  Enum ids = {"Id", "std::uint32_t", {}};
  unsigned next = 1;
  for (const auto &definition : module.classes)
    ids.values.push_back({names.of(definition.get()), next++});
  return declare(std::move(ids));
}

Declarations ModulePrinter::file() {
  // From the inside out: what functions require of the rest is complete when all are made.
  Declarations constants, classes, structs, entryPoints;
  for (const auto &constant : module.constants)
    constants.push_back(this->constant(*constant));
  Declarations functions = freeFunctions();
  for (const auto &definition : module.classes)
    appendApart(classes, classDefinition(*definition));
  Declarations hitErrors = this->hitErrors();
  const bool hasClasses = !module.classes.empty();
  if (hasClasses) {
    entryPoints = slots();
    append(entryPoints, description());
  }
  for (const auto &structure : module.structs)
    appendApart(structs, this->structure(*structure));
  Declarations methods = referenceMethods();
  Declarations references = this->references();

  Namespace space;
  space.name = options.name;
  const std::string components = std::to_string(options.colorComponents);
  Declarations &inside = space.members;
  inside.push_back(declare(Alias{"State", withParameters("rtsl::State", {components})}));
  inside.push_back(declare(Alias{"Color", withParameters("rtsl::Color", {components})}));
  if (!calledMethods.empty()) // the structs of their arguments name their first states
    appendApart(inside, stepNumbers());
  appendApart(inside, std::move(references));
  appendApart(inside, std::move(structs));
  appendApart(inside, std::move(constants));
  appendApart(inside, std::move(functions));
  if (hasClasses) { // unnamed: a function that is called once is inlined then, however long it is
    Namespace own;
    if (!methods.empty() || !entryPoints.empty())
      appendApart(own.members, classNumbers());
    if (calledMethods.empty())
      appendApart(own.members, stepNumbers());
    appendApart(own.members, std::move(classes));
    appendApart(inside, declare(std::move(own)));
  }
  appendApart(inside, std::move(methods));
  appendApart(inside, std::move(hitErrors));
  appendApart(inside, std::move(entryPoints));

  Declarations all = heading();
  appendApart(all, declare(std::move(space)));
  if (hasClasses)
    appendApart(all, exported());
  return all;
}

std::optional<std::string> print(const typed::Module &module, const ModuleFacts &facts,
                                 const Options &options, Diagnostics &diagnostics,
                                 const StateProgram *states) {
  ModulePrinter printer(module, facts, options, diagnostics, states);
  const Declarations file = printer.file();
  if (printer.failed || diagnostics.hasErrors())
    return std::nullopt;
  return format(print(file));
}

} // namespace rtsl::cpp
