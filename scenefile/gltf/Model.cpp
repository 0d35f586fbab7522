#include "scenefile/gltf/Model.h"

#include "scenefile/gltf/Animation.h"
#include "scenefile/gltf/Material.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/gltf/Nodes.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

class ModelMaker {
public:
  ModelMaker(const File &file, const Play &play, const std::string &name, const Mention &mention,
             const JsonValue &source)
      : file(file), play(play), name(name), mention(mention), source(source) {}

  Model make() {
    model.root = name;
    std::vector<Node> nodes;
    errors.attempt([&] {
      animation.emplace(file, play, model.warnings);
      model.isAnimated = animation->moves();
      nodes = nodesOf(file, *animation);
    });
    keepLightsAtRest(nodes);
    std::vector<std::vector<JsonValue>> children(nodes.size() + 1); // by 1 + the node; of the root
    // Children come after their parents.
    for (std::size_t i = nodes.size(); i-- > 0;)
      errors.attempt([&] { addNode(nodes[i], children[i + 1], children[nodes[i].parent]); });
    errors.throwIfAny();
    if (children[0].empty())
      throw Error(message::emptyModel(file.path()), source.place());
    addChildren(name, source, std::move(children[0]));
    model.warnings.insert(model.warnings.end(), file.warnings().begin(), file.warnings().end());
    for (Warning &warning : model.warnings)
      warning = named(std::move(warning), file.path());
    return std::move(model);
  }

private:
  static void add(Model::Members &members, const std::string &key, JsonValue value) {
    JsonKey named{key, value.line, value.column, value.length};
    members.emplace_back(std::move(named), std::move(value));
  }

  /// A node of these children, which were found from the last to the first.
  void addChildren(const std::string &key, const JsonValue &from, std::vector<JsonValue> children,
                   const Node *place = nullptr) {
    JsonValue node = valueAt(from, Kind::Object);
    set(node, "children", list(from, {children.rbegin(), children.rend()}));
    if (place && place->moving) {
      set(node, "transform", *place->moving);
    } else if (place && !place->transform.isIdentity()) {
      std::vector<double> matrix;
      for (std::size_t column = 0; column < 4; ++column) {
        for (const double x : place->transform.columns[column])
          matrix.push_back(x);
        matrix.push_back(column == 3 ? 1 : 0);
      }
      set(node, "transform", object(from, {{"matrix", numbers(from, matrix)}}));
    }
    add(model.nodes, key, std::move(node));
  }

  /// Lights of a scene do not move during a frame, so the nodes above them do not either.
  void keepLightsAtRest(std::vector<Node> &nodes) {
    for (const Node &node : nodes)
      if (extension(*node.json, "KHR_lights_punctual"))
        for (std::size_t above = std::size_t(&node - nodes.data()) + 1; above != 0;
             above = nodes[above - 1].parent)
          if (nodes[above - 1].moving) {
            nodes[above - 1].moving.reset();
            warn(*nodes[above - 1].json, message::movingLightIgnored(nodes[above - 1].what));
          }
  }

  /// Adds the node, if it shows something, and its mention to `siblings`.
  void addNode(const Node &node, std::vector<JsonValue> &children,
               std::vector<JsonValue> &siblings) {
    const JsonValue &json = *node.json;
    if (node.transform.determinant() == 0)
      return warn(json, message::flatNodeIgnored(node.what));
    if (json.find("matrix"))
      for (const char *part : {"translation", "rotation", "scale"})
        if (const JsonValue *ignored = json.find(part))
          warn(*ignored, message::nodeHasMatrix(part, node.what));
    if (const JsonValue *skin = json.find("skin"))
      warn(*skin, message::skinIgnored(node.what));
    if (const JsonValue *punctual = extension(json, "KHR_lights_punctual")) {
      JsonValue light = lightOf(file, require(*punctual, "light", node.what), node.what,
                                model.modules, model.warnings);
      children.push_back(object(*punctual, {{"light", std::move(light)}}));
    }
    if (const JsonValue *mesh = json.find("mesh"))
      addMesh(*mesh, node, children);
    if (children.empty())
      return;
    const std::string key = name + "/" + nodeLabels.of(node.index);
    siblings.push_back(text(json, key));
    addChildren(key, json, std::move(children), &node);
  }

  /// The weights of the morph targets of a node's mesh, as a scene file has them; nothing: it has
  /// no targets, or all weights are 0.
  std::optional<JsonValue> weightsOf(std::size_t mesh, const Node &node) const {
    const JsonValue &json = file.list("meshes")[mesh];
    const JsonValue *given = node.json->find("weights");
    const bool isOfNode = given != nullptr;
    if (!given)
      given = json.find("weights");
    std::vector<double> rest;
    if (given)
      rest = readNumbers(
          *given, given->elements.size(),
          fmt::format("`weights` of {}", isOfNode ? node.what : fmt::format("`meshes.{}`", mesh)));
    if (std::optional<JsonValue> moving = animation->weightsOf(*node.json, node.index))
      return moving;
    const std::vector<double> weights = animation->weightsAt(node.index, rest);
    if (std::all_of(weights.begin(), weights.end(), [](double one) { return one == 0; }))
      return std::nullopt;
    return numbers(given ? *given : *node.json, weights);
  }

