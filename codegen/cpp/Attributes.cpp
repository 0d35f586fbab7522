//===- Attributes.cpp - scratch members, and where they lie in a hit ------===//
//
// A class with scratch members has a struct `Scratch` of them, which its methods take: in
// `intersect` it is a variable of that call, elsewhere what the hit that won has stored. A material
// finds a primitive's attribute by name and type, so equal ones have the same place
// (codegen/link/PlaceAttributes.cpp). Classes that derive from one another share one `Scratch`,
// with the members of all.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

namespace rtsl::cpp {

const typed::Class &ModulePrinter::top(const typed::Class &definition) const {
  const typed::Class *at = &definition;
  while (at->base)
    at = at->base;
  return *at;
}

std::vector<const typed::Class *> ModulePrinter::family(const typed::Class &definition) const {
  std::vector<const typed::Class *> classes;
  for (const auto &other : module.classes)
    if (&top(*other) == &top(definition))
      classes.push_back(other.get());
  return classes;
}

bool ModulePrinter::hasScratch(const typed::Class &definition) {
  const typed::Class &head = top(definition);
  std::optional<bool> &known = scratchOfFamily[&head];
  if (known)
    return *known;
  bool found = false;
  for (const typed::Class *at : family(head)) {
    for (const auto &member : at->members)
      found |= member->access == ast::Access::Scratch;
    // A free function that reports hits says so there.
    for (const auto &function : at->functions)
      if (function->body)
        forEachExpr(*function->body, [&](const typed::Expr &expr) {
          auto *call = dynCast<typed::CallExpr>(&expr);
          found |= call && !call->function->owner && effects.function(*call->function).reportsHit;
        });
  }
  return *(known = found);
}

std::optional<Declaration> ModulePrinter::scratchStructure(const typed::Class &definition) {
  if (!hasScratch(definition) || &top(definition) != &definition)
    return std::nullopt;
  Struct made = {"Scratch", "rtsl::Scratch", false, {}};
  Statements visits;
  std::set<std::string> known, placed; // classes may have one of the same name and type each
  for (const typed::Class *at : family(definition))
    for (const auto &member : at->members) {
      if (member->access != ast::Access::Scratch)
        continue;
      const std::string &own = names.of(member.get());
      if (known.insert(own).second)
        made.members.push_back(this->member(*member));
      const auto place = facts.attributeWords.find(member.get());
      if (place != facts.attributeWords.end() && placed.insert(own).second)
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
