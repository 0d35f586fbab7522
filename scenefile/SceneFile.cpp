//===- SceneFile.cpp - from JSON to a description -------------------------===//
#include "scenefile/SceneFile.h"

#include "scenefile/Graph.h"
#include "scenefile/LibraryEngines.h"
#include "scenefile/Reader.h"
#include "scenefile/TransformReader.h"
#include "support/AtomicFile.h"
#include "support/ErrorCollector.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;

class SceneReader {
public:
  SceneReader(const JsonValue &root, SceneDescription &scene) : root(root), scene(scene) {}

  void read() {
    expect(root, Kind::Object, "a scene");
    readVersion();
    errors.attempt([&] {
      checkKeys(root, {"$schema", "rtsl",     "import",     "camera",  "rayGeneration", "images",
                       "helpers", "textures", "materials",  "objects", "nodes",         "root",
                       "roots",   "lights",   "background", "ambient", "exception",     "render",
                       "buffers", "passes",   "variables"},
                "a scene");
    });
    section("import", [&](const JsonValue &imports) { readImports(imports); });
    readSingle("camera", scene.camera);
    readSingle("rayGeneration", scene.rayGeneration);
    readImages();
    readBuffers();
    readNamed("helpers", scene.helpers);
    readNamed("textures", scene.textures);
    readNamed("materials", scene.materials);
    section("variables", [&](const JsonValue &variables) {
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
      requireStart();
      if (libraryEngine)
        useLibraryEngine(scene, *libraryEngine);
    });
    errors.throwIfAny();
  }

private:
  /// Reads the value of a key, if present. An error in it does not prevent reading other sections.
  template <typename Read>
  void section(const char *key, Read read) {
    if (const JsonValue *value = root.find(key))
      errors.attempt([&] { read(*value); });
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

  /// Requires the object that starts samples.
  void requireStart() const {
    if (scene.render.engine == runtime::Engine::Classic)
      require(root, "camera", "a scene");
    else if (root.find("passes"))
      return;
    else if (libraryEngine)
      require(root, "camera", fmt::format("a scene for the engine `{}`", libraryEngine->string));
    else
      require(root, "rayGeneration", "a scene for the engine `programs`");
  }

  void readVersion() const {
    const JsonValue *version = root.find("rtsl");
    if (!version)
      throw Error(ErrorCode::MissingKey,
                  "a scene begins with `\"rtsl\": 1`, the version of the format", root.place());
    expect(*version, Kind::Number, "`rtsl`");
    if (version->number != 1)
      throw Error(ErrorCode::NotSupported,
                  fmt::format("version {:g} of the scene format is not supported, only 1 is",
                              version->number),
                  version->place());
  }

  void readImports(const JsonValue &value) {
    if (value.kind == Kind::String)
      return readImport(value);
    expect(value, Kind::Array, "`import`");
    for (const JsonValue &element : value.elements)
      readImport(element);
  }

  void readImport(const JsonValue &value) {
    expect(value, Kind::String, "an import");
    ImportDescription import{{value.string, value.place()}, ""};
    if (value.string.empty())
      throw Error(ErrorCode::OutOfRange, "an import has no name", value.place());
    const std::string extension = ".rtsl";
    bool isFile = value.string.size() > extension.size() &&
                  value.string.compare(value.string.size() - extension.size(), extension.size(),
                                       extension) == 0;
    if (isFile)
      import.path = resolve(value);
    scene.imports.push_back(std::move(import));
  }

  /// Paths are relative to the folder of the scene file; those from the command line, to the
  /// working directory.
  std::string resolve(const JsonValue &value) const {
    std::filesystem::path path(value.string);
    if (path.is_absolute() || value.fromOverride)
      return value.string;
    return (std::filesystem::path(scene.file).parent_path() / path).lexically_normal().string();
  }

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
    object.className = {className.string, className.place()};
    if (className.string.empty())
      throw Error(ErrorCode::UnknownClass, "a class has no name", className.place());
    for (const auto &[key, member] : value.members) {
      if (key.text == "class")
        continue;
      if (key.text == "constructor") {
        if (member.kind != Kind::Array && member.kind != Kind::Object)
          throw Error(
              ErrorCode::WrongType,
              fmt::format(
                  "`constructor` is a list of arguments or an object of arguments by name, not {}",
                  describe(member.kind)),
              member.place());
        object.constructor = &member;
        continue;
      }
      object.members.push_back(
          {{key.text, member.fromOverride ? member.place() : value.place(key)}, &member});
    }
    return object;
  }

