#include "codegen/cpp/Classes.h"

#include "codegen/cpp/functions/FunctionPrinter.h"
#include "sema/typed/Casting.h"

namespace rtsl::cpp {

//===----------------------------------------------------------------------===//
// Functions
//===----------------------------------------------------------------------===//

static Declaration definitionOf(Context &context, const typed::Function &function, bool isMethod) {
  Function made = context.signatures.of(function, isMethod);
  if (!isMethod)
    made.specifiers = "inline";
  made.body = FunctionPrinter(context, &function).statements.body();
  Declaration declared = declare(std::move(made), function.comment);
  declared.place = context.lineDirective(function.range);
  return declared;
}

Declarations freeFunctions(Context &context) {
  // Prototypes for those that are called above their definition.
  std::set<const typed::Function *> defined, asked;
  std::vector<const typed::Function *> prototypes;
  for (const auto &function : context.module.functions) {
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
    if (!context.split.isPartOfStates(*function))
      functions.push_back(declare(context.signatures.of(*function, false)));
  for (const auto &function : context.module.functions)
    if (function->body && !context.split.isPartOfStates(*function))
      appendApart(functions, definitionOf(context, *function, false));
  return functions;
}

//===----------------------------------------------------------------------===//
// Classes
//===----------------------------------------------------------------------===//

/// All members except scratch members, grouped as in the source.
Declarations Classes::members(const typed::Class &definition) {
  Declarations members;
  SourceRange previous;
  for (const auto &member : definition.members) {
    if (member->access == ast::Access::Scratch)
      continue;
    Declaration declared = variables.member(*member);
    declared.hasSpace = context.notes.followsEmptyLine(member->range, previous);
    previous = member->range;
    members.push_back(std::move(declared));
  }
  return members;
}

/// `using Base::method;` for methods of bases that overloads in the class would hide. Methods that
/// are split may have other names.
Declarations Classes::methodsOfBases(const typed::Class &definition) const {
  Declarations named;
  std::set<std::string> shown;
  for (const auto &function : definition.functions)
    for (const typed::Class *at = definition.base; at; at = at->base)
      for (const auto &method : at->functions)
        if (method->name == function->name && !method->isConstructor &&
            !context.split.isPartOfStates(*method) && !context.split.isPartOfStates(*function) &&
            (!context.split.isSplit(*at, *method) ||
             context.split.nameOfMachine(*at, *method) == context.names.of(method.get())) &&
            !typed::sameParameters(*method, *function) && shown.insert(method->name).second)
          appendApart(named,
                      declare(Using{context.names.of(at) + "::" + context.names.of(method.get())}));
  return named;
}

Declaration Classes::definition(const typed::Class &definition) {
  Struct made;
  made.name = context.names.of(&definition);
  made.base =
      definition.base ? context.names.of(definition.base) : "rtsl::" + nameOfRoot(definition.root);
  made.members = this->members(definition);
  if (std::optional<Declaration> scratch = scratchStructure(definition))
    appendApart(made.members, std::move(*scratch));
  appendApart(made.members, methodsOfBases(definition));
  for (const auto &function : definition.functions) {
    if (!function->body)
      continue;
    if (context.split.isSplit(definition, *function))
      appendApart(made.members, machines.of(definition, *function));
    else if (!context.split.isPartOfStates(*function))
      appendApart(made.members, definitionOf(context, *function, true));
  }
  appendApart(made.members, machines.inherited(definition));
  Declaration declared = declare(std::move(made), definition.comment);
  declared.place = context.lineDirective(definition.range);
  return declared;
}

std::optional<Declaration> Classes::scratchStructure(const typed::Class &definition) {
  if (!context.scratch.has(definition) || &rootOf(definition) != &definition)
    return std::nullopt;
  Struct made = {"Scratch", "rtsl::Scratch", false, {}};
  Statements visits;
  std::set<std::string> known, placed; // classes may have one of the same name and type each
  for (const typed::Class *at : context.scratch.family(definition))
    for (const auto &member : at->members) {
      if (member->access != ast::Access::Scratch)
        continue;
      const std::string &own = context.names.of(member.get());
      if (known.insert(own).second)
        made.members.push_back(variables.member(*member));
      const auto place = context.facts.attributeWords.find(member.get());
      if (place != context.facts.attributeWords.end() && placed.insert(own).second)
        visits.push_back(statement(call("at", {integer(place->second), cpp::name(own)})));
    }
  if (!visits.empty()) {
    Function visit;
    visit.templateParameters = "typename Visit";
    visit.result = "void";
    visit.name = "visit";
    visit.parameters = {byValue("Visit", "at")};
    visit.body = std::move(visits);
    appendApart(made.members, declare(std::move(visit)));
  }
  return declare(std::move(made));
}

} // namespace rtsl::cpp
