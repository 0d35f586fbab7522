#include "codegen/cpp/runtime/Description.h"

#include "codegen/cpp/functions/Literals.h"
#include "codegen/cpp/runtime/Dispatch.h"
#include "codegen/cpp/runtime/Payloads.h"
#include "codegen/cpp/runtime/RunState.h"
#include "codegen/link/Members.h"
#include "codegen/link/RequiredMembers.h"
#include "runtime/device/ray/Abi.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace rtsl::cpp {

namespace {

struct Need {
  std::uint32_t bit;
  const char *flag;
};
constexpr Need allNeeds[] = {{RTSL_NEEDS_NORMALS, "RTSL_NEEDS_NORMALS"},
                             {RTSL_NEEDS_TEXTURE_COORDINATES, "RTSL_NEEDS_TEXTURE_COORDINATES"},
                             {RTSL_NEEDS_DERIVATIVES, "RTSL_NEEDS_DERIVATIVES"},
                             {RTSL_NEEDS_TRANSFORMS, "RTSL_NEEDS_TRANSFORMS"},
                             {RTSL_NEEDS_INSTANCE_ID, "RTSL_NEEDS_INSTANCE_ID"},
                             {RTSL_NEEDS_INVERSE_DIRECTION, "RTSL_NEEDS_INVERSE_DIRECTION"},
                             {RTSL_NEEDS_TIME, "RTSL_NEEDS_TIME"},
                             {RTSL_NEEDS_LAUNCH, "RTSL_NEEDS_LAUNCH"},
                             {RTSL_NEEDS_LENS, "RTSL_NEEDS_LENS"},
                             {RTSL_NEEDS_SAMPLING, "RTSL_NEEDS_SAMPLING"},
                             {RTSL_NEEDS_CANDIDATE, "RTSL_NEEDS_CANDIDATE"},
                             {RTSL_NEEDS_ANY_HIT, "RTSL_NEEDS_ANY_HIT"},
                             {RTSL_NEEDS_HIT_ERRORS, "RTSL_NEEDS_HIT_ERRORS"},
                             {RTSL_NEEDS_ATTRIBUTES, "RTSL_NEEDS_ATTRIBUTES"},
                             {RTSL_NEEDS_CAMERA_RAY, "RTSL_NEEDS_CAMERA_RAY"},
                             {RTSL_NEEDS_EMITTERS, "RTSL_NEEDS_EMITTERS"},
                             {RTSL_NEEDS_FOOTPRINT, "RTSL_NEEDS_FOOTPRINT"},
                             {RTSL_NEEDS_NORMAL_CHANGES, "RTSL_NEEDS_NORMAL_CHANGES"}};

constexpr std::uint32_t bitsOf(const Need *first, const Need *last) {
  return first == last ? 0 : first->bit | bitsOf(first + 1, last);
}
static_assert(bitsOf(std::begin(allNeeds), std::end(allNeeds)) == RTSL_NEEDS_ALL,
              "a part of a hit has no name");

/// `RTSL_NEEDS_NORMALS | RTSL_NEEDS_TIME`; nothing where nothing is needed.
Code flagsOfNeeds(std::uint32_t needs) {
  Code flags;
  for (const Need &need : allNeeds)
    if (needs & need.bit)
      flags = flags ? binary(Operator::BitOr, flags, name(need.flag)) : name(need.flag);
  return flags;
}

/// `&Class::member`
Code addressOf(const std::string &className, const std::string &member) {
  return unary(UnaryOperator::Address, name(className + "::" + member));
}

/// `program.function(arguments);`
Statement onProgram(const std::string &function, std::vector<Code> arguments) {
  return statement(callMember(name("program"), function, std::move(arguments)));
}

} // namespace

/// All structs below a type.
static void structsOf(const Type *type, std::vector<const typed::Struct *> &found) {
  if (type->is(TypeKind::Array) || type->is(TypeKind::Buffer))
    return structsOf(type->element, found);
  if (!type->is(TypeKind::Struct))
    return;
  for (const typed::Field &field : type->structure->fields)
    structsOf(field.type, found);
  if (std::find(found.begin(), found.end(), type->structure) == found.end())
    found.push_back(type->structure);
}

