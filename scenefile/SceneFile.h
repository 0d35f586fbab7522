//===- SceneFile.h - the JSON scene file ----------------------------------===//
//
//   SceneDescription description = scene::readSceneFile("scene.json", {"objects.0.mesh=foo.obj"});
//   std::vector<std::string> imports = ...description.imports..., classes =
//   scene::classesUsed(description);
//   ... compile and link ...
//   runtime::Scene built = scene::buildScene(description, program);
//
// docs/scene-format.md describes the format, docs/scene-schema.json is its schema. All errors are
// Error with file, line, column and length; the one that is thrown carries the other errors of the
// scene.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/render/RenderOptions.h"
#include "runtime/scene/Scene.h"
#include "scenefile/json/JsonValue.h"

#include "scenefile/files/BufferFiles.h"
#include "scenefile/files/Images.h"
#include "scenefile/files/MeshAttributes.h"
#include "support/ErrorCollector.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::scene {

/// A text with its position.
struct LocatedName {
  std::string text;
  Place place;
  bool isOfLibrary = false; // a class that the scene does not name itself (LibraryNames.h)
};

/// What a string names that is a class.
LocatedName nameOfClass(const JsonValue &className);

/// {"class": ..., "constructor": ..., members...}. Values stay JSON until the classes are known.
struct ObjectDescription {
  LocatedName className;
  const JsonValue *constructor = nullptr; // a list or an object
  std::vector<std::pair<LocatedName, const JsonValue *>> members;
  const JsonValue *image = nullptr; // of an image, which has no members
  Place place;
};

/// A reference: the name of an object or an object written in its place.
struct ReferenceDescription {
  LocatedName name; // empty text: written in place
  std::shared_ptr<ObjectDescription> object;

  /// The name for messages about it: of the object, or of its class.
  const LocatedName &shownName() const { return object ? object->className : name; }
};

class KeptFiles;
class ModelFiles;

/// The value of a variable, and where it is defined.
using VariableDefinition = std::pair<Place, const JsonValue *>;
using VariableDefinitions = std::map<std::string, VariableDefinition>;

/// The variables of a node, which the objects below it take for members that they do not set, and
/// those of the nodes above it.
struct VariableScope {
  const VariableScope *above = nullptr;
  VariableDefinitions variables;

  /// The nearest definition; null: there is none.
  const VariableDefinition *find(const std::string &name) const {
    for (const VariableScope *scope = this; scope; scope = scope->above)
      if (const auto found = scope->variables.find(name); found != scope->variables.end())
        return &found->second;
    return nullptr;
  }
};

/// A node that a root leads to, for messages about what is below it.
struct NodeMention {
  LocatedName name;                 // empty text: written in place
  std::vector<std::size_t> parents; // indices, perhaps repeated
};

/// Nodes that several roots lead to by different edges, as a note says: sharing them is legitimate.
struct SharedNodes {
  std::vector<LocatedName> roots; // where each is mentioned
  std::vector<LocatedName> nodes; // empty text: written in place
};

/// A selector above instances, once for each path from a root to it.
struct SelectorDescription {
  std::size_t node = 0;        // an index in `nodes`
  ReferenceDescription object; // of an rt_Selector class
  std::uint32_t children = 0;
  runtime::MovingTransform toWorld;
  std::size_t above = 0; // 1 + the index of the selector above it; 0: none
  std::uint32_t childOfAbove = 0;
  const VariableScope *scope = nullptr;
};

struct InstanceDescription : runtime::Placement {
  const VariableScope *scope = nullptr;
  /// For a part (ModelPart.h): the transform to the space that the part is added to; otherwise
  /// null.
  std::shared_ptr<const runtime::MovingTransform> inPart;
  std::size_t selector = 0; // 1 + the index of the selector above it; 0: none
  std::uint32_t childOfSelector = 0;
};

/// The file of a mesh.
struct MeshPath {
  LocatedName name; // as written
  std::string path; // resolved
};

/// A mesh or a primitive with a material, and its instances.
struct GeometryDescription {
  LocatedName name;                           // for messages; empty text: none
  std::optional<std::size_t> node;            // an index in `nodes`; none: it is in `objects`
  std::optional<ObjectDescription> primitive; // or
  std::vector<MeshPath> mesh;                 // of a mesh: its keys, or its only file
  std::vector<float> meshTimes;               // of several keys
  std::string part; // of a glTF file, as "meshes.0.primitives.1"; empty: all meshes of the file
  /// The weights of the morph targets of the part, one list or one for each key; empty: all are 0.
  std::vector<std::vector<double>> weights;
  bool isBarycentric =
      false; // texture coordinates of the mesh: (0,0), (1,0), (0,1) in each triangle
  std::vector<AttributeDescription> attributes; // of a mesh
  bool hasShape = true, hasMaterial = true;     // false: it could not be read
  ReferenceDescription material;
  runtime::Transform transform; // of the vertices of a mesh in `objects`, unless it moves
  std::uint32_t mask = ~0u;     // visible to rays whose mask has a common bit
  bool hasBackFaces = true;     // of a mesh
  std::optional<std::int32_t> id;
  const JsonValue *count = nullptr; // of primitives: a number, or the name of a buffer member
  std::vector<InstanceDescription> placements;
  Place place;
};

