#include "scenefile/graph/Graph.h"

#include "runtime/scene/InstanceTransform.h"
#include "scenefile/gltf/File.h"
#include "scenefile/graph/NodeLights.h"
#include "scenefile/graph/TransformReader.h"
#include "scenefile/json/Reader.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"
#include "support/MachineMemory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;
using runtime::MovingTransform;
using runtime::Placement;

constexpr std::uint64_t mostInstances = std::uint64_t(1) << 26;
/// An instance takes about 250 bytes of memory, and 700 with all that is needed while it is made.
constexpr std::uint64_t bytesOfInstance = 700;
/// Transforms that move on a path: each of its nodes holds the product of those above it.
constexpr std::size_t mostMoving = 1000;
constexpr std::size_t mostRoots = 32; // bits of Placement::roots

constexpr std::size_t noNode = ~std::size_t(0);

struct Node;

/// A mention of a node.
struct Edge {
  std::size_t node = noNode; // noNode: there is none of this name, which was reported
  Place place;
};

struct Node {
  std::string name; // for messages
  Place place;
  MovingTransform transform;
  Place transformPlace; // if it has one
  std::vector<Edge> children;
  std::optional<GeometryDescription> geometry;
  std::shared_ptr<ObjectDescription> light;
  std::optional<ReferenceDescription> selector; // among the children
  std::optional<std::int32_t> id;
  VariableDefinitions variables;
  std::uint64_t instances = 0; // paths from here to geometries; at most mostInstances + 1
  std::size_t moving = 0;      // the most transforms that move on a path from here
  bool isReported = false;     // its transform, or a cycle through it
};

/// The largest condition number of a transform, at its keys and some times between them.
double worstCondition(const MovingTransform &transform) {
  if (!transform.moves())
    return runtime::invertLinear(transform.still()).condition;
  double worst = 0;
  for (const double time : timesToCheck(transform))
    worst = std::max(worst, runtime::invertLinear(transform.at(time)).condition);
  return worst;
}

class GraphReader {
public:
  GraphReader(const JsonValue &root, const NodeReaders &readers, SceneDescription &scene,
              ErrorCollector &errors)
      : root(root), readers(readers), scene(scene), errors(errors) {}

  void read() {
    const JsonValue *named = root.find("nodes");
    if (named)
      errors.attempt([&] { readNodes(*named); });
    errors.attempt([&] { readRoots(); });
    if (named && roots.empty() && !root.find("root") && !root.find("roots"))
      errors.add(Error(message::rootMissing(), named->place()));
    if (!findOrder() || hasMistakes) // cycles among what could be read are reported, too
      return;
    errors.attempt([&] { countInstances(); });
    if (hasMistakes)
      return;
    for (std::size_t number = 0; number < roots.size(); ++number)
      placeInstances(number);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (auto &geometry = nodes[i].geometry; geometry && !geometry->placements.empty()) {
        geometry->node = i;
        scene.objects.push_back(std::move(*geometry));
      }
    const std::vector<bool> isUsed = usedNodes();
    mentionNodes(isUsed);
    findShared();
    if (named)
      warnOfUnused(*named, isUsed);
  }

private:
  template <typename Step>
  void attempt(Step step) {
    errors.attempt([&] {
      try {
        step();
      } catch (...) {
        hasMistakes = true;
        throw;
      }
    });
  }

  void readNodes(const JsonValue &value) {
    attempt([&] { expect(value, Kind::Object, "`nodes`"); });
    // All names first: nodes may mention each other in any order.
    for (const auto &[key, member] : value.members) {
      numbers.emplace(key.text, nodes.size());
      nodes.push_back(newNode(key.text, member.place(key)));
    }
    for (std::size_t i = 0; i < value.members.size(); ++i)
      attempt([&] { readNode(value.members[i].second, i, "a node"); });
  }

  static Node newNode(std::string name, const Place &place) {
    Node node;
    node.name = std::move(name);
    node.place = place;
    return node;
  }