  /// The images by name, and all images and buffers in files that are written in place anywhere.
  void readImages() {
    section("images", [&](const JsonValue &value) {
      expect(value, Kind::Object, "`images`");
      for (const auto &[key, member] : value.members)
        errors.attempt([&, &key = key, &member = member] {
          refuseTakenName(key.text, value.place(key));
          expect(member, Kind::Object, fmt::format("`{}`", key.text));
          if (!isImage(member))
            throw Error(ErrorCode::MissingKey,
                        fmt::format("the image `{}` needs a `file`, `slices` or `raw`", key.text),
                        member.place());
          scene.images[key.text] = readObject(member, fmt::format("`{}`", key.text));
        });
    });
    for (const auto &[key, value] : root.members) {
      const bool isOfNames = key.text == "images" || key.text == "helpers" ||
                             key.text == "textures" || key.text == "materials" ||
                             key.text == "nodes" || key.text == "variables";
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
        scene.imageValues.emplace(
            &value, readImage(value, [&](const JsonValue &path) { return resolve(path); }));
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
    forEachValue(value, [&](const JsonValue &inner) { readFilesIn(inner); });
  }

  void readBuffers() {
    section("buffers", [&](const JsonValue &value) {
      expect(value, Kind::Object, "`buffers`");
      for (const auto &[key, member] : value.members)
        errors.attempt([&, &key = key, &member = member] {
          if (!isBuffer(member))
            throw Error(
                ErrorCode::MissingKey,
                fmt::format("the buffer `{}` needs a `size`, or a file: `buffer`", key.text),
                member.place());
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
      readSettings(value, pass.render, value.find("rayGeneration"));
      scene.passes.push_back(std::move(pass));
    });
    const JsonValue *passes = root.find("passes");
    if (!passes || scene.passes.empty())
      return;
    if (libraryEngine || root.find("rayGeneration"))
      throw Error(ErrorCode::UnknownKey,
                  libraryEngine ? "a scene with `passes` has no other engine"
                                : "a scene has `rayGeneration` or `passes`, not both",
                  libraryEngine ? libraryEngine->place() : root.find("rayGeneration")->place());
    scene.rayGeneration = scene.passes.back().rayGeneration;
    scene.render = scene.passes.back().render;
  }

  void readNamed(const char *section, std::map<std::string, ObjectDescription> &objects) {
    this->section(section, [&](const JsonValue &value) {
      expect(value, Kind::Object, fmt::format("`{}`", section));
      for (const auto &[key, member] : value.members)
        errors.attempt([&, &key = key, &member = member] {
          refuseTakenName(key.text, value.place(key));
          objects[key.text] = readObject(member, fmt::format("`{}`", key.text));
        });
    });
  }

  /// Images, helpers, textures and materials share one namespace.
  void refuseTakenName(const std::string &name, const Place &place) const {
    const auto refuse = [&](const auto &objects, const char *what) {
      if (auto other = objects.find(name); other != objects.end())
        throw Error(ErrorCode::DuplicateKey,
                    fmt::format("`{}` is already the name of a {}", name, what), place)
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
      throw Error(
          ErrorCode::WrongType,
          fmt::format("{} is a name or an object with a class, not {}", what, describe(value.kind)),
          value.place());
    }
    return reference;
  }

  /// An element of `objects`: one instance. The vertices of a mesh are transformed.
  GeometryDescription readObjectOfList(const JsonValue &value) {
    expect(value, Kind::Object, "an element of `objects`");
    GeometryDescription geometry = readGeometry(value, "an object");
    InstanceDescription placement;
    placement.mask = geometry.mask;
    placement.id = geometry.id.value_or(0);
    placement.scope = scene.scopes.front().get();
    errors.attempt([&] {
      if (const JsonValue *variables = value.find("variables")) {
        scene.scopes.push_back(std::make_shared<VariableScope>(
            VariableScope{placement.scope, readVariables(*variables)}));
        placement.scope = scene.scopes.back().get();
      }
    });
    errors.attempt([&] {
      if (const JsonValue *transform = value.find("transform"))
        (geometry.primitive ? placement.transform : geometry.transform) = readTransform(*transform);
    });
    geometry.placements.push_back(placement);
    return geometry;
  }

  GeometryDescription readGeometry(const JsonValue &value, const std::string &what) {
    errors.attempt([&] {
      checkKeys(value,
                {"name", "primitive", "mesh", "material", "transform", "mask", "id", "count",
                 "textureCoordinates", "variables"},
                what);
    });
    GeometryDescription geometry;
    geometry.place = value.place();
    errors.attempt([&] { readShape(value, what, geometry); });
    errors.attempt(
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
    return geometry;
  }

  static void readCount(const JsonValue &value, GeometryDescription &geometry) {
    const JsonValue *count = value.find("count");
    if (!count)
      return;
    if (geometry.meshPath.empty() && count->kind == Kind::String)
      geometry.count = count;
    else if (geometry.meshPath.empty() && readInteger(*count, 1, 0x7fffffff, "`count`"))
      geometry.count = count;
    else
      throw Error(ErrorCode::UnknownKey, "`count` is for a `primitive`: a mesh has its triangles",
                  count->place());
  }

  void readShape(const JsonValue &value, const std::string &what,
                 GeometryDescription &geometry) const {
    const JsonValue *primitive = value.find("primitive"), *mesh = value.find("mesh");
    if (!primitive == !mesh)
      throw Error(primitive ? ErrorCode::UnknownKey : ErrorCode::MissingKey,
                  fmt::format(primitive ? "{} is a `primitive` or a `mesh`, not both"
                                        : "{} needs a `primitive` or a `mesh`",
                              what),
                  value.place());
    if (primitive)
      geometry.primitive = readObject(*primitive, "`primitive`");
    if (mesh) {
      expect(*mesh, Kind::String, "`mesh`");
      geometry.mesh = {mesh->string, mesh->place()};
      geometry.meshPath = resolve(*mesh);
      if (const JsonValue *coordinates = value.find("textureCoordinates")) {
        expect(*coordinates, Kind::String, "`textureCoordinates`");
        if (coordinates->string != "file" && coordinates->string != "barycentric")
          throw Error(ErrorCode::OutOfRange,
                      fmt::format("`textureCoordinates` are `file` or `barycentric`, not `{}`",
                                  coordinates->string),
                      coordinates->place());
        geometry.isBarycentric = coordinates->string == "barycentric";
      }
    }
  }

  /// A number or a list of numbers; the program determines how many.
  static const JsonValue &readColor(const JsonValue &value, const std::string &what) {
    if (value.kind == Kind::Number) {
      readNumber(value, what);
      return value;
    }
    if (value.kind != Kind::Array)
      throw Error(ErrorCode::WrongType,
                  fmt::format("{} is a color, not {}", what, describe(value.kind)), value.place());
    readNumbers(value, value.elements.size(), what);
    return value;
  }

  void readRender(const JsonValue &value) {
    expect(value, Kind::Object, "`render`");
    checkKeys(value, {"engine", "size", "spp", "depth", "seed"}, "`render`");
    RenderSettings &render = scene.render;
    if (const JsonValue *engine = value.find("engine")) {
      expect(*engine, Kind::String, "`engine`");
      const std::vector<std::string> &ofLibrary = libraryEngines();
      if (std::find(ofLibrary.begin(), ofLibrary.end(), engine->string) != ofLibrary.end())
        libraryEngine = engine;
      else if (engine->string != "classic" && engine->string != "programs")
        throw Error(ErrorCode::NotSupported,
                    fmt::format("there is no engine `{}`; there are `classic`, `programs`, `{}`",
                                engine->string, fmt::join(ofLibrary, "`, `")),
                    engine->place());
      if (engine->string != "classic")
        render.engine = runtime::Engine::Programs;
    }
    readSettings(value, render, root.find("rayGeneration"));
  }

  /// The number of elements of a buffer, by its name in `buffers` or as a member of the ray
  /// generation.
  std::uint32_t lengthOfBuffer(const JsonValue &name, const JsonValue *rayGeneration) const {
    const JsonValue *value = rayGeneration && rayGeneration->kind == Kind::Object
                                 ? rayGeneration->find(name.string)
                                 : nullptr;
    const std::string &called = value && value->kind == Kind::String ? value->string : name.string;
    if (const auto named = scene.buffers.find(called); named != scene.buffers.end())
      value = named->second;
    if (value && value->kind == Kind::Array && !value->elements.empty())
      return static_cast<std::uint32_t>(value->elements.size());
    const auto buffer = value ? scene.bufferValues.find(value) : scene.bufferValues.end();
    if (buffer == scene.bufferValues.end())
      throw Error(ErrorCode::UnknownName,
                  fmt::format("`size` is two numbers, one, or the name of a buffer that the scene "
                              "gives, and `{}` is none",
                              name.string),
                  name.place());
    try {
      const std::size_t length = lengthOf(buffer->second);
      if (length == 0 || length > runtime::mostLaunchWidth)
        throw Error(ErrorCode::OutOfRange,
                    fmt::format("a launch of the size of `{}` has {} indices; it may have 1 to {}",
                                name.string, length, runtime::mostLaunchWidth));
      return static_cast<std::uint32_t>(length);
    } catch (Error &error) {
      error.place = name.place();
      throw;
    }
  }

  /// What `render` and a pass may both say.
  void readSettings(const JsonValue &value, RenderSettings &render,
                    const JsonValue *rayGeneration) const {
    if (const JsonValue *size = value.find("size")) {
      if (size->kind == Kind::String) {
        render.width = lengthOfBuffer(*size, rayGeneration);
        render.height = 1;
      } else if (size->kind == Kind::Array && size->elements.size() == 1) {
        render.width = readInteger(size->elements[0], 1, runtime::mostLaunchWidth, "the size");
        render.height = 1;
      } else {
        readNumbers(*size, 2, "`size`");
        render.width = readInteger(size->elements[0], 1, runtime::mostPixelsOfSide, "the width");
        render.height = readInteger(size->elements[1], 1, runtime::mostPixelsOfSide, "the height");
      }
    }
    if (const JsonValue *spp = value.find("spp")) {
      render.samplesPerPixel = readInteger(*spp, 1, runtime::mostSamplesPerPixel, "`spp`");
      render.hasSamples = true;
    }
    if (const JsonValue *depth = value.find("depth"))
      render.depth = readInteger(*depth, 0, runtime::maxRayDepth, "`depth`");
    if (const JsonValue *seed = value.find("seed"))
      render.seed = readInteger(*seed, 0, 0xffffffff, "`seed`");
  }

  const JsonValue &root;
  SceneDescription &scene;
  const JsonValue *libraryEngine = nullptr; // the value of `engine`, if it is one of the library's
  ErrorCollector errors;
};

/// Calls visit(name, value) for the variables of all nodes and of the scene.
template <typename Visit>
void forEachVariable(const SceneDescription &description, Visit visit) {
  std::set<const JsonValue *> visited; // a node may have several scopes
  for (const auto &scope : description.scopes)
    for (const auto &[name, value] : scope->variables)
      if (visited.insert(value.second).second)
        visit(name, *value.second);
}

/// Visits an object of the scene, in any position: its class, and its members.
using ObjectVisitor = std::function<void(
    const LocatedName &, const std::vector<std::pair<LocatedName, const JsonValue *>> &)>;

/// Objects written in place of a reference are visited, too.
void forEachObject(const JsonValue &value, const ObjectVisitor &visit) {
  if (isImage(value))
    return visit({imageClass(value), value.place()}, {});
  if (value.kind == Kind::Object) {
    if (const JsonValue *className = value.find("class");
        className && className->kind == Kind::String) {
      std::vector<std::pair<LocatedName, const JsonValue *>> members;
      for (const auto &[key, member] : value.members)
        members.push_back({{key.text, member.place()}, &member});
      visit({className->string, className->place()}, members);
    }
  }
  forEachValue(value, [&](const JsonValue &inner) { forEachObject(inner, visit); });
}

void forEachObject(const ObjectDescription &object, const ObjectVisitor &visit) {
  visit(object.className, object.members);
  if (object.constructor)
    forEachValue(*object.constructor,
                 [&](const JsonValue &argument) { forEachObject(argument, visit); });
  for (const auto &member : object.members)
    forEachObject(*member.second, visit);
}

/// In the order of the file's sections.
void forEachObject(const SceneDescription &description, const ObjectVisitor &visit) {
  if (description.camera)
    forEachObject(*description.camera, visit);
  for (const PassDescription &pass : description.passes)
    forEachObject(pass.rayGeneration, visit);
  if (description.passes.empty() && description.rayGeneration &&
      description.render.engine != runtime::Engine::Classic)
    forEachObject(*description.rayGeneration, visit);
  for (const auto *named :
       {&description.images, &description.helpers, &description.textures, &description.materials})
    for (const auto &object : *named)
      forEachObject(object.second, visit);
  for (const GeometryDescription &geometry : description.objects) {
    if (geometry.primitive)
      forEachObject(*geometry.primitive, visit);
    if (geometry.material.object)
      forEachObject(*geometry.material.object, visit);
  }
  for (const SelectorDescription &selector : description.selectors)
    if (selector.object.object)
      forEachObject(*selector.object.object, visit);
  forEachVariable(description, [&](const std::string &, const JsonValue &value) {
    forEachObject(value, visit);
  });
  for (const ObjectDescription &light : description.lights)
    forEachObject(light, visit);
  for (const auto &object : {description.background, description.exception})
    if (object)
      forEachObject(*object, visit);
}

bool isNothing(const JsonValue &value) {
  return value.kind == Kind::Null ||
         (value.kind == Kind::Array &&
          std::all_of(value.elements.begin(), value.elements.end(), isNothing));
}

} // namespace

SceneDescription parseScene(const std::string &text, const std::string &path,
                            const std::vector<std::string> &overrides) {
  auto root = std::make_shared<JsonValue>(parseJson(text, path));
  for (const std::string &override : overrides)
    applyOverride(*root, override);
  SceneDescription scene;
  scene.file = path;
  scene.root = root;
  SceneReader(*root, scene).read();
  return scene;
}

SceneDescription readSceneFile(const std::string &path, const std::vector<std::string> &overrides) {
  return parseScene(readFile(path), path, overrides);
}

const ObjectDescription *findObject(const SceneDescription &description, const std::string &name) {
  for (const auto *section :
       {&description.images, &description.helpers, &description.textures, &description.materials})
    if (const auto found = section->find(name); found != section->end())
      return &found->second;
  return nullptr;
}

bool isGiven(const ObjectDescription &object, const std::string &member) {
  return std::any_of(object.members.begin(), object.members.end(),
                     [&](const auto &one) { return one.first.text == member; });
}

ObjectDescription objectInPlace(const JsonValue &json, const std::string &what) {
  const JsonValue *className = json.find("class");
  if (!className || className->kind != Kind::String)
    throw Error(ErrorCode::MissingKey, fmt::format("{}: an object needs a `class`", what),
                json.place());
  ObjectDescription object;
  object.className = {className->string, className->place()};
  object.place = json.place();
  for (const auto &[key, member] : json.members) {
    if (key.text == "constructor")
      object.constructor = &member;
    else if (key.text != "class")
      object.members.push_back({{key.text, json.place(key)}, &member});
  }
  if (object.constructor && object.constructor->kind != Kind::Array &&
      object.constructor->kind != Kind::Object)
    throw Error(ErrorCode::WrongType,
                "`constructor` is a list of arguments or an object of arguments by name",
                object.constructor->place());
  return object;
}

std::size_t launchCount(const SceneDescription &description) {
  return std::max<std::size_t>(description.passes.size(), 1);
}

SceneDescription launchOf(const SceneDescription &description, std::size_t pass) {
  SceneDescription launch = description;
  if (!description.passes.empty()) {
    launch.rayGeneration = description.passes[pass].rayGeneration;
    launch.render = description.passes[pass].render;
    launch.passes.clear();
  }
  return launch;
}

std::vector<std::string> filesOf(const SceneDescription &description) {
  std::vector<std::string> files;
  const auto add = [&](const std::string &file) {
    if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end())
      files.push_back(file);
  };
  for (const GeometryDescription &geometry : description.objects)
    add(geometry.meshPath);
  for (const auto &image : description.imageValues)
    for (const std::string &file : image.second.files)
      add(file);
  for (const auto &buffer : description.bufferValues)
    add(buffer.second.file);
  return files;
}

std::vector<LocatedName> classMentions(const SceneDescription &description) {
  std::vector<LocatedName> mentions;
  forEachObject(description,
                [&](const LocatedName &name, const auto &) { mentions.push_back(name); });
  return mentions;
}

std::map<std::string, std::set<std::string>> givenMembers(const SceneDescription &description) {
  std::map<std::string, std::set<std::string>> given;
  forEachObject(description, [&](const LocatedName &name, const auto &members) {
    std::set<std::string> &ofClass = given[name.text];
    for (const auto &[member, value] : members)
      if (!isNothing(*value))
        ofClass.insert(member.text);
  });
  // Which objects take a variable shows when the classes are known.
  forEachVariable(description, [&](const std::string &name, const JsonValue &value) {
    if (!isNothing(value))
      for (auto &[className, members] : given)
        members.insert(name);
  });
  return given;
}

std::vector<std::string> classesUsed(const SceneDescription &description) {
  std::set<std::string> names;
  for (const LocatedName &mention : classMentions(description))
    names.insert(mention.text);
  return {names.begin(), names.end()};
}

runtime::RenderOptions renderOptions(const RenderSettings &settings) {
  runtime::RenderOptions options;
  options.width = settings.width;
  options.height = settings.height;
  options.samplesPerPixel = settings.samplesPerPixel;
  options.maxDepth = settings.depth;
  options.seed = settings.seed;
  return options;
}

} // namespace rtsl::scene
