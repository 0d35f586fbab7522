//===- Entries.cpp - how the runtime and references reach the classes -----===//
#include "codegen/cpp/Printer.h"

#include "codegen/passes/errors/DeriveHitErrors.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

namespace rtsl::cpp {

void ModulePrinter::useThroughReference(const std::string &className, const std::string &method,
                                        const typed::Function *function) {
  std::vector<ThroughReference> &methods = referenced[className];
  for (const ThroughReference &known : methods)
    if (known.method == method && known.function == function)
      return;
  methods.push_back({method, function});
}

std::vector<const typed::Class *> ModulePrinter::classesBelow(const std::string &className) const {
  std::vector<const typed::Class *> classes;
  for (const auto &definition : module.classes)
    for (const typed::Class *at = definition.get(); at; at = at->base)
      if (at->name == className || (!at->base && at->root == className)) {
        classes.push_back(definition.get());
        break;
      }
  return classes;
}

const typed::Function *ModulePrinter::findMethod(const typed::Class &definition,
                                                 const typed::Function &like) const {
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      if (function->name == like.name && typed::sameParameters(*function, like))
        return function.get();
  return nullptr;
}

bool endsInReturn(const Statements &statements) {
  return !statements.empty() && statements.back().is(StatementKind::Return);
}

// A switch over the classes, or the statements alone if there is one. `run` gives nothing for a
// class that has no such method. `mayBeNone`: nothing happens if there is no object.
Statements ModulePrinter::dispatch(const std::vector<const typed::Class *> &classes,
                                   const std::function<Statements(const typed::Class &)> &run,
                                   bool mayBeNone) {
  Statement choice = simple(StatementKind::Switch);
  choice.value = staticCast("Id", call("rtsl::classOf", {cpp::name("rt"), cpp::name("object")}));
  for (const typed::Class *definition : classes) {
    Statements body = run(*definition);
    if (body.empty())
      continue;
    if (classes.size() == 1 && !mayBeNone)
      return body;
    if (classes.size() == 1)
      return {branch(binary(Operator::NotEqual, cpp::name("object"), integer(0)), std::move(body))};
    if (!endsInReturn(body))
      body.push_back(simple(StatementKind::Break));
    choice.arms.push_back(
        {{cpp::name("Id::" + names.of(definition))}, false, false, std::move(body)});
  }
  if (choice.arms.empty())
    return {};
  choice.arms.push_back({{}, true, false, {simple(StatementKind::Break)}});
  return {choice};
}

Code ModulePrinter::objectOf(const typed::Class &definition) const {
  return call(withParameters("rtsl::object", {names.of(&definition)}),
              {cpp::name("rt"), cpp::name("object")});
}

Code ModulePrinter::storedScratch(const typed::Class &definition) const {
  return call(withParameters("rtsl::loadScratch", {names.of(&definition) + "::Scratch"}),
              {cpp::name("rt")});
}

//===----------------------------------------------------------------------===//
// References
//===----------------------------------------------------------------------===//

static std::vector<Parameter> parametersOf(ModulePrinter &printer,
                                           const typed::Function &function) {
  std::vector<Parameter> parameters = {byReference("State", "rt")};
  for (std::size_t i = 0; i != function.parameters.size(); ++i) {
    const typed::Variable &parameter = *function.parameters[i];
    const bool isIn = parameter.direction == ast::Direction::In;
    const std::string type = printer.type(parameter.type),
                      name = printer.parameterName(function, i);
    parameters.push_back(isIn ? byValue(type, name) : byReference(type, name));
  }
  return parameters;
}

/// The method of a type of references; a prototype without a body.
Function ModulePrinter::referenceMethod(const ThroughReference &through) {
  Function made;
  made.isConst = true;
  if (through.function) {
    made.result = type(through.function->returnType);
    made.name = names.of(through.function);
    made.parameters = parametersOf(*this, *through.function);
  } else {
    made.result = through.method == "lookup" ? "Color" : "float";
    made.name = through.method;
    made.parameters = {byReference("State", "rt")};
  }
  return made;
}

Declarations ModulePrinter::references() {
  Declarations all;
  for (const CalledMethod &called : calledMethods)
    referenced.try_emplace(called.definition->name);
  bool mentionsStructs = !calledMethods.empty();
  for (const auto &[className, methods] : referenced)
    for (const ThroughReference &through : methods)
      mentionsStructs |= through.function != nullptr;
  for (const auto &structure : module.structs)
    if (mentionsStructs)
      all.push_back(declareStruct(names.of(structure.get())));
  for (const auto &[className, methods] : referenced) {
    Struct made = {names.reference(className), "rtsl::Reference", false, {}};
    made.members.push_back(declare(Using{"Reference::Reference"}));
    made.members.push_back(
        declare(Variable{"static constexpr", "const char *", {"className", string(className)}}));
    for (const ThroughReference &through : methods)
      made.members.push_back(declare(referenceMethod(through)));
    append(made.members, callStructures(className));
    appendApart(all, declare(std::move(made), "/// Any `" + className + "` of the scene."));
  }
  return all;
}

/// `const rtsl::NestedLookup nested(rt);`: what a texture wrote is there again afterwards.
static Statement nestedLookup() {
  Statement made = declaration("const", "rtsl::NestedLookup", "nested",
                               construct("rtsl::NestedLookup", {name("rt")}));
  made.declarators.front().isDirect = true;
  return made;
}

/// The body of `lookup` or `lookupFloat` of a type of references.
Statements ModulePrinter::lookUp(const std::string &className, bool isColor) {
  Statements body = {lookupsNest ? nestedLookup()
                                 : statement(call("rtsl::clearTexture", {cpp::name("rt")}))};
  append(body, dispatch(
                   classesBelow(className),
                   [&](const typed::Class &definition) -> Statements {
                     const typed::Function *lookup = definition.findMethod("lookup");
                     if (!lookup)
                       return {};
                     return {statement(
                         callMember(objectOf(definition), names.of(lookup), {cpp::name("rt")}))};
                   },
                   mayReferToNothing));
  body.push_back(
      returning(cpp::member(cpp::name("rt"), isColor ? "TextureColor" : "FloatTextureValue")));
  return body;
}

/// The body of a method of a type of references: calls that of the object's class.
Statements ModulePrinter::callThroughReference(const std::string &className,
                                               const typed::Function &function) {
  const std::vector<const typed::Class *> classes = classesBelow(className);
  const bool isVoid = function.returnType->is(TypeKind::Void);
  Statements body = dispatch(
      classes,
      [&](const typed::Class &definition) -> Statements {
        const typed::Function *method = findMethod(definition, function);
        if (!method)
          return {};
        std::vector<Code> args;
        if (takesState(*method))
          args.push_back(cpp::name("rt"));
        if (takesScratch(*method)) // what the hit so far has stored
          args.push_back(storedScratch(definition));
        for (std::size_t i = 0; i != function.parameters.size(); ++i)
          args.push_back(cpp::name(parameterName(function, i)));
        const Code made = callMember(objectOf(definition), names.of(method), std::move(args));
        return {isVoid ? statement(made) : returning(made)};
      },
      mayReferToNothing);
  if (classes.size() == 1 && !body.empty() && !mayReferToNothing)
    return body;
  Statements zeros; // the results of a call without an object
  for (std::size_t i = 0; i != function.parameters.size(); ++i)
    if (const typed::Variable &parameter = *function.parameters[i];
        parameter.direction == ast::Direction::Out)
      zeros.push_back(
          statement(assign(cpp::name(parameterName(function, i)), zero(parameter.type))));
  if (!isVoid)
    zeros.push_back(returning(list("", {})));
  body.insert(isVoid ? body.begin() : body.end(), zeros.begin(), zeros.end());
  return body;
}

Declarations ModulePrinter::referenceMethods() {
  Declarations all;
  for (const auto &[className, methods] : referenced)
    for (const ThroughReference &through : methods) {
      Function made = referenceMethod(through);
      made.specifiers = "inline";
      made.name = names.reference(className) + "::" + made.name;
      made.body = through.function ? callThroughReference(className, *through.function)
                                   : lookUp(className, through.method == "lookup");
      appendApart(all, declare(std::move(made)));
    }
  return all;
}

//===----------------------------------------------------------------------===//
// Slots
//===----------------------------------------------------------------------===//

namespace {
struct Slot {
  const char *base;
  const char *method;
};
constexpr Slot allSlots[] = {
#define RTSL_SLOT(base, method) {#base, #method},
#include "language/Slots.def"
#define RTSL_SAMPLING_SLOT(base, method) {#base, #method},
#include "language/SamplingSlots.def"
};
} // namespace

const typed::Function *slotMethod(const typed::Class &definition, const char *name) {
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      if (function->name == name && function->isStateMethod && function->parameters.empty())
        return function.get();
  return nullptr;
}

Statements ModulePrinter::withState(const Statements &body) const {
  const Code state =
      call(withParameters("rtsl::stateOf", {std::to_string(options.colorComponents)}),
           {cpp::name("ray")});
  Statements all = {declaration("State &", "rt", state)};
  append(all, body);
  return all;
}

Function slotFunction(const std::string &name, Statements body) {
  Function made;
  made.specifiers = "inline";
  made.result = "void";
  made.name = name;
  made.parameters = {byPointer("RtslState", "ray"), byValue("RtslRef", "object")};
  made.body = std::move(body);
  return made;
}

/// Calls the method of a slot on the object, if the class has it.
Statements ModulePrinter::callSlotMethod(const typed::Class &definition, const char *name) {
  const Code object = objectOf(definition), rt = cpp::name("rt");
  if (name == hitErrorMethod) {
    if (withHitErrors.count(&definition) == 0)
      return {};
    return {statement(call("boundHitError", {rt, object}))};
  }
  const typed::Function *method = slotMethod(definition, name);
  if (!method)
    return {};
  if (takesScratch(*method) && method->name == "intersect")
    return {statement(call("rtsl::intersect", {rt, object}))};
  std::vector<Code> arguments = {rt};
  if (takesScratch(*method))
    arguments.push_back(storedScratch(definition));
  return {statement(callMember(object, names.of(method), std::move(arguments)))};
}

Declarations ModulePrinter::slots() {
  Namespace made = {"slots", {}};
  for (const Slot &slot : allSlots) {
    if (isRunBySteps(slot.method))
      continue;
    const Statements body = dispatch(classesBelow(slot.base), [&](const typed::Class &definition) {
      return callSlotMethod(definition, slot.method);
    });
    if (body.empty())
      continue;
    appendApart(made.members, declare(slotFunction(slot.method, withState(body))));
    filledSlots.emplace_back(slot.base, slot.method);
  }
  appendApart(made.members, payloadSlots());
  appendApart(made.members, runState());
  Declarations all = {
      declare(OnlyComment{},
              "//===----------------------------------------------------------------------===//\n"
              "// What the runtime asks for\n"
              "//===----------------------------------------------------------------------===//")};
  appendApart(all, declare(std::move(made)));
  return all;
}

} // namespace rtsl::cpp