  /// Reads the node `value`, which is number `number`.
  void readNode(const JsonValue &value, std::size_t number, const char *what) {
    expect(value, Kind::Object, what);
    const JsonValue *children = value.find("children"), *child = value.find("child");
    const JsonValue *light = value.find("light");
    const bool isGeometry = value.find("mesh") || value.find("primitive");
    if (int(isGeometry) + int(light != nullptr) + int(children != nullptr) +
            int(child != nullptr) !=
        1)
      throw Error(message::nodeWithoutContent(what), value.place());
    if (isGeometry) {
      GeometryDescription geometry = readers.geometry(value);
      if (geometry.name.text.empty())
        geometry.name = {nodes[number].name, nodes[number].place};
      nodes[number].geometry = std::move(geometry);
    } else {
      checkKeys(value, {"child", "children", "light", "selector", "transform", "id", "variables"},
                what);
      if (const JsonValue *id = value.find("id"))
        nodes[number].id = readId(*id);
    }
    if (light)
      nodes[number].light = readLight(*light);
    if (const JsonValue *selector = value.find("selector")) {
      if (!children)
        throw Error(message::selectorWithoutChildren(), selector->place());
      nodes[number].selector = readers.reference(*selector, "`selector`");
    }
    if (const JsonValue *variables = value.find("variables"))
      nodes[number].variables = readVariables(*variables);
    if (const JsonValue *transform = value.find("transform")) {
      nodes[number].transform = readTransform(*transform);
      nodes[number].transformPlace = transform->place();
    }
    std::vector<Edge> edges; // reading a node in place may move `nodes`
    if (child)
      edges.push_back(readEdge(*child));
    if (children) {
      expect(*children, Kind::Array, "`children`");
      if (children->elements.empty())
        throw Error(message::noChildren(), children->place());
      edges.reserve(children->elements.size());
      for (const JsonValue &element : children->elements)
        attempt([&] { edges.push_back(readEdge(element)); });
    }
    nodes[number].children = std::move(edges);
  }

  std::shared_ptr<ObjectDescription> readLight(const JsonValue &value) const {
    expect(value, Kind::Object, "`light`");
    std::shared_ptr<ObjectDescription> light = readers.reference(value, "`light`").object;
    requirePlaceable(light->className);
    return light;
  }

  /// Shows what else has the name: an object of another section.
  void nameOtherKind(const std::string &name, Error &error) const {
    for (const char *section : {"images", "helpers", "textures", "materials"})
      if (const JsonValue *objects = root.find(section))
        for (const auto &[key, object] : objects->members)
          if (key.text == name)
            error.related(object.place(key), fmt::format("one of the `{}`, not a node", section));
  }

  /// A name, or a node in place.
  Edge readEdge(const JsonValue &value) {
    if (value.kind == Kind::Object) {
      const std::size_t number = nodes.size();
      nodes.push_back(newNode({}, value.place()));
      readNode(value, number, "a node");
      return {number, value.place()};
    }
    if (value.kind != Kind::String)
      throw Error(message::notChild(describe(value.kind)), value.place());
    const auto found = numbers.find(value.string);
    if (found == numbers.end()) {
      Error error(message::noSuchNode(value.string), value.place());
      nameOtherKind(value.string, error);
      std::vector<std::string> names;
      for (const auto &known : numbers)
        names.push_back(known.first);
      std::sort(names.begin(), names.end());
      if (const std::string near = closestName(value.string, names); !near.empty())
        error.fix(near);
      throw error;
    }
    return {found->second, value.place()};
  }

  void readRoots() {
    const JsonValue *one = root.find("root"), *several = root.find("roots");
    if (one && several)
      throw Error(message::rootAndRoots(), one->place());
    if (one)
      attempt([&] { addRoot({"root", one->place()}, *one); });
    if (!several)
      return;
    attempt([&] {
      expect(*several, Kind::Object, "`roots`");
      if (several->members.empty())
        throw Error(message::rootsEmpty(), several->place());
    });
    for (const auto &[key, member] : several->members)
      attempt([&, &key = key, &member = member] {
        if (roots.size() == mostRoots)
          throw Error(message::tooManyRoots(mostRoots), several->place(key));
        addRoot({key.text, several->place(key)}, member);
      });
  }

