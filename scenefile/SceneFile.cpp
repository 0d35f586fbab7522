//===- SceneFile.cpp - from JSON to a description -------------------------===//
#include "scenefile/SceneFile.h"

#include "scenefile/Includes.h"
#include "scenefile/LibraryEngines.h"
#include "scenefile/Models.h"
#include "scenefile/SettingsReader.h"
#include "scenefile/files/MeshPaths.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/graph/Graph.h"
#include "scenefile/graph/KeyTimes.h"
#include "scenefile/graph/TransformReader.h"
#include "scenefile/json/KeyFrames.h"
#include "scenefile/json/Reader.h"
#include "support/AtomicFile.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
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
    readList("objects",
             [&](const JsonValue &object) { scene.objects.push_back(readObjectOfList(object)); });
    readGraph(root,
              {[&](const JsonValue &node) { return readGeometry(node, "a node"); },
               [&](const JsonValue &value, const std::string &what) {
                 return readReference(value, what);
               }},
              scene, errors);
    readList("lights",
             [&](const JsonValue &light) { scene.lights.push_back(readObject(light, "a light")); });
    section("background", [&](const JsonValue &background) {
      if (background.kind == Kind::Object)
        scene.background = readObject(background, "`background`");
      else
        scene.backgroundColor = &readColor(background, "`background`");
    });
    readSingle("exception", scene.exception);
    section("ambient",
            [&](const JsonValue &ambient) { scene.ambient = &readColor(ambient, "`ambient`"); });
    errors.attempt([&] {
      if (const JsonValue *render = root.find("render"))
        readRender(*render);
      readPasses();
      if (!isPart)
        requireStart();
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
    const std::string extension = ".rtsl";
    bool isFile = value.string.size() > extension.size() &&
                  value.string.compare(value.string.size() - extension.size(), extension.size(),
                                       extension) == 0;
    if (isFile)
      import.path = resolve(value);
    scene.imports.push_back(std::move(import));
  }

  std::string resolve(const JsonValue &value) const { return resolvePath(value, scene.file); }

  ObjectDescription readObject(const JsonValue &value, const std::string &what) const {
    expect(value, Kind::Object, what);
    ObjectDescription object;
    object.place = value.place();
    if (isImage(value)) {
      object.className = {imageClass(value), value.place()};
      object.image = &value;
      return object;
    }
    const JsonValue &className = expect(require(value, "class", what), Kind::String, "`class`");
    object.className = nameOfClass(className);
    if (className.string.empty())
      throw Error(message::classNameEmpty(), className.place());
    for (const auto &[key, member] : value.members) {
      if (key.text == "class")
        continue;
      if (key.text == "constructor") {
        if (member.kind != Kind::Array && member.kind != Kind::Object)
          throw Error(message::constructorWrongKind(describe(member.kind)), member.place());
        object.constructor = &member;
        continue;
      }
      object.members.push_back({{key.text, value.place(key)}, &member});
    }
    return object;
  }

  /// The images by name, and all images and buffers in files that are written in place anywhere.
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
    for (const auto &[key, value] : root.members) {
      const bool isOfNames = key.text == "images" || key.text == "helpers" ||
                             key.text == "textures" || key.text == "materials" ||
                             key.text == "nodes" || key.text == "variables" ||
                             key.text == "cameras";
      if (isOfNames)
        forEachValue(value, [&](const JsonValue &object) { readFilesIn(object); });
      else if (key.text != "roots" && key.text != "render")
        readFilesIn(value);
    }
    std::set<std::string> classes;
    for (const auto &image : scene.imageValues)
      classes.insert(imageClass(*image.first));
    for (const std::string &className : classes)
      scene.imports.push_back({{"std.images." + className, root.place()}, ""});
  }

  void readFilesIn(const JsonValue &value) {
    if (isImage(value)) {
      errors.attempt([&] {
        ImageDescription image =
            readImage(value, [&](const JsonValue &path) { return resolve(path); });
        if (!image.part.empty())
          modelsOf(scene).open(image.files.front(), value.find("file")->place());
        scene.imageValues.emplace(&value, std::move(image));
      });
      return;
    }
    if (isBuffer(value)) {
      errors.attempt([&] {
        scene.bufferValues.emplace(&value, readBufferDescription(value, [&](const JsonValue &path) {
          return resolve(path);
        }));
      });
      return;
    }
    // The files of a node's mesh are no images, and its variables are values by name.
    const bool isNode = !value.find("class");
    const JsonValue *mesh = isNode ? value.find("mesh") : nullptr;
    const JsonValue *variables = isNode ? value.find("variables") : nullptr;
    forEachValue(value, [&](const JsonValue &inner) {
      if (&inner == variables)
        forEachValue(inner, [&](const JsonValue &variable) { readFilesIn(variable); });
      else if (&inner != mesh)
        readFilesIn(inner);
    });
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

  ReferenceDescription readReference(const JsonValue &value, const std::string &what) const {
    ReferenceDescription reference;
    if (value.kind == Kind::String) {
      reference.name = {value.string, value.place()};
    } else if (value.kind == Kind::Object) {
      reference.object = std::make_shared<ObjectDescription>(readObject(value, what));
    } else {
      throw Error(message::notNameOrObject(what, describe(value.kind)), value.place());
    }
    return reference;
  }

  /// An element of `objects`: one instance. The vertices of a mesh are transformed, unless the
  /// transform moves.
  GeometryDescription readObjectOfList(const JsonValue &value) {
    expect(value, Kind::Object, "an element of `objects`");
    GeometryDescription geometry = readGeometry(value, "an object");
    InstanceDescription placement;
    placement.mask = geometry.mask;
    placement.hasBackFaces = geometry.hasBackFaces;
    placement.id = geometry.id.value_or(0);
    placement.scope = scene.scopes.front().get();
    errors.attempt([&] {
      if (const JsonValue *variables = value.find("variables"))
        placement.scope = addScope(scene, placement.scope, readVariables(*variables));
    });
    errors.attempt([&] {
      if (const JsonValue *transform = value.find("transform"))
        placement.transform = readTransform(*transform);
      if (!geometry.primitive && !placement.transform.moves())
        geometry.transform = std::exchange(placement.transform, {}).still();
    });
    geometry.placements.push_back(placement);
    return geometry;
  }

  GeometryDescription readGeometry(const JsonValue &value, const std::string &what) {
    errors.attempt([&] {
      checkKeys(value,
                {"name", "primitive", "mesh", "part", "weights", "material", "transform", "mask",
                 "id", "count", "textureCoordinates", "backFaces", "variables", "attributes"},
                what);
    });
    GeometryDescription geometry;
    geometry.place = value.place();
    geometry.hasShape = errors.attempt([&] { readShape(value, what, geometry); });
    geometry.hasMaterial = errors.attempt(
        [&] { geometry.material = readReference(require(value, "material", what), "`material`"); });
    errors.attempt([&] {
      if (const JsonValue *name = value.find("name")) {
        expect(*name, Kind::String, "`name`");
        geometry.name = {name->string, name->place()};
      }
      if (const JsonValue *mask = value.find("mask"))
        geometry.mask = readInteger(*mask, 0, 0xffffffff, "`mask`");
      if (const JsonValue *id = value.find("id"))
        geometry.id = readId(*id);
      readCount(value, geometry);
    });
    errors.attempt([&] {
      if (const JsonValue *backFaces = value.find("backFaces"))
        readBackFaces(*backFaces, geometry);
    });
    errors.attempt([&] {
      if (const JsonValue *attributes = value.find("attributes")) {
        geometry.attributes = readAttributes(*attributes);
        if (geometry.mesh.empty())
          throw Error(message::attributesWithoutMesh(), attributes->place());
      }
    });
    return geometry;
  }

  static void readBackFaces(const JsonValue &value, GeometryDescription &geometry) {
    expect(value, Kind::Boolean, "`backFaces`");
    if (geometry.mesh.empty())
      throw Error(message::backFacesWithoutMesh(), value.place());
    geometry.hasBackFaces = value.boolean;
  }

  static void readCount(const JsonValue &value, GeometryDescription &geometry) {
    const JsonValue *count = value.find("count");
    if (!count)
      return;
    if (geometry.mesh.empty() && count->kind == Kind::String)
      geometry.count = count;
    else if (geometry.mesh.empty() && readInteger(*count, 1, 0x7fffffff, "`count`"))
      geometry.count = count;
    else
      throw Error(message::countWithoutPrimitive(), count->place());
  }

  void readShape(const JsonValue &value, const std::string &what,
                 GeometryDescription &geometry) const {
    const JsonValue *primitive = value.find("primitive"), *mesh = value.find("mesh");
    if (!primitive == !mesh)
      throw Error(primitive ? message::primitiveAndMesh(what) : message::noPrimitiveOrMesh(what),
                  value.place());
    if (primitive)
      geometry.primitive = readObject(*primitive, "`primitive`");
    if (mesh) {
      geometry.mesh = readMeshPaths(*mesh, scene.file, geometry.meshTimes);
      if (const JsonValue *part = value.find("part"))
        readPart(*part, geometry);
      if (const JsonValue *weights = value.find("weights"))
        readWeights(*weights, geometry);
      if (const JsonValue *coordinates = value.find("textureCoordinates")) {
        expect(*coordinates, Kind::String, "`textureCoordinates`");
        if (coordinates->string != "file" && coordinates->string != "barycentric")
          throw Error(message::unknownTextureCoordinates(coordinates->string),
                      coordinates->place());
        geometry.isBarycentric = coordinates->string == "barycentric";
      }
    }
  }

  /// When the shutter opens and closes.
  void readShutter(const JsonValue &value) {
    const std::vector<double> times = readNumbers(value, 2, "`shutter`");
    if (!(0 <= times[0] && times[0] <= times[1] && times[1] <= 1))
      throw Error(message::badShutter(), value.place());
    scene.shutter = {float(times[0]), float(times[1])};
  }

  /// How surfaces that shine are chosen to light a point.
  void readLightSampler(const JsonValue &value) {
    expect(value, Kind::String, "`lightSampler`");
    constexpr std::pair<const char *, runtime::LampChoice> choices[] = {
        {"auto", runtime::LampChoice::Automatic},
        {"power", runtime::LampChoice::ByPower},
        {"tree", runtime::LampChoice::ByTree}};
    for (const auto &[name, choice] : choices)
      if (value.string == name) {
        scene.lampChoice = choice;
        return;
      }
    throw Error(message::noSuchLightSampler(value.string), value.place());
  }

  void readEditable(const JsonValue &value) {
    expect(value, Kind::Array, "`editable`");
    for (const JsonValue &name : value.elements) {
      expect(name, Kind::String, "a name of `editable`");
      scene.editable.push_back({name.string, name.place()});
    }
  }

  void readPart(const JsonValue &part, GeometryDescription &geometry) const {
    expect(part, Kind::String, "`part`");
    for (const MeshPath &key : geometry.mesh)
      gltf::primitiveOf(modelsOf(scene).open(key.path, key.name.place), part.string, part.place());
    geometry.part = part.string;
  }

  /// A number for each morph target of the part; or {"keys": [lists of them], "times": [...]}.
  void readWeights(const JsonValue &value, GeometryDescription &geometry) const {
    if (geometry.part.empty() || geometry.mesh.size() != 1)
      throw Error(message::weightsWithoutPart(), value.place());
    const MeshPath &file = geometry.mesh.front();
    const std::size_t targets =
        gltf::targetCount(gltf::primitiveOf(modelsOf(scene).open(file.path, file.name.place),
                                            geometry.part, value.place()),
                          geometry.part);
    if (value.kind != Kind::Object) {
      geometry.weights = {readNumbers(value, targets, "`weights`")};
      return;
    }
    checkKeys(value, {"keys", "times"}, "`weights` with keys");
    geometry.meshTimes = readKeyTimes(value, "`weights`");
    for (const JsonValue &key : value.find("keys")->elements)
      geometry.weights.push_back(readNumbers(key, targets, "a key of `weights`"));
  }

  /// A number or a list of numbers; the program determines how many.
  static const JsonValue &readColor(const JsonValue &value, const std::string &what) {
    if (value.kind == Kind::Number) {
      readNumber(value, what);
      return value;
    }
    if (value.kind != Kind::Array)
      throw Error(message::notColor(what, describe(value.kind)), value.place());
    readNumbers(value, value.elements.size(), what);
    return value;
  }

  void readRender(const JsonValue &value) {
    expect(value, Kind::Object, "`render`");
    errors.attempt([&] {
      checkKeys(value,
                {"engine", "size", "spp", "depth", "seed", "shutter", "lightSampler", "editable"},
                "`render`");
    });
    if (const JsonValue *shutter = value.find("shutter"))
      errors.attempt([&] { readShutter(*shutter); });
    if (const JsonValue *sampler = value.find("lightSampler"))
      errors.attempt([&] { readLightSampler(*sampler); });
    if (const JsonValue *editable = value.find("editable"))
      errors.attempt([&] { readEditable(*editable); });
    if (const JsonValue *engine = value.find("engine"))
      errors.attempt([&] { readEngine(*engine); });
    readSettings(value, scene.render, scene, root.find("rayGeneration"), errors);
  }

  void readEngine(const JsonValue &engine) {
    expect(engine, Kind::String, "`engine`");
    const std::vector<std::string> &ofLibrary = libraryEngines();
    if (std::find(ofLibrary.begin(), ofLibrary.end(), engine.string) != ofLibrary.end())
      libraryEngine = &engine;
    else if (engine.string != "classic" && engine.string != "programs")
      throw Error(message::noSuchEngine(engine.string, fmt::join(ofLibrary, "`, `")),
                  engine.place());
    if (engine.string != "classic")
      scene.render.engine = runtime::Engine::Programs;
  }

  const JsonValue &root;
  SceneDescription &scene;
  const JsonValue *libraryEngine = nullptr; // the value of `engine`, if it is one of the library's
  ErrorCollector &errors;
};

/// Makes the scene that of its frame.
void chooseFrame(JsonValue &root, ErrorCollector &errors) {
  double frame = 0;
  if (const JsonValue *value = root.find("frame"))
    errors.attempt([&] { frame = readNumber(*value, "`frame`"); });
  resolveKeyFrames(root, frame, errors);
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
  chooseFrame(*root, ofFrames);
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