/// What a scene sets: the structs of members and of constructors' parameters.
static Declarations describeStructs(const Context &context) {
  std::vector<const typed::Struct *> described;
  for (const auto &definition : context.module.classes) {
    for (const auto &member : definition->members)
      if (!member->isConst && member->access != ast::Access::Scratch)
        structsOf(member->type, described);
    for (const auto &function : definition->functions)
      if (function->isConstructor)
        for (const auto &parameter : function->parameters)
          structsOf(parameter->type, described);
  }
  Declarations functions;
  for (const typed::Struct *structure : described) {
    const Code fields = name("fields");
    Function made;
    made.specifiers = "inline";
    made.result = "void";
    made.name = "describeFields";
    made.parameters = {byReference(
        withParameters("rtsl::StructDescription", {context.names.of(structure)}), "fields")};
    made.body = Statements{statement(assign(cpp::member(fields, "name"), string(structure->name)))};
    for (const typed::Field &field : structure->fields)
      made.body->push_back(statement(callMember(
          fields, "add",
          {string(field.name), addressOf(context.names.of(structure), context.names.of(&field))})));
    appendApart(functions, declare(std::move(made)));
  }
  return functions;
}

/// `rtsl::Range{0.0f, 1.0f, true, true}`: the bounds, and whether they belong to it.
static Code shownRange(const Range &range) {
  const auto bound = [](double value) { // large integers are no floats
    const auto rounded = float(value);
    return double(rounded) == value ? floatLiteral(rounded) : doubleLiteral(value);
  };
  return list("rtsl::Range", {bound(range.low), bound(range.high), boolean(range.includesLow),
                              boolean(range.includesHigh)});
}

/// `described.constructor<&Class::Class>({"parameter", {"parameter", range}, ...})`
static Code describeConstructor(const Names &names, const Code &described,
                                const typed::Function &constructor) {
  std::vector<Code> parameters;
  for (std::size_t i = 0; i < constructor.parameters.size(); ++i) {
    const typed::Variable &parameter = *constructor.parameters[i];
    const Code name =
        string(parameter.name.empty() ? "unnamed" + std::to_string(i) : parameter.name);
    parameters.push_back(parameter.values ? list("", {name, shownRange(*parameter.values)}) : name);
  }
  const std::string address = "&" + names.of(constructor.owner) + "::" + names.of(&constructor);
  return callMember(described, withParameters("constructor", {address}),
                    {list("", std::move(parameters))});
}

/// The methods that a class has, inherited ones too: `shade`, `closestHit(Radiance)`.
static std::vector<Code> shownMethods(const typed::Class &definition) {
  std::set<std::string> methods;
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      methods.insert(
          typed::takesPayload(*function)
              ? fmt::format("{}({})", function->name, toString(function->parameters.front()->type))
              : function->name);
  std::vector<Code> shown;
  for (const std::string &method : methods)
    shown.push_back(string(method));
  return shown;
}

/// `described.member("name", &Class::name, rtsl::Access::Public)`
static Code describeMember(const Names &names, const Code &described, const std::string &className,
                           const typed::Member &member, bool isRequired) {
  const bool isPublic = member.access == ast::Access::Public;
  std::vector<Code> arguments = {
      string(member.name), addressOf(className, names.of(&member)),
      cpp::name(isPublic ? "rtsl::Access::Public" : "rtsl::Access::Private")};
  if (member.init || member.isOptional)
    arguments.push_back(cpp::name("rtsl::Default::Given"));
  else if (isRequired)
    arguments.push_back(cpp::name("rtsl::Default::Required"));
  else if (member.values)
    arguments.push_back(cpp::name("rtsl::Default::None"));
  if (member.values)
    arguments.push_back(shownRange(*member.values));
  return callMember(described, "member", std::move(arguments));
}