  void addRoot(LocatedName name, const JsonValue &value) {
    const Edge edge = readEdge(value);
    scene.roots.push_back(name.text);
    rootNames.push_back(std::move(name));
    roots.push_back(edge);
  }

  /// Orders the nodes so that children come first. False if there are cycles, which are reported.
  bool findOrder() {
    bool isOrdered = true;
    enum class Mark : std::uint8_t { New, Open, Done };
    std::vector<Mark> marks(nodes.size(), Mark::New);
    struct Step {
      std::size_t node, next; // the child to be looked at
    };
    const auto namesOn = [&](const std::vector<Step> &path) {
      std::vector<std::string> names;
      for (const Step &step : path)
        if (!nodes[step.node].name.empty())
          names.push_back(nodes[step.node].name);
      return names;
    };
    for (std::size_t first = 0; first < nodes.size(); ++first) {
      if (marks[first] != Mark::New)
        continue;
      std::vector<Step> path{{first, 0}};
      marks[first] = Mark::Open;
      while (!path.empty()) {
        Step &step = path.back();
        const std::vector<Edge> &children = nodes[step.node].children;
        if (step.next == children.size()) {
          marks[step.node] = Mark::Done;
          order.push_back(step.node);
          path.pop_back();
          continue;
        }
        const Edge &edge = children[step.next++];
        if (marks[edge.node] == Mark::Open) {
          isOrdered = false;
          if (!std::exchange(nodes[edge.node].isReported, true))
            reportCycle(nodes[edge.node].name, namesOn(path), edge.place);
          continue;
        }
        if (marks[edge.node] == Mark::New) {
          marks[edge.node] = Mark::Open;
          path.push_back({edge.node, 0});
        }
      }
    }
    return isOrdered;
  }

  void reportCycle(const std::string &name, std::vector<std::string> path, const Place &place) {
    path.erase(path.begin(), std::find(path.begin(), path.end(), name));
    constexpr std::size_t shown = 6;
    std::string cycle;
    for (std::size_t i = 0; i < std::min(path.size(), shown); ++i)
      cycle += path[i] + " > ";
    if (path.size() > shown)
      cycle += "... > ";
    errors.add(Error(message::nodeCycle(name, cycle, name), place));
  }

  void countInstances() {
    for (std::size_t number : order) {
      Node &node = nodes[number];
      node.instances = node.geometry || node.light ? 1 : 0;
      for (const Edge &child : node.children) {
        node.instances = std::min(node.instances + nodes[child.node].instances, mostInstances + 1);
        node.moving = std::max(node.moving, nodes[child.node].moving);
      }
      node.moving += node.transform.factors().size();
    }
    std::uint64_t total = 0;
    for (const Edge &edge : roots) {
      total += nodes[edge.node].instances;
      hasMistakes = true; // unless all is well
      if (nodes[edge.node].moving > mostMoving)
        throw Error(message::tooManyMoving(nodes[edge.node].moving, mostMoving), edge.place);
      if (total > mostInstances)
        throw Error(message::tooManyInstances(mostInstances), edge.place);
      try {
        const MemoryReservation needed(total * bytesOfInstance);
      } catch (const std::bad_alloc &) {
        throw Error(message::noMemoryForInstances(total, double(total * bytesOfInstance) / 0x1p30),
                    edge.place);
      }
      hasMistakes = false;
    }
  }

  struct Step {
    std::size_t node, next;
    InstanceDescription instance; // to the node
  };

