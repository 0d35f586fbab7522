//===- BuildScene.cpp - a scene from its description ----------------------===//
#include "runtime/scene/MeshValues.h"
#include "scenefile/BuildObjects.h"
#include "scenefile/PrimitiveCount.h"
#include "scenefile/SceneFile.h"
#include "scenefile/files/MeshFiles.h"
#include "scenefile/mistakes/DarkLights.h"
#include "scenefile/mistakes/InvisibleObjects.h"
#include "scenefile/mistakes/Members.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace rtsl::scene {

using runtime::ClassInfo;
using runtime::Program;
using runtime::Scene;
using runtime::ValueType;

namespace {

using Kind = JsonValue::Kind;

class SceneBuilder {
public:
  SceneBuilder(const SceneDescription &description, Scene &scene, NamedBuffers &buffers,
               ValueCompletion complete = nullptr)
      : description(description), program(scene.program()), variables(description, program),
        scene(scene), images(description, scene),
        objects(description, scene, variables, images, buffers, std::move(complete)),
        files(description, runtime::requestOf(this->program)) {}

  /// Builds all of a scene.
  void build() {
    objects.attempt([&] {
      if (description.camera)
        scene.setCamera(addCamera(*description.camera));
      if (!description.passes.empty())
        addPasses();
      else if (description.rayGeneration && description.render.engine != runtime::Engine::Classic)
        scene.setRayGeneration(
            objects.add(*description.rayGeneration, "rayGeneration", &description.render));
    });
    scene.setLampChoice(description.lampChoice);
    if (description.shutter)
      scene.setShutter((*description.shutter)[0], (*description.shutter)[1]);
    addContents();
    objects.attempt([&] {
      if (description.background)
        setBackground(*description.background);
    });
    objects.attempt([&] {
      if (description.exception)
        scene.setException(objects.add(*description.exception, "exception"));
    });
    objects.attempt([&] {
      if (description.backgroundColor)
        setColor(*description.backgroundColor,
                 [&](const auto &color) { scene.setBackgroundColor(color); });
    });
    objects.attempt([&] {
      if (description.ambient)
        setColor(*description.ambient, [&](const auto &color) { scene.setAmbient(color); });
    });
    finish();
  }

  /// Builds a part, which leaves the settings of the scene as they are.
  AddedPart buildPart() {
    AddedPart part;
    objects.attempt([&] {
      if (description.camera)
        part.camera = addCamera(*description.camera);
    });
    added = &part.instances;
    addContents();
    finish();
    return part;
  }

private:
  /// Objects with names, geometry and lights.
  void addContents() {
    // Named objects are created in the order of their names, after those that they refer to. With
    // variables, what is used below a node is another object than what is used elsewhere.
    if (!variables.any())
      objects.addNamed();
    addSelectors();
    for (std::size_t i = 0; i < description.objects.size(); ++i)
      objects.attempt([&] { addGeometry(description.objects[i], i); });
    variables.leaveNodes();
    if (variables.any())
      objects.addNamed();
    for (std::size_t i = 0; i < description.lights.size(); ++i)
      objects.attempt([&] {
        const ObjectDescription &light = description.lights[i];
        const std::string name = fmt::format("{} (lights.{})", light.className.text, i);
        const RtslRef reference = objects.add(light, name);
        scene.addLight(reference);
        if (const std::optional<std::string> why = whyDark(scene, reference))
          scene.addWarning({message::lightIsDark(name, *why), light.className.place});
      });
  }

  RtslRef addCamera(const ObjectDescription &object) {
    const RtslRef camera = objects.add(object, "camera");
    if (const std::optional<std::string> why = whyInvisible(scene, camera))
      scene.addWarning(
          {message::cameraSeesNothing(object.className.text, *why), object.className.place});
    return camera;
  }

  void finish() {
    objects.throwIfAny();
    for (const Warning &warning : description.warnings)
      scene.addWarning(warning);
    for (const Warning &warning : variables.warnings())
      scene.addWarning(warning);
  }

  /// The ray generations of all passes; the scene has that of the first.
  void addPasses() {
    std::vector<RtslRef> added;
    for (const PassDescription &pass : description.passes)
      added.push_back(objects.add(pass.rayGeneration, nameOfPass(added.size()), &pass.render));
    scene.setRayGeneration(added.front());
  }

  //===--------------------------------------------------------------------===//
  // The graph
  //===--------------------------------------------------------------------===//

  void addSelectors() {
    for (const SelectorDescription &selector : description.selectors) {
      selections.push_back(0);
      variables.enter(selector.scope);
      objects.attempt([&] { selections.back() = addSelector(selector); });
    }
  }

