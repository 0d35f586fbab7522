//===- VariablePlaces.h - where variables could set an object's members ---===//
//
// For messages about members that nothing sets: the nodes on the paths from the roots to the
// instances that use the object.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace rtsl::scene {

class VariablePlaces {
public:
  explicit VariablePlaces(const SceneDescription &description) : description(description) {}

  /// The nearest first, as "`car` (line 5), `street` (line 7) or the scene". Empty for an object
  /// that is made by its constructor, which takes no variables.
  std::string of(const ObjectDescription &object);

private:
  /// A geometry of `objects`, or the node of another or of a selector.
  struct User {
    const GeometryDescription *listed = nullptr;
    std::size_t node = 0;
    bool operator==(const User &other) const {
      return listed == other.listed && node == other.node;
    }
  };
  using Key = std::tuple<std::string, std::uint32_t, std::uint32_t>; // where its class is written

  static Key keyOf(const ObjectDescription &object);
  void findUsers();
  void use(const ReferenceDescription &reference, const User &user);
  void use(const ObjectDescription &object, const User &user);
  void useVariables(const VariableScope *scope, const User &user);
  std::vector<std::string> namesAbove(const std::vector<User> &users) const;

  const SceneDescription &description;
  std::map<Key, std::vector<User>> users; // empty: not found yet
};

} // namespace rtsl::scene