  /// Adds an instance to the geometry at the end of each path from a root.
  void placeInstances(std::size_t number) {
    std::vector<Step> path;
    const auto enter = [&](std::size_t node, InstanceDescription instance) {
      applyNode(nodes[node], instance);
      path.push_back({node, 0, instance});
      if (nodes[node].light)
        placeLight(*nodes[node].light, instance.transform);
      if (!nodes[node].geometry)
        return;
      if (worstCondition(instance.transform) <= runtime::largestCondition) {
        place(*nodes[node].geometry, instance);
        return;
      }
      std::size_t worst = node;
      for (const Step &above : path)
        if (flatness(above.node) > flatness(worst))
          worst = above.node;
      reportFlat(nodes[node], nodes[worst]);
    };
    InstanceDescription start = scene.above;
    start.roots = 1u << number;
    start.scope = scene.scopes.front().get();
    enter(roots[number].node, start);
    while (!path.empty()) {
      Step &step = path.back();
      if (step.next == nodes[step.node].children.size()) {
        path.pop_back();
        continue;
      }
      InstanceDescription instance = step.instance;
      if (nodes[step.node].selector)
        instance.childOfSelector = std::uint32_t(step.next);
      enter(nodes[step.node].children[step.next++].node, instance);
    }
  }

  void placeLight(const ObjectDescription &light, const runtime::MovingTransform &toWorld) {
    errors.attempt([&] { scene.lights.push_back(placedLight(light, toWorld, scene)); });
  }

  /// Applies the settings of the node to the instances below it.
  void applyNode(const Node &node, InstanceDescription &instance) {
    instance.transform = node.transform.then(instance.transform);
    if (instance.inPart)
      instance.inPart =
          std::make_shared<const MovingTransform>(node.transform.then(*instance.inPart));
    if (node.id)
      instance.id = *node.id;
    if (!node.variables.empty())
      instance.scope = addScope(scene, instance.scope, node.variables);
    if (node.selector) {
      SelectorDescription selector;
      selector.node = static_cast<std::size_t>(&node - nodes.data());
      selector.object = *node.selector;
      selector.children = std::uint32_t(node.children.size());
      selector.toWorld = instance.transform;
      selector.above = instance.selector;
      selector.childOfAbove = instance.childOfSelector;
      selector.scope = instance.scope;
      scene.selectors.push_back(std::move(selector));
      instance.selector = scene.selectors.size();
    }
  }

  double flatness(std::size_t node) const { return worstCondition(nodes[node].transform); }

  /// Reports that the transforms above the geometry flatten it, or nearly so; `worst` is the node
  /// whose transform does most of it. Once for each such node.
  void reportFlat(const Node &geometry, Node &worst) {
    if (std::exchange(worst.isReported, true))
      return;
    errors.add(Error(message::transformPathFlattens(
                         geometry.name.empty() ? "its geometry" : "`" + geometry.name + "`",
                         runtime::largestCondition),
                     worst.transformPlace));
  }

  /// What two roots lead to in the same place is one instance, unless it differs in something else.
  /// What one root leads to several times in the same place remains several.
  void place(GeometryDescription &geometry, InstanceDescription instance) {
    instance.mask = geometry.mask;
    instance.hasBackFaces = geometry.hasBackFaces;
    if (geometry.id)
      instance.id = *geometry.id;
    if (instance.roots != 1 && instance.selector == 0) {
      Alike &alike = placementsLike(instance, geometry);
      if (std::exchange(alike.root, instance.roots) != instance.roots)
        alike.taken = 0;
      const std::size_t number = alike.taken++;
      if (number < alike.placements.size()) {
        geometry.placements[alike.placements[number]].roots |= instance.roots;
        return;
      }
    }
    geometry.placements.push_back(instance);
  }

  using Key = std::tuple<MovingTransform, std::int32_t, std::size_t, const VariableScope *>;
  static Key keyOf(const InstanceDescription &instance) {
    return {instance.transform, instance.id, instance.selector, instance.scope};
  }

  /// Placements of a geometry that differ in nothing but their roots.
  struct Alike {
    std::vector<std::size_t> placements; // indices
    std::uint32_t root = 0;              // the bit of the last root that leads to one of them
    std::size_t taken = 0;               // so many of them, from the first on, are below that root
  };
  struct Placed {
    std::map<Key, Alike> alike;
    std::size_t listed = 0; // placements that are in `alike`
  };

  Alike &placementsLike(const InstanceDescription &instance, const GeometryDescription &geometry) {
    Placed &known = placed[&geometry];
    for (; known.listed < geometry.placements.size(); ++known.listed)
      known.alike[keyOf(geometry.placements[known.listed])].placements.push_back(known.listed);
    return known.alike[keyOf(instance)];
  }