  std::uint32_t addSelector(const SelectorDescription &selector) {
    const RtslRef object = objects.referred(selector.object);
    requireRoot(object, "rt_Selector", "a selector", selector.object.shownName());
    return scene.addSelector(object, selector.children, selector.toWorld,
                             selectionOf(selector.above, selector.childOfAbove));
  }

  /// The selection of a child of a selector, given as 1 + its index; 0: none.
  std::uint32_t selectionOf(std::size_t selector, std::uint32_t child) const {
    if (selector == 0)
      return 0;
    if (selections.at(selector - 1) == 0)
      throw Refused();
    return selections[selector - 1] + child;
  }

  /// Adds all instances of a geometry. Instances of a primitive share its object, unless they take
  /// different variables.
  void addGeometry(const GeometryDescription &geometry, std::size_t index) {
    const std::string name =
        !geometry.name.text.empty() ? geometry.name.text
        : geometry.primitive
            ? fmt::format("{} (objects.{})", geometry.primitive->className.text, index)
            : std::string();
    RtslRef material = 0, primitive = 0;
    std::uint32_t number = 0;       // of the mesh, or of primitives
    std::optional<std::string> why; // it is invisible
    bool isFirst = true, isTooFar = false;
    for (const InstanceDescription &instance : geometry.placements) {
      bool isWhole = true;
      if (isFirst || instance.scope != variables.scope()) {
        variables.enter(instance.scope);
        isWhole = geometry.hasMaterial && objects.attempt([&] {
          material = objects.referred(geometry.material);
          requireRoot(material, "rt_Material", "a material", geometry.material.shownName());
        });
        if (geometry.primitive) {
          const std::size_t before = objects.madeOnce();
          primitive = objects.addOnce(*geometry.primitive, name);
          if (objects.madeOnce() != before) // it is not that of another instance
            why = whyInvisible(scene, primitive);
          number = primitivesOf(geometry, scene, primitive);
        }
      }
      if (isFirst && !geometry.primitive && geometry.hasShape)
        number = mesh(geometry);
      if (!isWhole || !geometry.hasShape)
        return;
      isFirst = false;
      const std::size_t warnings = scene.warnings().size();
      try {
        const std::uint32_t made = place(instance, primitive, material, number);
        if (why && scene.warnings().size() == warnings) // its box has an area
          scene.addWarning(
              {message::primitiveIsInvisible(name, *why), geometry.primitive->className.place});
        why.reset();
        if (!isTooFar && primitive)
          if (const auto reach = reachesTooFar(scene, primitive, made)) {
            isTooFar = true;
            scene.addWarning({message::primitiveTooFar(name, *reach, farthest),
                              geometry.primitive->className.place});
          }
      } catch (Error &error) {
        if (!error.place)
          error.place = geometry.place;
        throw;
      }
    }
  }

  /// Returns the instance. `primitive` 0: of mesh `number`; otherwise of `number` primitives.
  std::uint32_t place(const InstanceDescription &instance, RtslRef primitive, RtslRef material,
                      std::uint32_t number) {
    runtime::Placement placement = instance;
    placement.selection = selectionOf(instance.selector, instance.childOfSelector);
    if (added) {
      const InstanceDescription &above = description.above;
      placement.roots = above.roots;
      placement.mask &= above.mask;
      placement.selection = above.selection;
    }
    if (!primitive && placedMeshes.count(number))
      placement.transform = {};
    const std::uint32_t made = primitive
                                   ? scene.addPrimitive(primitive, material, placement, number)
                                   : scene.addMeshInstance(number, material, placement);
    if (added)
      added->push_back({made, *instance.inPart});
    return made;
  }

  /// The error is at `name`, which refers to the object.
  void requireRoot(RtslRef object, const char *root, const char *what,
                   const LocatedName &name) const {
    const ClassInfo &classInfo = scene.classOf(object);
    if (classInfo.root == root)
      return;
    throw Error(message::wrongClass(name.text, classInfo.name, classInfo.root, what), name.place);
  }

  /// The mention of the file that an error of loading a mesh is about.
  static Place placeOfMesh(const GeometryDescription &geometry, const Error &error) {
    for (const MeshPath &key : geometry.mesh)
      if (error.place && error.place->file == key.path)
        return key.name.place;
    return geometry.mesh[0].name.place;
  }

