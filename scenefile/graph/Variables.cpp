#include "scenefile/graph/Variables.h"

#include "scenefile/References.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::scene {

Variables::Variables(const SceneDescription &description, const runtime::Program &program)
    : description(description), program(program),
      hasAny(std::any_of(description.scopes.begin(), description.scopes.end(),
                         [](const auto &one) { return !one->variables.empty(); })),
      current(description.scopes.front().get()) {}

const VariableDefinition *Variables::of(const runtime::MemberInfo &member,
                                        const ObjectDescription &object) const {
  if (!hasAny || !member.isPublic || object.constructor || isGiven(object, member.name))
    return nullptr;
  const VariableDefinition *found = current->find(member.name);
  return found && std::find(open.begin(), open.end(), found->second) == open.end() ? found
                                                                                   : nullptr;
}

Variables::Taking::Taking(const Variables &variables, const VariableDefinition &definition)
    : variables(variables) {
  variables.open.push_back(definition.second);
  variables.everTaken.insert(definition.second);
}

Variables::Taken Variables::takenBy(const ObjectDescription &object) const {
  Taken taken;
  Seen seen;
  if (hasAny)
    addTaken(object, taken, seen);
  return taken;
}

void Variables::addTaken(const ObjectDescription &object, Taken &taken, Seen &seen) const {
  const runtime::ClassInfo *classInfo = program.find(object.className.text);
  if (!classInfo)
    return;
  const auto visit = [&](const ObjectDescription &other, bool isNamed) {
    if (!isNamed || seen.insert(&other).second)
      addTaken(other, taken, seen);
  };
  for (const runtime::MemberInfo &member : classInfo->members)
    if (const VariableDefinition *definition = of(member, object);
        definition && taken.insert(definition->second).second) {
      const Taking taking(*this, *definition);
      forEachReferred(description, *definition->second, visit);
    }
  forEachReferred(description, object, visit);
}

std::vector<Warning> Variables::warnings() const {
  std::vector<Warning> warnings;
  std::set<const JsonValue *> seen; // a node may have several scopes
  for (const auto &one : description.scopes)
    for (const auto &[name, definition] : one->variables)
      if (!everTaken.count(definition.second) && seen.insert(definition.second).second)
        warnings.push_back({message::variableUnused(name), definition.first});
  return warnings;
}

} // namespace rtsl::scene
