//===- File.cpp - a module as a file of C++ --------------------------------===//
#include "codegen/cpp/Classes.h"
#include "codegen/cpp/Format.h"
#include "codegen/cpp/HitErrors.h"
#include "codegen/cpp/runtime/Description.h"
#include "codegen/cpp/runtime/References.h"
#include "codegen/cpp/runtime/RunState.h"
#include "codegen/cpp/tree/Print.h"

namespace rtsl::cpp {

/// What stands above the namespace: how the file was made, macros and includes.
static Declarations heading(const Options &options) {
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
static Declarations exported(const Options &options) {
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
static Declaration classNumbers(const Context &context) {
  Enum ids = {"Id", "std::uint32_t", {}};
  unsigned next = 1;
  for (const auto &definition : context.module.classes)
    ids.values.push_back({context.names.of(definition.get()), next++});
  return declare(std::move(ids));
}

/// The parts of the file, in its order.
struct Parts {
  Declarations stepNumbers, references, structs, constants, functions, classes, referenceMethods,
      hitErrors, entryPoints;
};

/// Functions first: only then is it known what they require of the other parts.
static Parts makeParts(Context &context) {
  Parts parts;
  Variables variables(context);
  StateMachines machines(context);
  Classes classes(context, variables, machines);
  for (const auto &constant : context.module.constants)
    parts.constants.push_back(variables.constant(*constant));
  parts.functions = freeFunctions(context);
  for (const auto &definition : context.module.classes)
    appendApart(parts.classes, classes.definition(*definition));
  std::set<const typed::Class *> withHitErrors;
  parts.hitErrors = hitErrors(context, withHitErrors);
  if (!context.module.classes.empty()) {
    std::vector<FilledSlot> filled;
    parts.entryPoints = slots(context, machines.entries, withHitErrors, filled);
    append(parts.entryPoints, description(context, machines.entries, filled));
  }
  for (const auto &structure : context.module.structs)
    appendApart(parts.structs, variables.structure(*structure));
  References references(context);
  parts.referenceMethods = references.methods();
  parts.references = references.types();
  parts.stepNumbers = RunState(context, machines.entries).stepNumbers();
  return parts;
}

/// The namespace of the author's code.
static Declaration namespaceOf(const Context &context, Parts parts) {
  Namespace space = {context.options.name, {}};
  const std::string components = std::to_string(context.options.colorComponents);
  Declarations &inside = space.members;
  inside.push_back(declare(Alias{"State", withParameters("rtsl::State", {components})}));
  inside.push_back(declare(Alias{"Color", withParameters("rtsl::Color", {components})}));
  const bool isNumberedFirst = !context.split.calledMethods.empty();
  if (isNumberedFirst) // the structs of their arguments name their first states
    appendApart(inside, std::move(parts.stepNumbers));
  appendApart(inside, std::move(parts.references));
  appendApart(inside, std::move(parts.structs));
  appendApart(inside, std::move(parts.constants));
  appendApart(inside, std::move(parts.functions));
  if (!context.module.classes.empty()) {
    // An unnamed namespace, so that compilers inline functions that are called only once.
    Namespace own;
    appendApart(own.members, classNumbers(context));
    if (!isNumberedFirst)
      appendApart(own.members, std::move(parts.stepNumbers));
    appendApart(own.members, std::move(parts.classes));
    appendApart(inside, declare(std::move(own)));
  }
  appendApart(inside, std::move(parts.referenceMethods));
  appendApart(inside, std::move(parts.hitErrors));
  appendApart(inside, std::move(parts.entryPoints));
  return declare(std::move(space));
}

std::optional<std::string> print(const typed::Module &module, const ModuleFacts &facts,
                                 const Options &options, Diagnostics &diagnostics,
                                 const StateProgram *states) {
  Context context(module, facts, options, diagnostics, states);
  Parts parts = makeParts(context);
  if (context.hasFailed() || diagnostics.hasErrors())
    return std::nullopt;
  Declarations file = heading(options);
  appendApart(file, namespaceOf(context, std::move(parts)));
  if (!module.classes.empty())
    appendApart(file, exported(options));
  return format(print(file));
}

} // namespace rtsl::cpp