  /// Each mesh is one node, which all nodes that show it share, if its shape is the same in all.
  void addMesh(const JsonValue &number, const Node &node, std::vector<JsonValue> &children) {
    const std::size_t index = file.index("meshes", number, "`mesh` of " + node.what);
    const std::optional<JsonValue> weights = weightsOf(index, node);
    const auto [known, isNew] =
        meshes.emplace(std::pair(index, weights ? node.index + 1 : 0), std::string());
    if (isNew) {
      std::string key = fmt::format("{}/meshes/{}", name, meshLabels.of(index));
      if (weights)
        key += fmt::format(" of {}", nodeLabels.of(node.index));
      std::vector<JsonValue> primitives = primitivesOf(index, weights);
      if (!primitives.empty()) {
        addChildren(key, file.list("meshes")[index], std::move(primitives));
        known->second = key;
      }
    }
    if (!known->second.empty())
      children.push_back(text(number, known->second));
  }

  std::vector<JsonValue> primitivesOf(std::size_t index, const std::optional<JsonValue> &weights) {
    const JsonValue &mesh = file.list("meshes")[index];
    const std::string what = fmt::format("`meshes.{}`", index);
    const JsonValue &primitives =
        expect(require(mesh, "primitives", what), Kind::Array, "`primitives` of " + what);
    std::vector<JsonValue> made;
    for (std::size_t i = primitives.elements.size(); i-- > 0;)
      errors.attempt([&] {
        const std::string part = partOfPrimitive(index, i);
        const JsonValue &primitive = primitiveOf(file, part, mesh.place());
        checkPrimitive(file, primitive, part);
        if (warned.insert(part).second)
          for (Warning &warning : warningsOf(primitive, part))
            model.warnings.push_back(std::move(warning));
        if (!hasTriangles(primitive, part))
          return;
        JsonValue path = text(primitive, mention.path);
        path.fromOverride = mention.isFromOverride;
        made.push_back(object(primitive, {{"name", text(primitive, nameOf(mesh, index, i))},
                                          {"mesh", std::move(path)},
                                          {"part", text(primitive, part)},
                                          {"material", materialOf(primitive, part)}}));
        if (weights && targetCount(primitive, part) != 0)
          set(made.back(), "weights", *weights);
      });
    return made;
  }

  std::string nameOf(const JsonValue &mesh, std::size_t index, std::size_t primitive) const {
    const std::string label = name + "/" + meshLabels.of(index);
    return mesh.find("primitives")->elements.size() == 1 ? label
                                                         : fmt::format("{}.{}", label, primitive);
  }

  /// What the name of a material ends with, on meshes with these vertex colors.
  static const char *suffixOf(VertexColors colors) {
    switch (colors) {
    case VertexColors::None:
      return "";
    case VertexColors::Rgb:
      return " with vertex colors";
    case VertexColors::Rgba:
      return " with vertex colors and alpha";
    }
    return "";
  }

  /// The name of a primitive's material, which is made once for each kind of vertex colors.
  JsonValue materialOf(const JsonValue &primitive, const std::string &part) {
    const VertexColors colors = vertexColorsOf(file, primitive, part);
    const JsonValue *number = primitive.find("material");
    if (!number) {
      const std::string key = name + "/default material" + suffixOf(colors);
      if (materials.insert(key).second)
        add(model.materials, key, defaultMaterial(source, colors, model.modules));
      return text(primitive, key);
    }
    const std::size_t index =
        file.index("materials", *number, fmt::format("`material` of `{}`", part));
    const std::string key = name + "/" + materialLabels.of(index) + suffixOf(colors);
    if (materials.insert(key).second)
      errors.attempt([&] {
        add(model.materials, key,
            gltf::materialOf(file, index, colors, mention, model.modules, model.warnings));
      });
    return text(*number, key);
  }

  void warn(const JsonValue &where, std::string message) {
    model.warnings.push_back({std::move(message), where.place()});
  }

  const File &file;
  const Play &play;
  const std::string &name;
  const Mention &mention;
  const JsonValue &source;
  Model model;
  const Labels nodeLabels{file, "nodes"}, meshLabels{file, "meshes"},
      materialLabels{file, "materials"};
  std::optional<Animation> animation;
  /// Names of their nodes, by mesh and 1 + the node whose weights it has; empty: without triangles.
  std::map<std::pair<std::size_t, std::size_t>, std::string> meshes;
  std::set<std::string> warned;    // parts
  std::set<std::string> materials; // made
  ErrorCollector errors;
};

} // namespace

Model modelOf(const File &file, const Play &play, const std::string &name, const Mention &mention,
              const JsonValue &source) {
  try {
    return ModelMaker(file, play, name, mention, source).make();
  } catch (const Error &error) {
    throw named(error, file.path());
  }
}

} // namespace rtsl::scene::gltf
