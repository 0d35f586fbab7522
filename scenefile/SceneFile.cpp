//===- SceneFile.cpp - from JSON to a description -------------------------===//
#include "scenefile/SceneFile.h"

#include "scenefile/Includes.h"
#include "scenefile/LibraryEngines.h"
#include "scenefile/Models.h"
#include "scenefile/gltf/File.h"
#include "scenefile/graph/Graph.h"
#include "scenefile/json/KeyFrames.h"
#include "scenefile/json/Reader.h"
#include "scenefile/sections/GeometryReader.h"
#include "scenefile/sections/ObjectReader.h"
#include "scenefile/sections/RenderReader.h"
#include "scenefile/sections/SettingsReader.h"
#include "scenefile/sections/ValueFiles.h"
#include "support/AtomicFile.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;

class SceneReader {
public:
  /// `errors` has those that were found before.
  SceneReader(const JsonValue &root, SceneDescription &scene, ErrorCollector &errors)
      : root(root), scene(scene), errors(errors) {}

  /// `isPart`: it need not have a camera or a ray generation.
  void read(bool isPart = false) {
    expect(root, Kind::Object, "a scene");
    checkVersion(root);
    errors.attempt([&] {
      checkKeys(root, {"$schema", "rtsl",     "import",     "camera",  "rayGeneration", "images",
                       "helpers", "textures", "materials",  "objects", "nodes",         "root",
                       "roots",   "lights",   "background", "ambient", "exception",     "render",
                       "buffers", "passes",   "variables",  "cameras", "frame"},
                "a scene");
    });
    section("import", [&](const JsonValue &imports) { readImports(imports); });
    readCameras();
    readSingle("rayGeneration", scene.rayGeneration);
    readImages();
    readBuffers();
    readNamed("helpers", scene.helpers);
    readNamed("textures", scene.textures);
    readNamed("materials", scene.materials);
    scene.refused.isAny |= !section("variables", [&](const JsonValue &variables) {
      scene.scopes.front()->variables = readVariables(variables);
    });
    readList("objects", [&](const JsonValue &object) {
      scene.objects.push_back(readObjectOfList(object, scene, errors));
    });
    readGraph(root,
              {[&](const JsonValue &node) { return readGeometry(node, "a node", scene, errors); },
               readReference},
              scene, errors);
    readList("lights",
             [&](const JsonValue &light) { scene.lights.push_back(readObject(light, "a light")); });
    section("background", [&](const JsonValue &background) {
      if (background.kind == Kind::Object)
        scene.background = readObject(background, "`background`");
      else if (background.kind == Kind::String)
        throw Error(message::backgroundIsString(background.string), background.place());
      else
        scene.backgroundColor = &readColor(background, "`background`");
    });
    readSingle("exception", scene.exception);
    section("ambient",
            [&](const JsonValue &ambient) { scene.ambient = &readColor(ambient, "`ambient`"); });
    errors.attempt([&] {
      if (const JsonValue *render = root.find("render"))
        libraryEngine = readRender(*render, root.find("rayGeneration"), scene, errors);
      readPasses();
      if (!isPart) {
        requireStart();
        warnOfRayGeneration();
      }
      if (libraryEngine)
        useLibraryEngine(scene, *libraryEngine);
      else if (scene.render.engine == runtime::Engine::Programs)
        useRayGeneration(scene);
    });
  }

private:
  /// Reads the value of a key, if present. An error in it does not prevent reading other sections.
  /// Gives whether there was none.
  template <typename Read>
  bool section(const char *key, Read read) {
    const JsonValue *value = root.find(key);
    return !value || errors.attempt([&] { read(*value); });
  }

  /// Reads something that others may refer to by its name.
  template <typename Read>
  void attemptNamed(const std::string &name, Read read) {
    if (!errors.attempt(read))
      scene.refused.names.insert(name);
  }

  template <typename Read>
  void readList(const char *key, Read read) {
    section(key, [&](const JsonValue &list) {
      expect(list, Kind::Array, fmt::format("`{}`", key));
      for (const JsonValue &element : list.elements)
        errors.attempt([&] { read(element); });
    });
  }

  void readSingle(const char *key, std::optional<ObjectDescription> &object) {
    section(key,
            [&](const JsonValue &value) { object = readObject(value, fmt::format("`{}`", key)); });
  }