static Statement describeClass(const Context &context, const typed::Class &definition,
                               RequiredMembers &required) {
  const std::string &own = context.names.of(&definition);
  const std::string &base = definition.base ? definition.base->name : definition.root;
  Code described = callMember(cpp::name("program"), withParameters("add", {own}),
                              {staticCast("std::uint32_t", cpp::name("Id::" + own)),
                               string(definition.name), string(base), string(definition.root)});
  for (const typed::Member *member : allMembers(definition))
    if (!member->isConst && member->access != ast::Access::Scratch)
      described =
          describeMember(context.names, described, own, *member, required.has(definition, *member));
  if (const typed::Function *constructor = findConstructor(definition))
    described = describeConstructor(context.names, described, *constructor);
  if (std::vector<Code> methods = shownMethods(definition); !methods.empty())
    described = callMember(described, "methods", {list("", std::move(methods))});
  if (const Code needs = flagsOfNeeds(context.facts.needsOfClass.at(&definition)))
    described = callMember(described, "needs", {needs});
  if (const std::uint32_t attributes = context.facts.meshAttributesOfClass.at(&definition))
    described = callMember(described, "attributes", {cpp::integer(attributes)});
  std::vector<std::string> queried;
  for (const typed::Function *anyHit : payloadMethods(definition, "anyHit"))
    queried.push_back(context.names.of(anyHit->parameters.front()->type->structure));
  if (!queried.empty())
    described = callMember(described, withParameters("anyHitFor", queried), {});
  return statement(described);
}

static Statements describeFeatures(const Options &options) {
  Code features;
  auto add = [&](bool isOn, const char *flag) {
    if (isOn)
      features = features ? binary(Operator::BitOr, features, name(flag)) : name(flag);
  };
  add(options.exceptions, "RTSL_FEATURE_EXCEPTIONS");
  add(options.prints, "RTSL_FEATURE_PRINT");
  add(options.undefined & RTSL_FEATURE_UNDEFINED_BYTES, "RTSL_FEATURE_UNDEFINED_BYTES");
  add(options.undefined & RTSL_FEATURE_UNDEFINED_NAN, "RTSL_FEATURE_UNDEFINED_NAN");
  add(options.sampler & RTSL_FEATURE_SAMPLER_R2, "RTSL_FEATURE_SAMPLER_R2");
  add(options.sampler & RTSL_FEATURE_SAMPLER_SOBOL, "RTSL_FEATURE_SAMPLER_SOBOL");
  return features ? Statements{onProgram("features", {features})} : Statements();
}

/// The arguments of Program::meshAttribute: the name and the places of an attribute, with those of
/// its changes if any is read.
static std::vector<Code> placesOf(const MeshAttributeFacts &attribute) {
  const auto place = [](std::uint32_t word) {
    return word == RTSL_NOT_READ ? cpp::name("RTSL_NOT_READ") : integer(word);
  };
  std::vector<Code> arguments = {string(attribute.name), place(attribute.offset)};
  if (attribute.changes[0] != RTSL_NOT_READ || attribute.changes[1] != RTSL_NOT_READ)
    for (const std::uint32_t change : attribute.changes)
      arguments.push_back(place(change));
  return arguments;
}

Declarations description(Context &context, const StateEntries &entries,
                         const std::vector<FilledSlot> &filled) {
  Declarations all = describeStructs(context);
  Function made;
  made.specifiers = "static";
  made.result = "RtslShaders";
  made.name = "describe";
  Statements &body = made.body.emplace();
  const std::string components = std::to_string(context.options.colorComponents);
  body.push_back(cpp::declaration(withParameters("rtsl::Program", {components}), "program", {}));
  RequiredMembers required(context.module);
  for (const auto &definition : context.module.classes)
    body.push_back(describeClass(context, *definition, required));
  for (const MeshAttributeFacts &attribute : context.facts.meshAttributes)
    body.push_back(
        onProgram(withParameters("meshAttribute", {context.types.inMemory(attribute.type)}),
                  placesOf(attribute)));
  if (const Code needs = flagsOfNeeds(context.facts.needs))
    body.push_back(onProgram("needs", {needs}));
  for (const auto &[base, method] : filled)
    body.push_back(setSlot(base + "_" + method, method));
  append(body, describeFeatures(context.options));
  const std::vector<const typed::Class *> generations =
      classesBelow(context.module, "rt_RayGeneration");
  if (std::any_of(generations.begin(), generations.end(), [](const typed::Class *definition) {
        return slotMethod(*definition, "generate") != nullptr;
      }))
    body.push_back(onProgram("engine", {cpp::name("rtsl::runtime::Engine::Either")}));
  append(body, describePayloads(context, entries));
  append(body, RunState(context, entries).describe());
  body.push_back(returning(callMember(cpp::name("program"), "finish", {})));
  appendApart(all, declare(std::move(made)));
  return all;
}

} // namespace rtsl::cpp