/// "render", with the defaults for missing values.
struct RenderSettings {
  runtime::Engine engine = runtime::Engine::Classic;
  std::uint32_t width = 960, height = 540; // of all slices
  std::uint32_t slices = 1;                // of a launch of three dimensions
  std::string sizeBuffer;                  // the name of the buffer that gives the size; or empty
  std::string sizeFile; // its file, while the number of elements is unknown (LaunchSizes.h)
  Place sizePlace;
  std::uint32_t samplesPerPixel = 16;
  bool hasSamples = false; // the scene gives samplesPerPixel
  std::uint32_t depth = 8;
  std::uint32_t seed = 1;
};

/// An element of `passes`: a launch with a ray generation of its own.
struct PassDescription {
  ObjectDescription rayGeneration;
  RenderSettings render;
  Place place;
};

/// The options of the renderer for these settings; the others keep their defaults.
runtime::RenderOptions renderOptions(const RenderSettings &settings);

struct ImportDescription {
  LocatedName name;      // as written: "std.cameras" or "glass.rtsl"
  std::string path;      // resolved; empty for a module name such as std.cameras
  bool isOfScene = true; // written there; otherwise of a class that stands for a part of the scene
};

/// What errors that are known already are about: building a scene reports no others of what uses
/// it. For checking all of a scene at once.
struct Refusals {
  std::set<std::string> names;   // of objects and buffers
  std::set<std::string> classes; // of which there are none
  bool isAny = false;            // parts of the scene are missing, and it cannot be built
};

struct SceneDescription {
  std::string file;                  // as given
  std::vector<std::string> included; // other scene files that are parts of it
  double frame = 0;                  // which frame this is
  std::set<double> keyFrames;        // of any of its values
  bool isAnimated = false;           // by key frames, or by the animation of a model
  std::vector<ImportDescription> imports;
  std::optional<ObjectDescription> camera;                        // the classic engine needs it
  std::vector<std::pair<std::string, ObjectDescription>> cameras; // by name, to choose from
  std::optional<ObjectDescription> rayGeneration;                 // the programs engine needs it
  std::map<std::string, ObjectDescription> images, helpers, textures, materials;
  std::map<const JsonValue *, ImageDescription> imageValues; // all, those written in place too
  std::map<const JsonValue *, BufferDescription> bufferValues;
  std::map<std::string, const JsonValue *> buffers; // by name; in bufferValues
  std::vector<PassDescription> passes;              // empty: the one launch that `render` describes
  std::vector<GeometryDescription> objects;         // those of nodes come last
  std::vector<SelectorDescription> selectors;       // those above others come first
  std::vector<NodeMention> nodes; // empty, if a mistake keeps them from being read
  // the first is that of the scene, above all nodes
  std::vector<std::shared_ptr<VariableScope>> scopes{std::make_shared<VariableScope>()};
  std::vector<std::string> roots; // names, by number; empty: `objects` alone, below root 0
  std::vector<SharedNodes> shared;
  InstanceDescription above; // of a part (ModelPart.h): what is above its root
  std::vector<ObjectDescription> lights;
  std::optional<ObjectDescription> background; // an rt_Miss class
  std::optional<ObjectDescription> exception;  // an rt_Exception class
  const JsonValue *backgroundColor = nullptr;  // or a color
  const JsonValue *ambient = nullptr;
  RenderSettings render;
  std::optional<std::array<float, 2>> shutter; // `render.shutter`: when it opens and closes
  runtime::LampChoice lampChoice = runtime::LampChoice::Automatic; // `render.lightSampler`
  std::optional<runtime::Sampler> sampler;                         // `render.sampler`
  /// `render.editable`: classes, or members of a class as "Class.member".
  std::vector<LocatedName> editable;
  std::vector<Warning> warnings;
  Refusals refused;
  std::shared_ptr<JsonValue> root;                            // owns all of the above JSON but for
  std::vector<std::shared_ptr<const JsonValue>> placedValues; // of lights in nodes
  std::shared_ptr<ModelFiles> models;                         // the glTF files; null: none
  std::shared_ptr<KeptFiles> keptFiles; // of scenes before this one, for it; null: none
  /// Whether meshes of nodes may be moved to world space (files/PlacedMesh.h): not if instances get
  /// other transforms later, with which their trees are kept.
  bool placesMeshes = true;
};