  /// The scene's camera: an object, the name of one of `cameras`, or else the first of these.
  void readCameras() {
    section("cameras", [&](const JsonValue &value) {
      expect(value, Kind::Object, "`cameras`");
      for (const auto &[key, member] : value.members)
        errors.attempt([&, &key = key, &member = member] {
          scene.cameras.emplace_back(key.text, readObject(member, fmt::format("`{}`", key.text)));
        });
    });
    if (!scene.cameras.empty())
      scene.camera = scene.cameras.front().second;
    section("camera", [&](const JsonValue &value) {
      scene.camera =
          value.kind == Kind::String ? cameraNamed(value) : readObject(value, "`camera`");
    });
  }

  ObjectDescription cameraNamed(const JsonValue &name) const {
    std::vector<std::string> names;
    for (const auto &[known, camera] : scene.cameras) {
      if (known == name.string)
        return camera;
      names.push_back(known);
    }
    Error error(names.empty() ? message::noCameras(name.string)
                              : message::noSuchCamera(name.string, fmt::join(names, "`, `")),
                name.place());
    if (const std::string near = closestName(name.string, names); !near.empty())
      error.fix(near);
    throw error;
  }

  void requireCamera(const std::string &what) const {
    if (!root.find("cameras"))
      require(root, "camera", what);
    else if (root.find("cameras")->members.empty() && !root.find("camera"))
      throw Error(message::cameraMissing(what), root.find("cameras")->place());
  }

  /// Requires the object that starts samples.
  void requireStart() const {
    if (scene.render.engine == runtime::Engine::Classic)
      requireCamera("a scene");
    else if (root.find("passes"))
      return;
    else if (libraryEngine)
      requireCamera(fmt::format("a scene for the engine `{}`", libraryEngine->string));
    else
      require(root, "rayGeneration", "a scene for the engine `programs`");
  }

  /// Warns of a ray generation that does not run because no engine is chosen.
  void warnOfRayGeneration() {
    const JsonValue *render = root.find("render"), *unused = root.find("rayGeneration");
    const bool isChosen = render && render->find("engine");
    if (unused && !isChosen && scene.render.engine == runtime::Engine::Classic)
      scene.warnings.push_back({message::rayGenerationIgnored(), unused->place()});
  }

  void readImports(const JsonValue &value) {
    if (value.kind == Kind::String)
      return readImport(value);
    expect(value, Kind::Array, "`import`");
    for (const JsonValue &element : value.elements)
      errors.attempt([&] { readImport(element); });
  }

  void readImport(const JsonValue &value) {
    expect(value, Kind::String, "an import");
    ImportDescription import{{value.string, value.place()}, ""};
    if (value.string.empty())
      throw Error(message::importNameEmpty(), value.place());
    if (gltf::hasEnding(value.string, ".json") || gltf::isModel(value.string))
      throw Error(message::sceneImported(value.string), value.place());
    if (gltf::hasEnding(value.string, ".rtsl"))
      import.path = resolvePath(value, scene.file);
    scene.imports.push_back(std::move(import));
  }

  void readImages() {
    section("images", [&](const JsonValue &value) {
      expect(value, Kind::Object, "`images`");
      for (const auto &[key, member] : value.members)
        attemptNamed(key.text, [&, &key = key, &member = member] {
          refuseTakenName(key.text, value.place(key));
          expect(member, Kind::Object, fmt::format("`{}`", key.text));
          if (!isImage(member))
            throw Error(message::namedImageSourceMissing(key.text), member.place());
          scene.images[key.text] = readObject(member, fmt::format("`{}`", key.text));
        });
    });
    readValueFiles(root, scene, errors);
  }

  void readBuffers() {
    section("buffers", [&](const JsonValue &value) {
      expect(value, Kind::Object, "`buffers`");
      for (const auto &[key, member] : value.members)
        attemptNamed(key.text, [&, &key = key, &member = member] {
          if (member.kind != Kind::Array && !isBuffer(member))
            throw Error(message::namedBufferSourceMissing(key.text), member.place());
          scene.buffers[key.text] = &member;
        });
    });
  }

