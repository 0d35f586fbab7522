//===- CalledMethods.cpp - methods that trace, called through references ---===//
//
//   struct FilterRef : rtsl::Reference {
//     struct Follow { ... };                   // what `follow` is given and returns
//   };
//   return rtsl::callThen(rt, frame, Step::Tint_shadeAfterCall1, inner, FilterRef::Follow{o, d});
//
// The caller's state ends there, and goes on in another when the method has returned. The method's
// frame begins with that struct, whatever class has it (include/rtsl/shader/Calls.h,
// codegen/passes/continuation/calls/OpenCalls.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"
#include "codegen/cpp/states/States.h"
#include "codegen/ir/Attributes.h"

#include "codegen/passes/continuation/calls/Steps.h"
#include "sema/typed/Analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace rtsl::cpp {

const std::set<std::string> &ModulePrinter::typeNames() const {
  if (!fileTypes.empty())
    return fileTypes;
  for (const auto &structure : module.structs)
    fileTypes.insert(names.of(structure.get()));
  for (const auto &definition : module.classes)
    fileTypes.insert(names.of(definition.get()));
  return fileTypes;
}

std::string ModulePrinter::stepName(const typed::Class &definition, const std::string &function) {
  return unique(names.of(&definition) + "_" + function, stepNames);
}

void ModulePrinter::findCalledMethods() {
  std::map<const typed::Class *, std::set<std::string>> structures;
  mlir::ModuleOp ir = states->ir;
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
    structures.try_emplace(called.definition, typeNames()); // which it would hide
    called.structure = unique(called.structure, structures[called.definition]);

    // As the IR has them: where a result goes that stays whole, and the parameters.
    const mlir::FunctionType type = declaration.getFunctionType();
    const continuation::CallLayout layout =
        continuation::layoutCall(type.getInputs().drop_front(), type.getResults());
    called.offsets.assign(layout.arguments.begin(), layout.arguments.end());
    std::set<std::string> fields = {"begin"};
    if (called.offsets.size() > called.function->parameters.size()) {
      called.given.push_back(nullptr);
      called.fields.push_back(unique("returned", fields));
    }
    for (const auto &parameter : called.function->parameters) {
      const std::string &given = names.of(parameter.get());
      called.given.push_back(parameter.get());
      called.fields.push_back(unique(given.empty() ? "unnamed" : given, fields));
    }
    if (type.getNumResults() != 0)
      called.returned = unique("returned", fields);
    calledMethods.push_back(std::move(called));
  }
}

const CalledMethod *ModulePrinter::calledMethod(const std::string &symbol) const {
  for (const CalledMethod &called : calledMethods)
    if (called.symbol == symbol)
      return &called;
  return nullptr;
}

const CalledMethod *ModulePrinter::calledMethod(const typed::Class &definition,
                                                const typed::Function &method) const {
  for (const CalledMethod &called : calledMethods)
    if ((&definition == called.definition || definition.derivesFrom(called.definition)) &&
        !method.isStateMethod && typed::slotName(module, method) == called.slot)
      return &called;
  return nullptr;
}

std::string ModulePrinter::structureOf(const CalledMethod &called) const {
  return names.reference(called.definition->name) + "::" + called.structure;
}

/// Is it given as an address?
static bool isAddress(const typed::Variable *given) {
  return !given || given->direction != ast::Direction::In || given->type->is(TypeKind::Struct) ||
         given->type->is(TypeKind::Array) || given->type->isMatrix();
}

Declarations ModulePrinter::callStructures(const std::string &className) {
  Declarations all;
  for (const CalledMethod &called : calledMethods) {
    if (called.definition->name != className)
      continue;
    Struct made;
    made.name = called.structure;
    made.members.push_back(declare(
        Variable{"static constexpr", "Step", {"begin", cpp::name("Step::" + called.step)}}));
    for (std::size_t i = 0; i < called.given.size(); ++i) {
      const typed::Variable *given = called.given[i];
      const std::string of = type(given ? given->type : called.function->returnType);
      made.members.push_back(
          declare(Variable{{}, isAddress(given) ? of + " *" : of, {called.fields[i], {}}}));
    }
    if (!called.returned.empty())
      made.members.push_back(declare(
          Variable{{}, type(called.function->returnType), {called.returned, list("", {})}}));
    appendApart(all, declare(std::move(made),
                             fmt::format("// What `{}` is given{}.", names.of(called.function),
                                         called.returned.empty() ? "" : ", and what it returns")));
  }
  return all;
}

/// The method of an object's class begins, or runs at once if that does not trace.
Statements ModulePrinter::runCalledMethod(const CalledMethod &called) {
  const Code given = cpp::name("call");
  Statements body = dispatch(
      classesBelow(called.definition->name),
      [&](const typed::Class &definition) -> Statements {
        const typed::Function *method = findMethod(definition, *called.function);
        if (!method)
          return {};
        for (const typed::Class *at = &definition; at != method->owner->base;
             at = at->base) // a base of that has others
          if (auto first = firstCalls.find({at, called.slot}); first != firstCalls.end())
            return {returning(first->second.on(objectOf(definition)))};
        std::vector<Code> arguments;
        if (takesState(*method))
          arguments.push_back(cpp::name("rt"));
        if (takesScratch(*method))
          arguments.push_back(storedScratch(definition));
        auto field = [&](std::size_t i) {
          const Code own = cpp::member(given, called.fields[i]);
          return isAddress(called.given[i]) ? unary(UnaryOperator::Dereference, own) : own;
        };
        for (std::size_t i = 0; i < called.given.size(); ++i)
          if (called.given[i])
            arguments.push_back(field(i));
        const Code run = callMember(objectOf(definition), names.of(method), std::move(arguments));
        if (!called.returned.empty())
          return {statement(assign(cpp::member(given, called.returned), run))};
        if (!called.given.empty() && !called.given.front())
          return {statement(assign(field(0), run))};
        return {statement(run)};
      },
      mayReferToNothing);
  if (mentions(body, given->name)) {
    const Code frame =
        call(withParameters("rtsl::calledFrameAt", {structureOf(called)}), {cpp::name("frame")});
    body.insert(body.begin(), declaration("auto &", given->name, frame));
  }
  if (!endsInReturn(body))
    body.push_back(returning(cpp::call("rtsl::returnToCaller", {cpp::name("rt")})));
  return body;
}

} // namespace rtsl::cpp
