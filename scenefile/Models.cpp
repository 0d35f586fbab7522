#include "scenefile/Models.h"

#include "scenefile/files/KeptFiles.h"
#include "scenefile/gltf/Model.h"
#include "scenefile/gltf/Nodes.h"
#include "scenefile/gltf/Parts.h"
#include "scenefile/graph/TransformReader.h"
#include "scenefile/json/Reader.h"
#include "scenefile/obj/Model.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace rtsl::scene {

using Kind = JsonValue::Kind;

std::unique_ptr<gltf::File> openModel(const std::string &path) {
  return obj::isModel(path) ? obj::readModel(path) : std::make_unique<gltf::File>(path);
}

const gltf::File &ModelFiles::open(const std::string &path, const std::optional<Place> &place) {
  const std::lock_guard lock(mutex);
  auto found = opened.find(path);
  if (found == opened.end()) {
    try {
      found = opened.emplace(path, kept ? kept->model(path) : openModel(path)).first;
    } catch (Error &error) {
      if (place && (!error.place || error.place->line == 0))
        error.place = place;
      throw;
    }
  }
  return *found->second;
}

std::vector<std::string> ModelFiles::files() const {
  const std::lock_guard lock(mutex);
  std::vector<std::string> all;
  for (const auto &one : opened)
    for (std::string &file : one.second->files())
      all.push_back(std::move(file));
  return all;
}

ModelFiles &modelsOf(SceneDescription &scene) {
  if (!scene.models)
    scene.models = std::make_shared<ModelFiles>(scene.keptFiles);
  return *scene.models;
}

namespace {

class ModelExpansion {
public:
  ModelExpansion(JsonValue &root, SceneDescription &scene, ErrorCollector &errors)
      : root(root), scene(scene), errors(errors) {}

  void run() {
    if (JsonValue *nodes = root.find("nodes"))
      for (auto &node : nodes->members)
        expandNode(node.second);
    if (JsonValue *node = root.find("root"))
      expandNode(*node);
    if (JsonValue *roots = root.find("roots"))
      for (auto &node : roots->members)
        expandNode(node.second);
    moveObjects();
    if (JsonValue *camera = root.find("camera"))
      if (camera->find("model"))
        expandCamera(*camera);
    for (auto &[key, model] : models)
      addMembers(model);
    for (const std::string &module : modules)
      scene.imports.push_back({{module, root.place()}, "", false});
  }

private:
  /// A node, and those in place below it.
  void expandNode(JsonValue &node) {
    if (node.find("model"))
      return expandMention(node);
    if (JsonValue *child = node.find("child"))
      expandNode(*child);
    if (JsonValue *children = node.find("children"))
      for (JsonValue &child : children->elements)
        expandNode(child);
  }

  /// {"model": file, ...} becomes {"child": node, ...}.
  void expandMention(JsonValue &mention) {
    gltf::Play play;
    errors.attempt([&] { play = takePlay(mention); });
    for (auto &[key, value] : mention.members)
      if (key.text == "model") {
        key.text = "child";
        JsonValue name = value;
        name.kind = Kind::String;
        name.string = unreadable;
        errors.attempt([&, &path = value] { name.string = nodeOf(path, play); });
        if (name.string == unreadable)
          addStandIn(value);
        value = std::move(name);
      }
  }

  /// Removes a member of an object.
  static std::optional<JsonValue> taken(JsonValue &object, const char *key) {
    auto &members = object.members;
    const auto found = std::find_if(members.begin(), members.end(),
                                    [&](const auto &member) { return member.first.text == key; });
    if (found == members.end())
      return std::nullopt;
    JsonValue value = std::move(found->second);
    members.erase(found);
    return value;
  }

  /// What is shown of the animations: `animation` and `fps` of a mention, which are removed.
  gltf::Play takePlay(JsonValue &mention) const {
    gltf::Play play;
    if (const JsonValue *frame = root.find("frame"))
      play.frame = readNumber(*frame, "`frame`");
    const JsonValue *render = root.find("render");
    play.isDuringFrame = render && render->find("shutter");
    const std::optional<JsonValue> name = taken(mention, "animation"), rate = taken(mention, "fps");
    if (name) {
      play.animation = expect(*name, Kind::String, "`animation`").string;
      play.place = name->place();
    }
    if (rate) {
      play.framesPerSecond = readNumber(*rate, "`fps`");
      if (!(play.framesPerSecond > 0))
        throw Error(message::badFrameRate(), rate->place());
    }
    return play;
  }

