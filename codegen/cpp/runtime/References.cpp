#include "codegen/cpp/runtime/References.h"

#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/states/CalledMethods.h"
#include "sema/typed/Analysis.h"

namespace rtsl::cpp {

References::References(Context &context)
    : context(context), mayReferToNothing(typed::mayReferToNothing(context.module)),
      lookupsNest(typed::lookupsNest(context.module)) {}

static std::vector<Parameter> parametersOf(Context &context, const typed::Function &function) {
  std::vector<Parameter> parameters = {byReference("State", "rt")};
  for (std::size_t i = 0; i != function.parameters.size(); ++i) {
    const typed::Variable &parameter = *function.parameters[i];
    const bool isIn = parameter.direction == ast::Direction::In;
    const std::string type = context.types.of(parameter.type),
                      name = context.signatures.parameterName(function, i);
    parameters.push_back(isIn ? byValue(type, name) : byReference(type, name));
  }
  return parameters;
}

/// The method of a type of references; a prototype without a body.
Function References::prototype(const ThroughReference &through) {
  Function made;
  made.isConst = true;
  if (through.function) {
    made.result = context.types.of(through.function->returnType);
    made.name = context.names.of(through.function);
    made.parameters = parametersOf(context, *through.function);
  } else {
    made.result = through.method == "lookup" ? "Color" : "float";
    made.name = through.method;
    made.parameters = {byReference("State", "rt")};
  }
  return made;
}

Declarations References::types() {
  Declarations all;
  for (const CalledMethod &called : context.split.calledMethods)
    context.required.references.try_emplace(called.definition->name);
  bool mentionsStructs = !context.split.calledMethods.empty();
  for (const auto &[className, methods] : context.required.references)
    for (const ThroughReference &through : methods)
      mentionsStructs |= through.function != nullptr;
  for (const auto &structure : context.module.structs)
    if (mentionsStructs)
      all.push_back(declareStruct(context.names.of(structure.get())));
  for (const auto &[className, methods] : context.required.references) {
    Struct made = {context.names.reference(className), "rtsl::Reference", false, {}};
    made.members.push_back(declare(Using{"Reference::Reference"}));
    made.members.push_back(
        declare(Variable{"static constexpr", "const char *", {"className", string(className)}}));
    for (const ThroughReference &through : methods)
      made.members.push_back(declare(prototype(through)));
    append(made.members, callStructures(context, className));
    appendApart(all, declare(std::move(made), "/// Any `" + className + "` of the scene."));
  }
  return all;
}

/// `const rtsl::NestedLookup nested(rt);`: restores what a texture wrote when it ends.
static Statement nestedLookup() {
  Statement made = declaration("const", "rtsl::NestedLookup", "nested",
                               construct("rtsl::NestedLookup", {name("rt")}));
  made.declarators.front().isDirect = true;
  return made;
}

/// The body of `lookup` or `lookupFloat` of a type of references.
Statements References::lookUp(const std::string &className, bool isColor) {
  Statements body = {lookupsNest ? nestedLookup()
                                 : statement(call("rtsl::clearTexture", {cpp::name("rt")}))};
  append(body, dispatch(
                   context.names, classesBelow(context.module, className),
                   [&](const typed::Class &definition) -> Statements {
                     const typed::Function *lookup = definition.findMethod("lookup");
                     if (!lookup)
                       return {};
                     return {statement(callMember(objectOf(context.names, definition),
                                                  context.names.of(lookup), {cpp::name("rt")}))};
                   },
                   mayReferToNothing));
  body.push_back(
      returning(cpp::member(cpp::name("rt"), isColor ? "TextureColor" : "FloatTextureValue")));
  return body;
}

/// The body of a method of a type of references: calls that of the object's class.
Statements References::callMethod(const std::string &className, const typed::Function &function) {
  const std::vector<const typed::Class *> classes = classesBelow(context.module, className);
  const bool isVoid = function.returnType->is(TypeKind::Void);
  Statements body = dispatch(
      context.names, classes,
      [&](const typed::Class &definition) -> Statements {
        const typed::Function *method = findMethod(definition, function);
        if (!method)
          return {};
        std::vector<Code> args;
        if (context.signatures.takesState(*method))
          args.push_back(cpp::name("rt"));
        if (context.signatures.takesScratch(*method)) // what the hit so far has stored
          args.push_back(storedScratch(context.names, definition));
        for (std::size_t i = 0; i != function.parameters.size(); ++i)
          args.push_back(cpp::name(context.signatures.parameterName(function, i)));
        const Code made = callMember(objectOf(context.names, definition), context.names.of(method),
                                     std::move(args));
        return {isVoid ? statement(made) : returning(made)};
      },
      mayReferToNothing);
  if (classes.size() == 1 && !body.empty() && !mayReferToNothing)
    return body;
  Statements zeros; // the results of a call without an object
  for (std::size_t i = 0; i != function.parameters.size(); ++i)
    if (const typed::Variable &parameter = *function.parameters[i];
        parameter.direction == ast::Direction::Out)
      zeros.push_back(statement(assign(cpp::name(context.signatures.parameterName(function, i)),
                                       context.types.zero(parameter.type))));
  if (!isVoid)
    zeros.push_back(returning(list("", {})));
  body.insert(isVoid ? body.begin() : body.end(), zeros.begin(), zeros.end());
  return body;
}

Declarations References::methods() {
  Declarations all;
  for (const auto &[className, methods] : context.required.references)
    for (const ThroughReference &through : methods) {
      Function made = prototype(through);
      made.specifiers = "inline";
      made.name = context.names.reference(className) + "::" + made.name;
      made.body = through.function ? callMethod(className, *through.function)
                                   : lookUp(className, through.method == "lookup");
      appendApart(all, declare(std::move(made)));
    }
  return all;
}

} // namespace rtsl::cpp