/// Reads a scene file and applies overrides (each "path.to.key=value", as given to --set) in order.
/// An override's value is JSON, or else a string; paths in it are relative to the working
/// directory, those in the file to the file's folder. `kept`: files of scenes before this one.
/// `errors` gets errors that do not prevent reading the rest, which is then without what they are
/// about (SceneDescription::refused); null: they are thrown.
SceneDescription readSceneFile(const std::string &path,
                               const std::vector<std::string> &overrides = {},
                               std::shared_ptr<KeptFiles> kept = nullptr,
                               ErrorCollector *errors = nullptr);

/// The same for a text in memory; `path` is for messages and for relative paths.
SceneDescription parseScene(const std::string &text, const std::string &path,
                            const std::vector<std::string> &overrides = {},
                            std::shared_ptr<KeptFiles> kept = nullptr,
                            ErrorCollector *errors = nullptr);

/// The same for a part of a scene (ModelPart.h), which need not have a camera. `part` has what is
/// above it, and may have models that are open.
SceneDescription readPart(std::shared_ptr<JsonValue> root, SceneDescription part);

/// The files that the scene reads besides shaders, each once: scene files that it includes, meshes,
/// images, buffers.
std::vector<std::string> filesOf(const SceneDescription &description);

/// The classes that the scene names, each once, sorted. Linking keeps these.
std::vector<std::string> classesUsed(const SceneDescription &description);

/// Every mention of a class, with its position, in the order of the file's sections.
std::vector<LocatedName> classMentions(const SceneDescription &description);

/// The members that are set in some object of each class that the scene names, inherited ones
/// included, or may be set by a variable. Null, or a list of nulls, does not count.
std::map<std::string, std::set<std::string>> givenMembers(const SceneDescription &description);

/// The classes of the objects that a member refers to in the objects of a class, by the names of
/// the class and the member; left out where something else than an object of the scene is given, or
/// where it may be a variable.
std::map<std::pair<std::string, std::string>, std::set<std::string>>
referredClasses(const SceneDescription &description);

/// The image, helper, texture or material of this name; null: there is none.
const ObjectDescription *findObject(const SceneDescription &description, const std::string &name);
/// Does the object set the member?
bool isGiven(const ObjectDescription &object, const std::string &member);
/// An object written in place of a reference. `what` begins messages. Throws MissingKey, WrongType.
ObjectDescription objectInPlace(const JsonValue &json, const std::string &what);

/// The number of the root that a string names where an `int` is needed. Throws WrongType. `what`
/// begins messages.
double numberOfRoot(const JsonValue &json, const SceneDescription &description,
                    const std::string &what);

/// How many launches the scene has: its passes, or one.
std::size_t launchCount(const SceneDescription &description);
/// The name of the ray generation of a pass, in a scene of all.
std::string nameOfPass(std::size_t pass);
/// The scene of one launch, which has no passes.
SceneDescription launchOf(const SceneDescription &description, std::size_t pass);

/// The buffers of a scene that have names. Its launches share them.
struct NamedBuffers {
  struct Buffer {
    runtime::ValueType type; // of the first member that uses it
    runtime::Value value;
  };
  std::map<std::string, Buffer> made;
};

/// An instance that is part of a scene, by its number there.
struct PartInstance {
  std::uint32_t number;
  runtime::MovingTransform inPart; // as InstanceDescription::inPart
};

/// What addPart() has added for a part.
struct AddedPart {
  RtslRef camera = 0;
  std::vector<PartInstance> instances;
};

/// Adds values to those of an object of a class that is about to be created, such as variables of
/// nodes above it.
using ValueCompletion = std::function<void(const std::string &className, runtime::ObjectValues &)>;

/// Adds the objects, instances, lights and camera of a part to a scene. Throws what buildScene
/// throws; what was added until then stays.
AddedPart addPart(const SceneDescription &part, runtime::Scene &scene, ValueCompletion complete);

/// Loads the meshes, creates the objects and checks all names and types against the program.
/// An output buffer of the ray generation that is not set gets the size of the launch. A scene with
/// passes has the ray generations of all, and is launched by the first.
runtime::Scene buildScene(const SceneDescription &description,
                          std::shared_ptr<const runtime::Program> program);
/// The same for one of several launches that share buffers: uses those made before, and adds
/// others.
runtime::Scene buildScene(const SceneDescription &description,
                          std::shared_ptr<const runtime::Program> program, NamedBuffers &buffers);

} // namespace rtsl::scene
