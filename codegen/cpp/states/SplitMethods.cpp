#include "codegen/cpp/states/SplitMethods.h"

#include "codegen/ir/Attributes.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Effects.h"

#include <algorithm>
#include <cctype>

namespace rtsl::cpp {

SplitMethods::SplitMethods(const typed::Module &module, const Names &names,
                           const StateProgram *program)
    : program(program), module(module), names(names) {
  for (const auto &structure : module.structs)
    fileTypes.insert(names.of(structure.get()));
  for (const auto &definition : module.classes)
    fileTypes.insert(names.of(definition.get()));
  if (!program)
    return;
  findStates();
  findCalledMethods();
}

const std::vector<mlir::func::FuncOp> &SplitMethods::statesOf(const typed::Class &definition,
                                                              const std::string &slot,
                                                              bool isCalled) const {
  return states.at({definition.name, slot, isCalled});
}

void SplitMethods::findStates() {
  mlir::ModuleOp ir = program->ir;
  for (auto function : ir.getOps<mlir::func::FuncOp>()) {
    auto ofClass = ir::attr::className.of(function);
    auto ofMethod = ir::attr::methodName.of(function);
    if (ir::attr::state.isOn(function) && ofClass && ofMethod)
      states[{ofClass.str(), ofMethod.str(), continuation::isFramed(function)}].push_back(function);
  }
}

bool SplitMethods::isSplit(const typed::Class &definition, const typed::Function &method) const {
  return program && method.sends.traced &&
         (method.isStateMethod || calledMethod(definition, method)) &&
         states.count({definition.name, typed::slotName(module, method), !method.isStateMethod}) !=
             0;
}

bool SplitMethods::isPartOfStates(const typed::Function &function) const {
  return program && !function.isStateMethod && function.sends.traced;
}

bool SplitMethods::isWhole(const typed::Function &function) const {
  return !isPartOfStates(function) && !(function.owner && isSplit(*function.owner, function));
}

// Only calls in the author's code on the object itself need virtual methods of C++: the runtime and
// references call methods of a known class. States that call a method which is not whole are
// printed for each class.
bool SplitMethods::isVirtual(const typed::Function &function) const {
  if (!function.owner || function.isConstructor || typed::isCalledByEngineAlone(function) ||
      !isWhole(function))
    return false;
  for (const auto &definition : module.classes)
    if (definition.get() != function.owner && definition->derivesFrom(function.owner))
      for (const auto &method : definition->functions)
        if (method->name == function.name && typed::sameParameters(*method, function) &&
            isWhole(*method))
          return true;
  return false;
}

bool SplitMethods::overridesVirtual(const typed::Function &function) const {
  if (!function.owner || function.isConstructor)
    return false;
  for (const typed::Class *base = function.owner->base; base; base = base->base)
    for (const auto &method : base->functions)
      if (method->name == function.name && typed::sameParameters(*method, function) &&
          isVirtual(*method))
        return true;
  return false;
}

/// Has the class another method of this name, for another payload or none, or a base or a derived
/// class of it? C++ would take one for the other: states have no payload as a parameter that do not
/// use it.
static bool isOneOfMany(const typed::Module &module, const typed::Class &definition,
                        const typed::Function &method) {
  const std::string slot = typed::slotName(module, method);
  return std::any_of(module.classes.begin(), module.classes.end(), [&](const auto &other) {
    const bool isRelated = other.get() == &definition || other->derivesFrom(&definition) ||
                           definition.derivesFrom(other.get());
    return isRelated &&
           std::any_of(other->functions.begin(), other->functions.end(), [&](const auto &one) {
             return one->name == method.name && typed::slotName(module, *one) != slot;
           });
  });
}

std::string SplitMethods::nameOfMachine(const typed::Class &definition,
                                        const typed::Function &method) const {
  const bool namesPayload = typed::takesPayload(method) && isOneOfMany(module, definition, method);
  return names.of(&method) +
         (namesPayload ? names.of(method.parameters.front()->type->structure) : std::string());
}

std::string SplitMethods::stepName(const typed::Class &definition, const std::string &function) {
  return unique(names.of(&definition) + "_" + function, stepNames);
}

void SplitMethods::findCalledMethods() {
  std::map<const typed::Class *, std::set<std::string>> structures;
  mlir::ModuleOp ir = program->ir;
  for (auto declaration : ir.getOps<mlir::func::FuncOp>()) {
    auto ofClass = ir::attr::className.of(declaration);
    auto slot = ir::attr::methodName.of(declaration);
    if (!declaration.isExternal() || !ofClass || !slot)
      continue;
    CalledMethod called;
    called.symbol = declaration.getSymName().str();
    called.slot = slot.getValue().str();
    for (const auto &definition : module.classes)
      for (const auto &function : definition->functions)
        if (definition->name == ofClass.getValue() &&
            typed::slotName(module, *function) == called.slot) {
          called.definition = definition.get();
          called.function = function.get();
        }
    if (!called.function)
      continue;
    const std::string &name = names.of(called.function);
    called.step = stepName(*called.definition, name);
    called.structure = name;
    called.structure[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    structures.try_emplace(called.definition, typeNames()); // names that the structure would hide
    called.structure = unique(called.structure, structures[called.definition]);

    // In the order of the IR: the address of an aggregate result, then the parameters.
    const mlir::FunctionType type = declaration.getFunctionType();
    const continuation::CallLayout layout =
        continuation::layoutCall(type.getInputs().drop_front(), type.getResults());
    called.offsets.assign(layout.arguments.begin(), layout.arguments.end());
    std::set<std::string> fields = {"begin"};
    if (called.offsets.size() > called.function->parameters.size()) {
      called.arguments.push_back(nullptr);
      called.fields.push_back(unique("returned", fields));
    }
    for (const auto &parameter : called.function->parameters) {
      const std::string &name = names.of(parameter.get());
      called.arguments.push_back(parameter.get());
      called.fields.push_back(unique(name.empty() ? "unnamed" : name, fields));
    }
    if (type.getNumResults() != 0)
      called.returned = unique("returned", fields);
    calledMethods.push_back(std::move(called));
  }
}

const CalledMethod *SplitMethods::calledMethod(const std::string &symbol) const {
  for (const CalledMethod &called : calledMethods)
    if (called.symbol == symbol)
      return &called;
  return nullptr;
}

const CalledMethod *SplitMethods::calledMethod(const typed::Class &definition,
                                               const typed::Function &method) const {
  for (const CalledMethod &called : calledMethods)
    if ((&definition == called.definition || definition.derivesFrom(called.definition)) &&
        !method.isStateMethod && typed::slotName(module, method) == called.slot)
      return &called;
  return nullptr;
}

std::string SplitMethods::structureOf(const CalledMethod &called) const {
  return names.reference(called.definition->name) + "::" + called.structure;
}

} // namespace rtsl::cpp
