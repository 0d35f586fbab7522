//===- Variables.h - which variables of a scene its objects take ----------===//
//
// A public member that an object does not set takes the nearest variable of its name, on the path
// from the instance to the root. So one object of the scene file may be several of the program.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {

class Variables {
public:
  /// Outside of all nodes.
  Variables(const SceneDescription &description, const runtime::Program &program);

  /// Is there a variable at all?
  bool any() const { return hasAny; }

  /// What follows is below the node of this scope.
  void enter(const VariableScope *scope) { current = scope; }
  void leaveNodes() { current = description.scopes.front().get(); }
  const VariableScope *scope() const { return current; }

  /// What a member of the object takes; null: nothing. An object in a variable does not take that
  /// variable, and one that is made by its constructor takes none.
  const VariableDefinition *of(const runtime::MemberInfo &member,
                               const ObjectDescription &object) const;

  /// The definitions that an object and those that it refers to take. In two scopes in which it
  /// takes the same definitions, it is the same object of the program.
  using Taken = std::set<const JsonValue *>;
  Taken takenBy(const ObjectDescription &object) const;

  /// During its lifetime the objects in the definition are being visited.
  class Taking {
  public:
    Taking(const Variables &variables, const VariableDefinition &definition);
    Taking(const Taking &) = delete;
    ~Taking() { variables.open.pop_back(); }

  private:
    const Variables &variables;
  };

  /// Warnings about variables that no object has taken.
  std::vector<Warning> warnings() const;

private:
  using Seen = std::set<const ObjectDescription *>;
  void addTaken(const ObjectDescription &object, Taken &taken, Seen &seen) const;

  const SceneDescription &description;
  const runtime::Program &program;
  const bool hasAny;
  const VariableScope *current;
  mutable std::vector<const JsonValue *> open; // by Taking
  mutable std::set<const JsonValue *> everTaken;
};

} // namespace rtsl::scene