  /// The nodes that a root leads to.
  std::vector<bool> usedNodes() const {
    std::vector<bool> isUsed(nodes.size(), false);
    for (const Edge &edge : roots)
      isUsed[edge.node] = true;
    for (auto number = order.rbegin(); number != order.rend(); ++number)
      if (isUsed[*number])
        for (const Edge &child : nodes[*number].children)
          isUsed[child.node] = true;
    return isUsed;
  }

  void mentionNodes(const std::vector<bool> &isUsed) {
    scene.nodes.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      scene.nodes[i].name = {nodes[i].name, nodes[i].place};
      if (isUsed[i])
        for (const Edge &child : nodes[i].children)
          scene.nodes[child.node].parents.push_back(i);
    }
  }

  /// Groups, by their roots, the topmost nodes that several roots lead to: those below them are
  /// shared with them.
  void findShared() {
    std::vector<std::uint32_t> rootsOf(nodes.size(), 0); // as bits
    for (std::size_t number = 0; number < roots.size(); ++number)
      rootsOf[roots[number].node] |= 1u << number;
    std::vector<bool> isTop(nodes.size(), false); // it has a parent, or is a root, of other roots
    for (auto number = order.rbegin(); number != order.rend(); ++number)
      for (const Edge &child : nodes[*number].children)
        rootsOf[child.node] |= rootsOf[*number];
    for (std::size_t number = 0; number < roots.size(); ++number)
      isTop[roots[number].node] = true;
    for (std::size_t number = 0; number < nodes.size(); ++number)
      for (const Edge &child : nodes[number].children)
        if (rootsOf[number] != 0 && rootsOf[number] != rootsOf[child.node])
          isTop[child.node] = true;
    std::map<std::uint32_t, SharedNodes> shared;
    for (std::size_t number = 0; number < nodes.size(); ++number)
      if (const std::uint32_t bits = rootsOf[number]; isTop[number] && (bits & (bits - 1)) != 0)
        shared[bits].nodes.push_back({nodes[number].name, nodes[number].place});
    for (auto &[bits, group] : shared) {
      for (std::size_t number = 0; number < roots.size(); ++number)
        if (bits >> number & 1)
          group.roots.push_back(rootNames[number]);
      scene.shared.push_back(std::move(group));
    }
  }

  void warnOfUnused(const JsonValue &named, const std::vector<bool> &isUsed) {
    for (std::size_t i = 0; i < named.members.size(); ++i)
      if (!isUsed[i] && !gltf::isModel(nodes[i].place.file))
        scene.warnings.push_back({message::nodeUnreachable(nodes[i].name), nodes[i].place});
  }

  const JsonValue &root;
  const NodeReaders &readers;
  SceneDescription &scene;
  ErrorCollector &errors;
  std::vector<Node> nodes;
  std::unordered_map<std::string, std::size_t> numbers; // of named nodes
  std::vector<Edge> roots;
  std::vector<LocatedName> rootNames;                   // as many
  std::vector<std::size_t> order;                       // of nodes, children first
  std::map<const GeometryDescription *, Placed> placed; // of geometries below several roots
  bool hasMistakes = false;
};

} // namespace

void readGraph(const JsonValue &root, const NodeReaders &readers, SceneDescription &scene,
               ErrorCollector &errors) {
  if (root.find("nodes") || root.find("root") || root.find("roots"))
    GraphReader(root, readers, scene, errors).read();
}

VariableDefinitions readVariables(const JsonValue &value) {
  expect(value, Kind::Object, "`variables`");
  VariableDefinitions variables;
  for (const auto &[key, member] : value.members)
    variables[key.text] = {value.place(key), &member};
  return variables;
}

const VariableScope *addScope(SceneDescription &scene, const VariableScope *above,
                              VariableDefinitions variables) {
  scene.scopes.push_back(
      std::make_shared<VariableScope>(VariableScope{above, std::move(variables)}));
  return scene.scopes.back().get();
}

} // namespace rtsl::scene
