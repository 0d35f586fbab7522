#include "scenefile/graph/VariablePlaces.h"

#include "scenefile/References.h"
#include "scenefile/gltf/File.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rtsl::scene {

VariablePlaces::Key VariablePlaces::keyOf(const ObjectDescription &object) {
  const Place &place = object.className.place;
  return {place.file, place.line, place.column};
}

void VariablePlaces::findUsers() {
  for (const GeometryDescription &geometry : description.objects) {
    const User user = geometry.node ? User{nullptr, *geometry.node} : User{&geometry, 0};
    use(geometry.material, user);
    if (geometry.primitive)
      use(*geometry.primitive, user);
    const VariableScope *last = nullptr;
    for (const InstanceDescription &instance : geometry.placements)
      if (instance.scope != last)
        useVariables(last = instance.scope, user);
  }
  for (const SelectorDescription &selector : description.selectors) {
    use(selector.object, {nullptr, selector.node});
    useVariables(selector.scope, {nullptr, selector.node});
  }
}

void VariablePlaces::use(const ReferenceDescription &reference, const User &user) {
  if (reference.object)
    use(*reference.object, user);
  else if (const ObjectDescription *object = findObject(description, reference.name.text))
    use(*object, user);
}

void VariablePlaces::use(const ObjectDescription &object, const User &user) {
  std::vector<User> &known = users[keyOf(object)];
  if (!known.empty() && known.back() == user) // also ends cycles
    return;
  known.push_back(user);
  forEachReferred(description, object,
                  [&](const ObjectDescription &other, bool) { use(other, user); });
}

/// Objects in variables take variables, too.
void VariablePlaces::useVariables(const VariableScope *scope, const User &user) {
  for (; scope; scope = scope->above)
    for (const auto &variable : scope->variables)
      forEachReferred(description, *variable.second.second,
                      [&](const ObjectDescription &other, bool) { use(other, user); });
}

/// The names of the nodes that are written in the scene file, the nearest first.
std::vector<std::string> VariablePlaces::namesAbove(const std::vector<User> &users) const {
  std::vector<std::string> names;
  std::vector<std::size_t> nodes; // in the order in which they are found
  std::vector<bool> isFound(description.nodes.size(), false);
  const auto find = [&](std::size_t node) {
    if (node < isFound.size() && !isFound[node]) {
      isFound[node] = true;
      nodes.push_back(node);
    }
  };
  const auto add = [&](const std::string &name, const Place &place) {
    if (place.line != 0 && !gltf::isModel(place.file))
      names.push_back(fmt::format("{} (line {})", name, place.line));
  };
  for (const User &user : users) {
    if (user.listed)
      add(user.listed->name.text.empty()
              ? fmt::format("`objects.{}`", user.listed - description.objects.data())
              : fmt::format("`{}`", user.listed->name.text),
          user.listed->place);
    else
      find(user.node);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeMention &node = description.nodes[nodes[i]];
    add(node.name.text.empty() ? "a node" : fmt::format("`{}`", node.name.text), node.name.place);
    for (const std::size_t parent : node.parents)
      find(parent);
  }
  return names;
}

std::string VariablePlaces::of(const ObjectDescription &object) {
  if (object.constructor)
    return "";
  if (users.empty())
    findUsers();
  const auto found = users.find(keyOf(object));
  std::vector<std::string> names;
  if (found != users.end())
    names = namesAbove(found->second);
  constexpr std::size_t mostShown = 6;
  if (names.size() > mostShown) {
    const std::size_t more = names.size() - mostShown;
    names.resize(mostShown);
    names.push_back(fmt::format("{} more", more));
  }
  return names.empty() ? "the scene" : fmt::format("{} or the scene", fmt::join(names, ", "));
}

} // namespace rtsl::scene
