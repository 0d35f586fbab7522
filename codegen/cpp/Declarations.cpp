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

std::string ModulePrinter::commentText(const std::string &comment) const {
  return comment.empty() ? comment : comment + "\n";
}

std::optional<SourcePlace> ModulePrinter::lineDirective(SourceRange range) const {
  return lineDirective(range, range.isValid() ? notes.line(range) : 0);
}

std::optional<SourcePlace> ModulePrinter::lineDirective(SourceRange range, unsigned line) const {
  if (!options.lineDirectives || !range.isValid())
    return std::nullopt;
  return SourcePlace{notes.file(range), line};
}

static std::string text(const std::optional<SourcePlace> &place) {
  return place ? print(*place) : std::string();
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

/// A variable of this type, as it is declared: `name = value`.
static std::string declarator(const std::string &type, const std::string &name, const Code &value) {
  return print(Declarator{name, value}, type);
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

std::string ModulePrinter::signature(const typed::Function &function, bool isMethod) {
  std::set<const typed::Variable *> mentioned, read;
  std::set<const typed::Expr *> onlyWritten;
  bool mentionsRay = false, mentionsScratch = false;
  if (function.body) {
    const Effects own = effects.statement(*function.body);
    mentionsRay = own.usesRay;
    mentionsScratch = own.usesScratch || own.reportsHit;
    effects.forEachEvaluated(*function.body, [&](const typed::Expr &expr) {
      if (auto *assign = dynCast<typed::AssignExpr>(&expr))
        onlyWritten.insert(assign->target.get());
      if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
        onlyWritten.insert(incDec->target.get());
      if (auto *variable = dynCast<typed::VariableExpr>(&expr)) {
        mentioned.insert(variable->variable);
        if (!onlyWritten.count(&expr))
          read.insert(variable->variable);
      }
      if (auto *call = dynCast<typed::CallExpr>(&expr)) {
        mentionsRay |= takesState(*call->function);
        mentionsScratch |= takesScratch(*call->function);
      }
    });
  }

  std::vector<std::string> parameters;
  if (takesState(function))
    parameters.push_back(mentionsRay ? "State &rt" : "State &");
  if (takesScratch(function)) {
    const Effects &inside = effects.function(function);
    const bool writes = inside.writesScratch || inside.reportsHit || function.name == "intersect";
    const std::string scratch = function.owner ? "Scratch" : "rtsl::Scratch";
    parameters.push_back(std::string(writes ? "" : "const ") + scratch +
                         (mentionsScratch ? " &scratch" : " &"));
  }
  for (std::size_t number = 0; number != function.parameters.size(); ++number) {
    const auto &parameter = function.parameters[number];
    std::string name = names.of(parameter.get());
    std::string text = type(parameter->type);
    const bool isSet = beginsAsZero(*parameter, function);
    if (isSet)
      name = parameterName(function, number);
    if (parameter->direction != ast::Direction::In)
      text += " &";
    else if (isByReference(*parameter, function))
      text = "const " + text + " &";
    else
      text = (parameter->isConst ? "const " : "") + text + " ";
    if (!mentioned.count(parameter.get()) && !isSet)
      name = name.empty() ? "" : "/*" + name + "*/";
    else if (!read.count(parameter.get()) && parameter->direction == ast::Direction::In)
      text = "[[maybe_unused]] " + text;
    parameters.push_back(text + name);
  }

  std::string text =
      type(function.returnType) + " " + names.of(&function) + "(" + join(parameters, ", ") + ")";
  if (isMethod) {
    if (!function.isConstructor && !effects.function(function).writesMembers)
      text += " const";
    if (overrides(function))
      text += " override";
    else if (isOverridden(function))
      text = "virtual " + text;
  }
  return text;
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

std::string ModulePrinter::function(const typed::Function &function, bool isMethod) {
  std::string text = commentText(function.comment) + cpp::text(lineDirective(function.range));
  if (!isMethod)
    text += "inline ";
  text += signature(function, isMethod) + " ";
  FunctionPrinter printer(*this, &function);
  return text + "{\n" + print(printer.body()) + "}\n";
}

//===----------------------------------------------------------------------===//
// Structs and constants
//===----------------------------------------------------------------------===//

std::string ModulePrinter::structure(const typed::Struct &structure) {
  std::string text = commentText(structure.comment) + "struct " + names.of(&structure) + " {\n" +
                     rayType(structure);
  for (std::size_t i = 0; i < structure.fields.size(); ++i) {
    const typed::Field &field = structure.fields[i];
    if (i > 0 && notes.followsEmptyLine(field.range, structure.fields[i - 1].range))
      text += "\n";
    const Code initial = field.type->is(TypeKind::Bool) ? list("", {}) : zero(field.type);
    text += commentText(field.comment) + memoryType(field.type) + " " +
            declarator(memoryType(field.type), names.of(&field), initial) + ";";
    const std::string trailing = notes.trailingComment(field.range);
    text += trailing.empty() ? "\n" : " " + trailing + "\n";
  }
  const Type *self = nullptr;
  for (const Type *compared : comparedStructs)
    if (compared->structure == &structure)
      self = compared;
  if (self) {
    std::vector<std::string> parts;
    for (const typed::Field &field : structure.fields)
      parts.push_back(fmt::format("a.{0} == b.{0}", names.of(&field)));
    text +=
        fmt::format("\nfriend bool operator==(const {0} &a, const {0} &b) {{ return {1}; }}\n"
                    "friend bool operator!=(const {0} &a, const {0} &b) {{ return !(a == b); }}\n",
                    names.of(&structure), join(parts, " && "));
  }
  return text + "};\n";
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

std::string ModulePrinter::constant(const typed::Variable &constant) {
  FunctionPrinter printer(*this, nullptr);
  const std::string &name = names.of(&constant);
  const Code initialiser = printer.initialiser(*constant.init);
  const bool isPlain = isConstexpr(constant.type, constant.constant.get(), name, initialiser) ||
                       printer.isTable(*constant.init);
  std::string text = commentText(constant.comment) + "inline " +
                     (isPlain ? "constexpr " : "const ") + type(constant.type) + " " +
                     declarator(type(constant.type), name, initialiser) + ";";
  const std::string trailing = notes.trailingComment(constant.init->range);
  return text + (trailing.empty() ? "\n" : " " + trailing + "\n");
}

std::string ModulePrinter::freeFunctions() {
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
  std::string text;
  for (const typed::Function *function : prototypes)
    if (!isPartOfStates(*function))
      text += signature(*function, false) + ";\n";
  for (const auto &function : module.functions)
    if (function->body && !isPartOfStates(*function))
      text += "\n" + this->function(*function, false);
  return text;
}

//===----------------------------------------------------------------------===//
// Classes
//===----------------------------------------------------------------------===//

std::string ModulePrinter::member(const typed::Member &member) {
  FunctionPrinter printer(*this, nullptr, member.owner);
  std::string text = commentText(member.comment);
  const std::string &name = names.of(&member);
  if (member.isConst) {
    const Code initialiser = member.init ? printer.initialiser(*member.init) : zero(member.type);
    const bool isPlain = isConstexpr(member.type, member.constant.get(), name, initialiser) ||
                         (member.init && printer.isTable(*member.init));
    text += std::string(isPlain ? "static constexpr " : "inline static const ") +
            type(member.type) + " " + declarator(type(member.type), name, initialiser) + ";";
  } else {
    Code value = member.init ? printer.initialiser(*member.init) : zero(member.type);
    if (member.type->is(TypeKind::Bool)) // converts in braces
      value = member.init ? list("", {value}) : list("", {});
    text += memoryType(member.type) + " " + declarator(memoryType(member.type), name, value) + ";";
  }
  const std::string trailing =
      notes.trailingComment(member.init ? member.init->range : member.range);
  return text + (trailing.empty() ? "\n" : " " + trailing + "\n");
}

std::string ModulePrinter::classDefinition(const typed::Class &definition) {
  std::string text = commentText(definition.comment) + cpp::text(lineDirective(definition.range));
  const std::string base =
      definition.base ? names.of(definition.base) : "rtsl::" + nameOfRoot(definition.root);
  std::vector<std::string> parts; // with an empty line between them
  std::string members;
  SourceRange previous;
  for (const auto &member : definition.members) {
    if (member->access == ast::Access::Scratch)
      continue;
    if (!members.empty() && notes.followsEmptyLine(member->range, previous))
      members += "\n";
    previous = member->range;
    members += this->member(*member);
  }
  if (!members.empty())
    parts.push_back(members);
  if (const std::string scratch = scratchStructure(definition); !scratch.empty())
    parts.push_back(scratch);

  // Overloads of a base's functions do not hide the others. States may have other names.
  std::set<std::string> shown;
  for (const auto &function : definition.functions)
    for (const typed::Class *at = definition.base; at; at = at->base)
      for (const auto &method : at->functions)
        if (method->name == function->name && !method->isConstructor && !isPartOfStates(*method) &&
            !isPartOfStates(*function) &&
            (!isSplit(*at, *method) || nameOfMachine(*at, *method) == names.of(method.get())) &&
            !typed::sameParameters(*method, *function) && shown.insert(method->name).second)
          parts.push_back("using " + names.of(at) + "::" + names.of(method.get()) + ";\n");
  for (const auto &function : definition.functions) {
    const bool isMachine = function->body && isSplit(definition, *function);
    if (function->body && (isMachine || !isPartOfStates(*function)))
      parts.push_back(isMachine ? stateMachine(definition, *function)
                                : this->function(*function, true));
  }
  for (std::string &machine : inheritedStateMachines(definition))
    parts.push_back(std::move(machine));
  return text + "struct " + names.of(&definition) + " : " + base + " {\n" + join(parts, "\n") +
         "};\n";
}

//===----------------------------------------------------------------------===//
// The file
//===----------------------------------------------------------------------===//

std::string ModulePrinter::run() {
  // From the inside out: what functions ask for is known when they have been printed.
  std::string constants;
  for (const auto &constant : module.constants)
    constants += this->constant(*constant);
  const std::string functions = freeFunctions();
  std::string classes;
  for (const auto &definition : module.classes)
    classes += "\n" + classDefinition(*definition);
  const std::string hitErrors = this->hitErrors();
  std::string entries;
  if (!module.classes.empty()) {
    entries = slots();
    entries += description();
  }
  std::string structs;
  for (const auto &structure : module.structs)
    structs += "\n" + this->structure(*structure);
  const std::string methods = referenceMethods();
  const std::string references = this->references();

  std::string text = options.fast ? "// Made by rtslc --emit=cpp --fp=fast: what it computes "
                                    "differs in the last digits with the compiler\n"
                                    "// and its options.\n#define RTSL_FAST\n"
                                  : "// Made by rtslc --emit=cpp. Compiled with any options but "
                                    "-ffast-math it computes what rtslc's own\n"
                                    "// machine code computes, to the last bit.\n";
  if (!options.whyCalls.empty())
    text += "//\n// Rays are calls, not the ends of states: " + options.whyCalls + ".\n";
  if (!options.checkIndices)
    text += "#define RTSL_UNCHECKED // indices are trusted (--unchecked)\n";
  text += "#include <rtsl/shader.h>\n\n";
  text += "namespace " + options.name + " {\n\n";
  text += fmt::format("using State = rtsl::State<{0}>;\nusing Color = rtsl::Color<{0}>;\n",
                      options.colorComponents);
  auto add =
      [&](const std::string &part) { // with an empty line above; of two the formatter makes one
        if (!part.empty())
          text += "\n" + part;
      };
  if (!calledMethods.empty()) // what they are given says where they begin
    add(stepNumbers());
  add(references);
  add(structs);
  add(constants);
  add(functions);
  if (!module.classes.empty()) // what is called once only is inlined then, however long it is
    add("namespace {\n");
  if (!module.classes.empty() && (!methods.empty() || !entries.empty()))
    add(fmt::format("enum class Id : std::uint32_t {{ {} }};\n", [&] {
      std::vector<std::string> ids;
      unsigned next = 1;
      for (const auto &definition : module.classes)
        ids.push_back(fmt::format("{} = {}", names.of(definition.get()), next++));
      return join(ids, ", ");
    }()));
  if (calledMethods.empty())
    add(stepNumbers());
  add(classes);
  if (!module.classes.empty())
    add("} // namespace\n");
  add(methods);
  add(hitErrors);
  add(entries);
  text += "\n} // namespace " + options.name + "\n";
  if (!module.classes.empty())
    text += fmt::format(
        "\n/// For rtsl::program in C++, and rtslSceneCreate in C.\n"
        "extern \"C\" const RtslShaders *{0}_shaders();\n"
        "const RtslShaders *{0}_shaders() {{\n"
        "  static const RtslShaders shaders = {0}::describe();\n  return &shaders;\n}}\n",
        options.name);
  return format(text);
}

std::optional<std::string> print(const typed::Module &module, const ModuleFacts &facts,
                                 const Options &options, Diagnostics &diagnostics,
                                 const StateProgram *states) {
  ModulePrinter printer(module, facts, options, diagnostics, states);
  std::string text = printer.run();
  if (printer.failed || diagnostics.hasErrors())
    return std::nullopt;
  return text;
}

} // namespace rtsl::cpp
