//===- Entries.cpp - how the runtime and references reach the classes -----===//
#include "codegen/cpp/Printer.h"

#include "codegen/passes/errors/DeriveHitErrors.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

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

static std::string parameterList(ModulePrinter &printer, const typed::Function &function) {
  std::vector<std::string> parameters = {"State &rt"};
  for (std::size_t i = 0; i != function.parameters.size(); ++i) {
    const typed::Variable &parameter = *function.parameters[i];
    parameters.push_back(printer.type(parameter.type) +
                         (parameter.direction == ast::Direction::In ? " " : " &") +
                         printer.parameterName(function, i));
  }
  return join(parameters, ", ");
}

std::string ModulePrinter::references() {
  std::string text;
  for (const CalledMethod &called : calledMethods)
    referenced.try_emplace(called.definition->name);
  bool mentionsStructs = !calledMethods.empty();
  for (const auto &[className, methods] : referenced)
    for (const ThroughReference &through : methods)
      mentionsStructs |= through.function != nullptr;
  for (const auto &structure : module.structs)
    if (mentionsStructs)
      text += "struct " + names.of(structure.get()) + ";\n";
  for (const auto &[className, methods] : referenced) {
    text += "\n/// Any `" + className + "` of the scene.\nstruct " + names.reference(className) +
            " : rtsl::Reference {\nusing Reference::Reference;\nstatic constexpr const char "
            "*className = \"" +
            className + "\";\n";
    for (const ThroughReference &through : methods) {
      if (through.function)
        text += type(through.function->returnType) + " " + names.of(through.function) + "(" +
                parameterList(*this, *through.function) + ") const;\n";
      else
        text += std::string(through.method == "lookup" ? "Color" : "float") + " " + through.method +
                "(State &rt) const;\n";
    }
    text += callStructures(className) + "};\n";
  }
  return text;
}

/// `const rtsl::NestedLookup nested(rt);`: what a texture wrote is there again afterwards.
static Statement nestedLookup() {
  Statement made = declaration("const", "rtsl::NestedLookup", "nested",
                               construct("rtsl::NestedLookup", {name("rt")}));
  made.declarators.front().isDirect = true;
  return made;
}

std::string ModulePrinter::referenceMethods() {
  std::string text;
  for (const auto &[className, methods] : referenced) {
    const std::vector<const typed::Class *> classes = classesBelow(className);
    for (const ThroughReference &through : methods) {
      if (!through.function) {
        const bool isColor = through.method == "lookup";
        const Code state =
            cpp::member(cpp::name("rt"), isColor ? "TextureColor" : "FloatTextureValue");
        Statements body = {lookupsNest ? nestedLookup()
                                       : statement(call("rtsl::clearTexture", {cpp::name("rt")}))};
        append(body, dispatch(
                         classes,
                         [&](const typed::Class &definition) -> Statements {
                           const typed::Function *lookup = definition.findMethod("lookup");
                           if (!lookup)
                             return {};
                           return {statement(callMember(objectOf(definition), names.of(lookup),
                                                        {cpp::name("rt")}))};
                         },
                         mayReferToNothing));
        body.push_back(returning(state));
        text += fmt::format("\ninline {} {}::{}(State &rt) const {{\n{}}}\n",
                            isColor ? "Color" : "float", names.reference(className), through.method,
                            print(body));
        continue;
      }
      const typed::Function &function = *through.function;
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
      const bool isDirect = classes.size() == 1 && !body.empty() && !mayReferToNothing;
      Statements zeros; // what the method of no object gives
      for (std::size_t i = 0; i != function.parameters.size() && !isDirect; ++i)
        if (const typed::Variable &parameter = *function.parameters[i];
            parameter.direction == ast::Direction::Out)
          zeros.push_back(
              statement(assign(cpp::name(parameterName(function, i)), zero(parameter.type))));
      if (!isVoid && !isDirect)
        zeros.push_back(returning(list("", {})));
      body.insert(isVoid ? body.begin() : body.end(), zeros.begin(), zeros.end());
      text += fmt::format("\ninline {} {}::{}({}) const {{\n{}}}\n", type(function.returnType),
                          names.reference(className), names.of(&function),
                          parameterList(*this, function), print(body));
    }
  }
  return text;
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

std::string ModulePrinter::slots() {
  std::string text =
      "\n//===----------------------------------------------------------------------===//\n"
      "// What the runtime asks for\n"
      "//===----------------------------------------------------------------------===//\n"
      "\nnamespace slots {\n";
  for (const Slot &slot : allSlots) {
    if (isRunBySteps(slot.method))
      continue;
    const std::vector<const typed::Class *> classes = classesBelow(slot.base);
    const Statements body = dispatch(classes, [&](const typed::Class &definition) -> Statements {
      if (slot.method == hitErrorMethod) {
        if (withHitErrors.count(&definition) == 0)
          return {};
        return {statement(call("boundHitError", {cpp::name("rt"), objectOf(definition)}))};
      }
      const typed::Function *method = slotMethod(definition, slot.method);
      if (!method)
        return {};
      const Code object = objectOf(definition), rt = cpp::name("rt");
      if (takesScratch(*method) && method->name == "intersect")
        return {statement(call("rtsl::intersect", {rt, object}))};
      const std::vector<Code> arguments = takesScratch(*method)
                                              ? std::vector<Code>{rt, storedScratch(definition)}
                                              : std::vector<Code>{rt};
      return {statement(callMember(object, names.of(method), arguments))};
    });
    if (body.empty())
      continue;
    text += fmt::format("\ninline void {}(RtslState *ray, RtslRef object) {{\n{}}}\n", slot.method,
                        print(withState(body)));
    filledSlots.emplace_back(slot.base, slot.method);
  }
  return text + payloadSlots() + runState() + "\n} // namespace slots\n";
}

} // namespace rtsl::cpp