  /// The name of the node that shows a file.
  std::string nodeOf(const JsonValue &path, const gltf::Play &play) {
    expect(path, Kind::String, "`model`");
    const std::string file = resolvePath(path, scene.file);
    const std::string shown = fmt::format("{}\n{}\n{}", file, play.animation, play.framesPerSecond);
    const auto known = models.find(shown);
    if (known != models.end())
      return known->second.root;
    gltf::Model failed;
    failed.root = unreadable;
    gltf::Model &model = models.emplace(shown, failed).first->second;
    const gltf::File &opened = modelsOf(scene).open(file, path.place());
    model = gltf::modelOf(opened, play, freeName(path.string),
                          path.isIncluded ? gltf::Mention{file, true}
                                          : gltf::Mention{path.string, path.fromOverride},
                          path);
    modules.insert(model.modules.begin(), model.modules.end());
    scene.isAnimated |= model.isAnimated;
    std::move(model.warnings.begin(), model.warnings.end(), std::back_inserter(scene.warnings));
    return model.root;
  }

  /// A name that no node of the author's has.
  std::string freeName(std::string name) const {
    const JsonValue *nodes = root.find("nodes");
    const auto isTaken = [&] {
      return (nodes && nodes->find(name)) ||
             std::any_of(models.begin(), models.end(),
                         [&](const auto &model) { return model.second.root == name; });
    };
    while (isTaken())
      name += "'";
    return name;
  }

  /// Models among `objects` become children of the (first) root.
  void moveObjects() {
    JsonValue *objects = root.find("objects");
    if (!objects)
      return;
    std::vector<JsonValue> moved, kept;
    for (JsonValue &object : objects->elements)
      (object.find("model") ? moved : kept).push_back(std::move(object));
    objects->elements = std::move(kept);
    if (moved.empty())
      return;
    for (JsonValue &mention : moved)
      expandMention(mention);
    JsonValue *several = root.find("roots"), *top = root.find("root");
    if (several && !several->members.empty())
      top = &several->members.front().second;
    if (top)
      moved.insert(moved.begin(), *top);
    JsonValue children = gltf::valueAt(moved.front(), Kind::Array);
    children.elements = std::move(moved);
    JsonValue node = gltf::object(children, {{"children", children}});
    if (top)
      *top = std::move(node);
    else
      root.members.emplace_back(JsonKey{"root", 0, 0, 0}, std::move(node));
  }

  /// {"model": file, "name": ..., "transform": ...} becomes a camera of the library.
  void expandCamera(JsonValue &mention) {
    JsonValue camera = gltf::objectOf(mention, "PerspectiveCamera"); // if there are mistakes
    errors.attempt([&] { camera = cameraOf(mention); });
    mention = std::move(camera);
  }

  JsonValue cameraOf(JsonValue &mention) {
    const gltf::Play play = takePlay(mention);
    checkKeys(mention, {"model", "name", "transform"}, "the camera of a model");
    const JsonValue &path = expect(*mention.find("model"), Kind::String, "`model`");
    const std::string file = resolvePath(path, scene.file);
    if (std::any_of(models.begin(), models.end(), [&](const auto &model) {
          return model.second.root == unreadable && model.first.rfind(file + "\n", 0) == 0;
        }))
      return gltf::objectOf(mention, "PerspectiveCamera"); // it is reported where its nodes are
    std::string name;
    if (const JsonValue *found = mention.find("name"))
      name = expect(*found, Kind::String, "`name`").string;
    runtime::Transform transform;
    if (const JsonValue *found = mention.find("transform")) {
      const runtime::MovingTransform read = readTransform(*found);
      if (read.moves())
        throw Error(message::movingCamera(), found->place());
      transform = read.still();
    }
    const gltf::File &opened = modelsOf(scene).open(file, path.place());
    try {
      std::vector<Warning> known; // where its nodes are
      const gltf::Animation animation(opened, play, known);
      scene.isAnimated |= animation.moves();
      return gltf::cameraOf(opened, animation, name, transform, path, modules);
    } catch (const Error &error) {
      throw gltf::named(error, file);
    }
  }

  /// A node in place of that of a file with mistakes, so that there are no others.
  void addStandIn(const JsonValue &path) {
    gltf::Model &model = models[unreadable];
    if (model.nodes.empty())
      model.nodes.emplace_back(JsonKey{unreadable, 0, 0, 0},
                               gltf::object(path, {{"light", gltf::objectOf(path, "PointLight")}}));
  }

  /// Adds what a model has to sections of the scene.
  void addMembers(gltf::Model &model) {
    add("materials", model.materials);
    add("nodes", model.nodes);
  }

  void add(const char *section, gltf::Model::Members &members) {
    if (members.empty())
      return;
    if (!root.find(section))
      root.members.emplace_back(JsonKey{section, 0, 0, 0}, gltf::valueAt(root, Kind::Object));
    JsonValue &object = *root.find(section);
    std::move(members.begin(), members.end(), std::back_inserter(object.members));
  }

  /// Stands for the node of a file with mistakes, which are reported.
  static constexpr const char *unreadable = "\x01";

  JsonValue &root;
  SceneDescription &scene;
  ErrorCollector &errors;
  std::map<std::string, gltf::Model> models; // by file and animation; and `unreadable`
  gltf::Modules modules;
};

} // namespace

void expandModels(JsonValue &root, SceneDescription &scene, ErrorCollector &errors) {
  ModelExpansion(root, scene, errors).run();
}

} // namespace rtsl::scene
