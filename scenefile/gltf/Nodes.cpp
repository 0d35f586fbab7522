#include "scenefile/gltf/Nodes.h"

#include "scenefile/gltf/Accessor.h"
#include "scenefile/gltf/Animation.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;
using runtime::Transform;

namespace {

Transform matrixOf(const JsonValue &matrix, const std::string &what) {
  const std::vector<double> m = readNumbers(matrix, 16, "`matrix` of " + what);
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    throw Error(message::modelMatrixNotAffine(what), matrix.place());
  Transform transform;
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      transform.columns[column][row] = m[4 * column + row];
  return transform;
}

class NodeReader {
public:
  NodeReader(const File &file, const Animation &animation)
      : file(file), animation(animation), known(file.list("nodes").size(), 0) {}

  std::vector<Node> read() {
    errors.attempt([&] { readRoots(); });
    // Children are added at the end while the list is gone through; what a transform flattens has
    // none.
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (const JsonValue *children = nodes[i].json->find("children");
          children && nodes[i].transform.determinant() != 0)
        errors.attempt([&] {
          expect(*children, Kind::Array, "`children` of " + nodes[i].what);
          for (const JsonValue &child : children->elements)
            errors.attempt([&] { add(child, "a child of " + nodes[i].what, i + 1); });
        });
    errors.throwIfAny();
    return std::move(nodes);
  }

private:
  void readRoots() {
    const auto &scenes = file.list("scenes");
    if (scenes.empty())
      return addAll();
    const JsonValue *number = file.root().find("scene");
    const std::size_t index = number ? file.index("scenes", *number, "`scene`") : 0;
    const std::string what = fmt::format("`scenes.{}`", index);
    const JsonValue *roots = scenes[index].find("nodes");
    if (!roots)
      return;
    expect(*roots, Kind::Array, "`nodes` of " + what);
    for (const JsonValue &root : roots->elements)
      errors.attempt([&] { add(root, "a node of " + what, 0); });
  }

  /// All nodes that are no child of another.
  void addAll() {
    std::vector<bool> isChild(known.size(), false);
    for (const JsonValue &node : file.list("nodes"))
      if (const JsonValue *children = node.find("children"))
        for (const JsonValue &child : children->elements)
          if (child.number >= 0 && child.number < double(known.size()))
            isChild[std::size_t(child.number)] = true;
    for (std::size_t i = 0; i < known.size(); ++i)
      if (!isChild[i])
        append(i, 0);
  }

  void add(const JsonValue &number, const std::string &what, std::size_t parent) {
    const std::size_t index = file.index("nodes", number, what);
    if (known[index] == 0)
      return append(index, parent);
    for (std::size_t above = parent; above != 0; above = nodes[above - 1].parent)
      if (nodes[above - 1].index == index)
        throw Error(message::modelNodeCycle(index), number.place());
    throw Error(message::modelNodeTwice(index), number.place());
  }

  void append(std::size_t index, std::size_t parent) {
    Node node;
    node.index = index;
    node.parent = parent;
    node.json = &file.list("nodes")[index];
    node.what = fmt::format("`nodes.{}`", index);
    errors.attempt([&] {
      if (const JsonValue *matrix = node.json->find("matrix")) {
        node.transform = matrixOf(*matrix, node.what);
        return;
      }
      const Motion rest = motionOf(*node.json, node.what);
      node.transform = animation.at(index, rest).transform();
      node.moving = animation.transformOf(*node.json, index, rest);
    });
    node.toWorld = parent ? node.transform.then(nodes[parent - 1].toWorld) : node.transform;
    nodes.push_back(std::move(node));
    known[index] = nodes.size();
  }

  const File &file;
  const Animation &animation;
  std::vector<std::size_t> known; // by index: 1 + where it is in `nodes`
  std::vector<Node> nodes;
  ErrorCollector errors;
};

std::array<double, 3> at(const Transform &transform, const std::array<double, 3> &point) {
  std::array<double, 3> result = transform.columns[3];
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      result[row] += transform.columns[column][row] * point[column];
  return result;
}

} // namespace

std::vector<Node> nodesOf(const File &file, const Animation &animation) {
  return NodeReader(file, animation).read();
}

Transform Motion::transform() const {
  const double length = std::sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] +
                                  rotation[2] * rotation[2] + rotation[3] * rotation[3]);
  const double x = rotation[0] / length, y = rotation[1] / length, z = rotation[2] / length,
               w = rotation[3] / length;
  Transform turn;
  turn.columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  turn.columns[1] = {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  turn.columns[2] = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
  return Transform::scale(scale[0], scale[1], scale[2])
      .then(turn)
      .then(Transform::translate(translation[0], translation[1], translation[2]));
}

Motion motionOf(const JsonValue &node, const std::string &what) {
  Motion motion;
  if (const JsonValue *found = node.find("translation"))
    motion.translation = readNumbers(*found, 3, "`translation` of " + what);
  if (const JsonValue *found = node.find("rotation")) {
    motion.rotation = readNumbers(*found, 4, "`rotation` of " + what);
    if (std::all_of(motion.rotation.begin(), motion.rotation.end(),
                    [](double x) { return std::fabs(x) < 1e-100; }))
      throw Error(message::zeroModelRotation(what), found->place());
  }
  if (const JsonValue *found = node.find("scale"))
    motion.scale = readNumbers(*found, 3, "`scale` of " + what);
  return motion;
}

std::string nameOf(const JsonValue &element) {
  const JsonValue *name = element.find("name");
  return name && name->kind == Kind::String ? name->string : std::string();
}

Labels::Labels(const File &file, const char *list)
    : elements(file.list(list)), start(std::string(list) + ".") {
  for (const JsonValue &element : elements)
    ++counts[nameOf(element)];
}

std::string Labels::of(std::size_t index) const {
  const std::string name = nameOf(elements[index]);
  const bool isDistinct =
      !name.empty() && counts.at(name) == 1 && name.compare(0, start.size(), start) != 0;
  return isDistinct ? name : start + std::to_string(index);
}

std::optional<Box> boxOf(const File &file, const Animation &animation) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Box box{{far, far, far}, {-far, -far, -far}};
  for (const Node &node : nodesOf(file, animation)) {
    const JsonValue *number = node.json->find("mesh");
    if (!number)
      continue;
    const std::size_t mesh = file.index("meshes", *number, "`mesh` of " + node.what);
    const JsonValue *primitives = file.list("meshes")[mesh].find("primitives");
    for (std::size_t i = 0; primitives && i < primitives->elements.size(); ++i) {
      const std::string part = partOfPrimitive(mesh, i);
      const JsonValue &primitive = primitiveOf(file, part, Place{file.path()});
      if (!hasTriangles(primitive, part))
        continue;
      const std::string what = fmt::format("`POSITION` of `{}`", part);
      const JsonValue &attributes = require(primitive, "attributes", fmt::format("`{}`", part));
      const Accessor positions(
          file, require(attributes, "POSITION", fmt::format("`attributes` of `{}`", part)), what);
      const auto corners = positions.box();
      for (std::size_t corner = 0; corner < 8; ++corner) {
        const auto point = at(node.toWorld, {corners[corner & 1][0], corners[corner >> 1 & 1][1],
                                             corners[corner >> 2][2]});
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::min(box.low[axis], point[axis]);
          box.high[axis] = std::max(box.high[axis], point[axis]);
        }
      }
    }
  }
  return box.low[0] <= box.high[0] ? std::optional(box) : std::nullopt;
}

} // namespace rtsl::scene::gltf
