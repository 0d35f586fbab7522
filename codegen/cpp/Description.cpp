//===- Description.cpp - what the runtime is told of a program ------------===//
//
//   static RtslShaders describe() {
//     rtsl::Program<3> program;
//     program.add<Glass>(static_cast<std::uint32_t>(Id::Glass), "Glass", ...).member(...).needs(...);
//     program.slots().rt_Material_shade = &slots::shade;
//     ...
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "codegen/link/Members.h"
#include "runtime/device/ray/Abi.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

namespace {

struct Need {
  std::uint32_t bit;
  const char *word;
};
constexpr Need allNeeds[] = {{RTSL_NEEDS_NORMALS, "RTSL_NEEDS_NORMALS"},
                             {RTSL_NEEDS_TEXTURE_COORDINATES, "RTSL_NEEDS_TEXTURE_COORDINATES"},
                             {RTSL_NEEDS_DERIVATIVES, "RTSL_NEEDS_DERIVATIVES"},
                             {RTSL_NEEDS_TRANSFORMS, "RTSL_NEEDS_TRANSFORMS"},
                             {RTSL_NEEDS_INVERSE_DIRECTION, "RTSL_NEEDS_INVERSE_DIRECTION"},
                             {RTSL_NEEDS_TIME, "RTSL_NEEDS_TIME"},
                             {RTSL_NEEDS_LAUNCH, "RTSL_NEEDS_LAUNCH"},
                             {RTSL_NEEDS_LENS, "RTSL_NEEDS_LENS"},
                             {RTSL_NEEDS_SAMPLING, "RTSL_NEEDS_SAMPLING"},
                             {RTSL_NEEDS_CANDIDATE, "RTSL_NEEDS_CANDIDATE"},
                             {RTSL_NEEDS_ANY_HIT, "RTSL_NEEDS_ANY_HIT"},
                             {RTSL_NEEDS_HIT_ERRORS, "RTSL_NEEDS_HIT_ERRORS"}};

/// `.needs(RTSL_NEEDS_NORMALS | RTSL_NEEDS_TIME)`; empty where nothing is needed.
std::string callOfNeeds(const char *function, std::uint32_t needs) {
  std::vector<std::string> words;
  for (const Need &need : allNeeds)
    if (needs & need.bit)
      words.emplace_back(need.word);
  return words.empty() ? "" : std::string(function) + "(" + join(words, " | ") + ")";
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
std::string ModulePrinter::describeStructs() {
  std::vector<const typed::Struct *> described;
  for (const auto &definition : module.classes) {
    for (const auto &member : definition->members)
      if (!member->isConst && member->access != ast::Access::Scratch)
        structsOf(member->type, described);
    for (const auto &function : definition->functions)
      if (function->isConstructor)
        for (const auto &parameter : function->parameters)
          structsOf(parameter->type, described);
  }
  std::string text;
  for (const typed::Struct *structure : described) {
    text += fmt::format("\ninline void describeFields(rtsl::StructDescription<{0}> &fields) "
                        "{{\nfields.name = \"{1}\";\n",
                        names.of(structure), structure->name);
    for (const typed::Field &field : structure->fields)
      text += fmt::format("fields.add(\"{}\", &{}::{});\n", field.name, names.of(structure),
                          names.of(&field));
    text += "}\n";
  }
  return text;
}

std::string ModulePrinter::describeConstructor(const typed::Function &constructor) {
  std::vector<std::string> parameters;
  for (std::size_t i = 0; i < constructor.parameters.size(); ++i) {
    const std::string &parameter = constructor.parameters[i]->name;
    parameters.push_back(
        fmt::format("\"{}\"", parameter.empty() ? "unnamed" + std::to_string(i) : parameter));
  }
  return fmt::format(".constructor<&{}::{}>({{{}}})", names.of(constructor.owner),
                     names.of(&constructor), join(parameters, ", "));
}

/// The methods that a class has, inherited ones too: `shade`, `closestHit(Radiance)`.
static std::set<std::string> shownMethods(const typed::Class &definition) {
  std::set<std::string> methods;
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &function : at->functions)
      methods.insert(typed::takesPayload(*function)
                         ? fmt::format("\"{}({})\"", function->name,
                                       toString(function->parameters.front()->type))
                         : "\"" + function->name + "\"");
  return methods;
}

std::string ModulePrinter::describeClass(const typed::Class &definition) {
  const std::string &name = names.of(&definition);
  std::string text = fmt::format(
      "program.add<{0}>(static_cast<std::uint32_t>(Id::{0}), \"{1}\", \"{2}\", \"{3}\")", name,
      definition.name, definition.base ? definition.base->name : definition.root, definition.root);
  for (const typed::Member *member : allMembers(definition)) {
    if (member->isConst || member->access == ast::Access::Scratch)
      continue;
    text +=
        fmt::format(".member(\"{}\", &{}::{}, rtsl::Access::{}{})", member->name, name,
                    names.of(member), member->access == ast::Access::Public ? "Public" : "Private",
                    member->init || member->isOptional ? ", rtsl::Default::Given" : "");
  }
  if (const typed::Function *constructor = findConstructor(definition))
    text += describeConstructor(*constructor);
  if (const std::set<std::string> methods = shownMethods(definition); !methods.empty())
    text += fmt::format(".methods({{{}}})", fmt::join(methods, ", "));
  text += callOfNeeds(".needs", facts.needsOfClass.at(&definition));
  std::vector<std::string> asked;
  for (const typed::Function *anyHit : payloadMethods(definition, "anyHit"))
    asked.push_back(names.of(anyHit->parameters.front()->type->structure));
  if (!asked.empty())
    text += fmt::format(".asks<{}>()", fmt::join(asked, ", "));
  return text + ";\n";
}

std::string ModulePrinter::describeFeatures() const {
  std::vector<std::string> features;
  if (options.exceptions)
    features.emplace_back("RTSL_FEATURE_EXCEPTIONS");
  if (options.prints)
    features.emplace_back("RTSL_FEATURE_PRINT");
  if (options.undefined & RTSL_FEATURE_UNDEFINED_BYTES)
    features.emplace_back("RTSL_FEATURE_UNDEFINED_BYTES");
  if (options.undefined & RTSL_FEATURE_UNDEFINED_NAN)
    features.emplace_back("RTSL_FEATURE_UNDEFINED_NAN");
  return features.empty() ? "" : "program.features(" + join(features, " | ") + ");\n";
}

std::string ModulePrinter::description() {
  std::string text = describeStructs();
  text += fmt::format("\nstatic RtslShaders describe() {{\nrtsl::Program<{}> program;\n",
                      options.colorComponents);
  for (const auto &definition : module.classes)
    text += describeClass(*definition);
  if (const std::string needs = callOfNeeds("program.needs", facts.needs); !needs.empty())
    text += needs + ";\n";
  for (const auto &[base, method] : filledSlots)
    text += fmt::format("program.slots().{0}_{1} = &slots::{1};\n", base, method);
  text += describeFeatures();
  const std::vector<const typed::Class *> generations = classesBelow("rt_RayGeneration");
  if (std::any_of(generations.begin(), generations.end(), [](const typed::Class *definition) {
        return slotMethod(*definition, "generate") != nullptr;
      }))
    text += "program.engine(rtsl::runtime::Engine::Either);\n";
  return text + describePayloads() + describeStates() + "return program.finish();\n}\n";
}

} // namespace rtsl::cpp