  /// Objects with the same files and the same transform share its mesh.
  std::uint32_t mesh(const GeometryDescription &geometry) {
    const std::size_t number = files.numberOf(geometry);
    auto found = meshes.find(number);
    if (found != meshes.end())
      return found->second;
    if (!refusedMeshes.insert(number).second)
      throw Refused();
    try {
      runtime::Mesh mesh = files.take(number);
      addAttributes(geometry, files.applied(number), mesh);
      if (const std::optional<std::string> why = whyInvisible(mesh))
        scene.addWarning({message::meshIsInvisible(geometry.mesh[0].name.text, *why),
                          geometry.mesh[0].name.place});
      const std::string &name =
          geometry.name.text.empty() ? geometry.mesh[0].path : geometry.name.text;
      const bool isPlaced = files.isPlaced(number);
      const std::uint32_t made = scene.addMesh(
          std::move(mesh), name, isPlaced ? files.applied(number) : runtime::Transform());
      if (isPlaced)
        placedMeshes.insert(made);
      return meshes[number] = made;
    } catch (const Error &caught) {
      if (isOfAttribute(geometry, caught))
        throw;
      Error error = caught; // which other objects with the same file catch, too
      if (geometry.part.empty() || !error.place || error.place->line == 0) // else it is in the part
        error.place = placeOfMesh(geometry, error);
      throw error;
    }
  }

  /// The attributes that the scene gives, if the program reads them.
  void addAttributes(const GeometryDescription &geometry, const runtime::Transform &applied,
                     runtime::Mesh &mesh) {
    for (const AttributeDescription &attribute : geometry.attributes) {
      const runtime::AttributeInfo *read = runtime::findAttribute(program, attribute.name);
      if (!read) {
        scene.addWarning(
            {fmt::format("no material of the scene reads the attribute `{}`", attribute.name),
             attribute.place});
        continue;
      }
      if (!attribute.values)
        continue;
      const ValueType type = bufferOfAttribute(read->type);
      const std::string what = fmt::format("the attribute `{}`", attribute.name);
      runtime::NamedAttribute made =
          attributeFrom(attribute, read->type, objects.convert(*attribute.values, &type, what),
                        program.colorComponents);
      runtime::apply(applied, made);
      try {
        runtime::addInFileOrder(mesh, std::move(made), geometry.mesh[0].name.text);
      } catch (Error &error) {
        error.place = attribute.values->place();
        throw;
      }
    }
  }

  void setBackground(const ObjectDescription &background) {
    const RtslRef object = objects.add(background, "background");
    scene.setBackground(object);
    const Members members(scene, object);
    if (!members.is("EnvironmentMap") || !members.has("image", "sampler2D"))
      return;
    if (const auto *negative = images.negativeOf(members.value<RtslRef>("image")))
      scene.addWarning(
          {message::environmentNegative("background", negative->count, negative->lowest,
                                        negative->column, negative->row),
           background.className.place});
  }

  /// Is the error about a value that the scene gives?
  static bool isOfAttribute(const GeometryDescription &geometry, const Error &error) {
    return error.place && error.place->line != 0 && !geometry.attributes.empty() &&
           error.place->file == geometry.place.file;
  }

  template <typename Set>
  void setColor(const JsonValue &json, Set set) {
    std::vector<float> color;
    if (json.kind == Kind::Number)
      color.push_back(float(json.number));
    for (const JsonValue &element : json.elements)
      color.push_back(float(element.number));
    try {
      set(color);
    } catch (Error &error) {
      error.place = json.place();
      throw;
    }
  }

  const SceneDescription &description;
  const Program &program;
  Variables variables;
  Scene &scene;
  ImageObjects images;
  ObjectBuilder objects;
  std::vector<PartInstance> *added = nullptr; // of a part
  std::vector<std::uint32_t> selections;      // of child 0, by selector
  MeshFiles files;
  std::map<std::size_t, std::uint32_t> meshes; // by their number in `files`
  std::set<std::size_t> refusedMeshes;         // that were tried, and are not there
  std::set<std::uint32_t> placedMeshes;        // of the scene: they are in world space
};

} // namespace

Scene buildScene(const SceneDescription &description, std::shared_ptr<const Program> program) {
  NamedBuffers buffers;
  return buildScene(description, std::move(program), buffers);
}

Scene buildScene(const SceneDescription &description, std::shared_ptr<const Program> program,
                 NamedBuffers &buffers) {
  Scene scene(std::move(program));
  SceneBuilder(description, scene, buffers).build();
  return scene;
}

AddedPart addPart(const SceneDescription &part, Scene &scene, ValueCompletion complete) {
  NamedBuffers buffers;
  AddedPart added;
  scene.addAllOrNothing(
      [&] { added = SceneBuilder(part, scene, buffers, std::move(complete)).buildPart(); });
  return added;
}

} // namespace rtsl::scene