  /// Each pass has what `render` says, but for what it says itself.
  void readPasses() {
    readList("passes", [&](const JsonValue &value) {
      expect(value, Kind::Object, "a pass");
      checkKeys(value, {"rayGeneration", "size", "spp", "depth", "seed"}, "a pass");
      PassDescription pass;
      pass.place = value.place();
      pass.rayGeneration = readObject(require(value, "rayGeneration", "a pass"), "`rayGeneration`");
      pass.render = scene.render;
      pass.render.engine = runtime::Engine::Programs;
      readSettings(value, pass.render, scene, value.find("rayGeneration"), errors);
      scene.passes.push_back(std::move(pass));
    });
    const JsonValue *passes = root.find("passes");
    if (passes && passes->kind == Kind::Array && passes->elements.empty())
      throw Error(message::noPasses(), passes->place());
    if (!passes || scene.passes.empty())
      return;
    if (libraryEngine || root.find("rayGeneration"))
      throw Error(libraryEngine ? message::engineAndPasses() : message::rayGenerationAndPasses(),
                  libraryEngine ? libraryEngine->place() : root.find("rayGeneration")->place());
    scene.rayGeneration = scene.passes.back().rayGeneration;
    scene.render = scene.passes.back().render;
  }

  void readNamed(const char *section, std::map<std::string, ObjectDescription> &objects) {
    this->section(section, [&](const JsonValue &value) {
      expect(value, Kind::Object, fmt::format("`{}`", section));
      for (const auto &[key, member] : value.members)
        attemptNamed(key.text, [&, &key = key, &member = member] {
          refuseTakenName(key.text, member.place(key));
          objects[key.text] = readObject(member, fmt::format("`{}`", key.text));
        });
    });
  }

  /// Images, helpers, textures and materials share one namespace.
  void refuseTakenName(const std::string &name, const Place &place) const {
    const auto refuse = [&](const auto &objects, const char *what) {
      if (auto other = objects.find(name); other != objects.end())
        throw Error(message::nameTaken(name, what), place)
            .related(other->second.place, fmt::format("the {}", what));
    };
    refuse(scene.images, "image");
    refuse(scene.helpers, "helper");
    refuse(scene.textures, "texture");
  }

  const JsonValue &root;
  SceneDescription &scene;
  const JsonValue *libraryEngine = nullptr; // the value of `engine`, if it is one of the library's
  ErrorCollector &errors;
};

/// Makes the scene that of its frame.
void chooseFrame(JsonValue &root, SceneDescription &scene, ErrorCollector &errors) {
  if (const JsonValue *value = root.find("frame"))
    errors.attempt([&] { scene.frame = readNumber(*value, "`frame`"); });
  scene.keyFrames = resolveKeyFrames(root, scene.frame, errors);
  scene.isAnimated = !scene.keyFrames.empty();
}

} // namespace

SceneDescription parseScene(const std::string &text, const std::string &path,
                            const std::vector<std::string> &overrides,
                            std::shared_ptr<KeptFiles> kept, ErrorCollector *errors) {
  auto root = std::make_shared<JsonValue>(parseJson(text, path));
  ErrorCollector found, ofFrames;
  SceneDescription scene;
  scene.included = expandIncludes(*root, path, found);
  for (const std::string &override : overrides)
    found.attempt([&] { applyOverride(*root, override); });
  const bool isPart = found.count() > 0; // without what could not be read
  chooseFrame(*root, scene, ofFrames);
  scene.file = path;
  scene.root = root;
  scene.keptFiles = std::move(kept);
  expandModels(*root, scene, found);
  scene.refused.isAny = found.count() > 0;
  found.attempt([&] { ofFrames.throwIfAny(); }); // values are there all the same
  scene.refused.isAny |= !found.attempt([&] { SceneReader(*root, scene, found).read(isPart); });
  if (errors)
    *errors = std::move(found);
  else
    found.throwIfAny();
  return scene;
}

SceneDescription readPart(std::shared_ptr<JsonValue> root, SceneDescription part) {
  ErrorCollector errors;
  expandModels(*root, part, errors);
  SceneReader(*root, part, errors).read(true);
  errors.throwIfAny();
  part.root = std::move(root);
  return part;
}

SceneDescription readSceneFile(const std::string &path, const std::vector<std::string> &overrides,
                               std::shared_ptr<KeptFiles> kept, ErrorCollector *errors) {
  return parseScene(readFile(path), path, overrides, std::move(kept), errors);
}

} // namespace rtsl::scene
