//===- BuildScene.cpp - from a description to objects of a program --------===//
#include "runtime/scene/MeshValues.h"
#include "scenefile/ImageObjects.h"
#include "scenefile/PrimitiveCount.h"
#include "scenefile/SceneFile.h"
#include "scenefile/files/MeshFiles.h"
#include "scenefile/graph/VariablePlaces.h"
#include "scenefile/graph/Variables.h"
#include "scenefile/json/KeyFrames.h"
#include "scenefile/mistakes/DarkLights.h"
#include "scenefile/mistakes/InvisibleObjects.h"
#include "scenefile/mistakes/Members.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace rtsl::scene {

using runtime::ClassInfo;
using runtime::MemberInfo;
using runtime::NamedValue;
using runtime::ObjectValues;
using runtime::Program;
using runtime::Scene;
using runtime::Value;
using runtime::ValueType;

namespace {

using Kind = JsonValue::Kind;

class SceneBuilder {
public:
  SceneBuilder(const SceneDescription &description, Scene &scene, NamedBuffers &buffers,
               ValueCompletion complete = nullptr)
      : description(description), program(scene.program()), variables(description, program),
        variablePlaces(description), buffers(buffers), scene(scene), complete(std::move(complete)),
        files(description, runtime::requestOf(this->program)), images(description, scene) {}

  /// Builds all of a scene.
  void build() {
    attempt([&] {
      if (description.camera)
        scene.setCamera(addCamera(*description.camera));
      if (!description.passes.empty())
        addPasses();
      else if (description.rayGeneration && description.render.engine != runtime::Engine::Classic)
        scene.setRayGeneration(
            add(*description.rayGeneration, "rayGeneration", &description.render));
    });
    scene.setLampChoice(description.lampChoice);
    if (description.shutter)
      scene.setShutter((*description.shutter)[0], (*description.shutter)[1]);
    addContents();
    attempt([&] {
      if (description.background)
        setBackground(*description.background);
    });
    attempt([&] {
      if (description.exception)
        scene.setException(add(*description.exception, "exception"));
    });
    attempt([&] {
      if (description.backgroundColor)
        setColor(*description.backgroundColor,
                 [&](const auto &color) { scene.setBackgroundColor(color); });
    });
    attempt([&] {
      if (description.ambient)
        setColor(*description.ambient, [&](const auto &color) { scene.setAmbient(color); });
    });
    finish();
  }

  /// Builds a part, which leaves the settings of the scene as they are.
  AddedPart buildPart() {
    AddedPart part;
    attempt([&] {
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
      addNamed();
    addSelectors();
    for (std::size_t i = 0; i < description.objects.size(); ++i)
      attempt([&] { addGeometry(description.objects[i], i); });
    variables.leaveNodes();
    if (variables.any())
      addNamed();
    for (std::size_t i = 0; i < description.lights.size(); ++i)
      attempt([&] {
        const ObjectDescription &light = description.lights[i];
        const std::string name = fmt::format("{} (lights.{})", light.className.text, i);
        const RtslRef reference = add(light, name);
        scene.addLight(reference);
        if (const std::optional<std::string> why = whyDark(scene, reference))
          scene.addWarning({message::lightIsDark(name, *why), light.className.place});
      });
  }

  RtslRef addCamera(const ObjectDescription &object) {
    const RtslRef camera = add(object, "camera");
    if (const std::optional<std::string> why = whyInvisible(scene, camera))
      scene.addWarning(
          {message::cameraSeesNothing(object.className.text, *why), object.className.place});
    return camera;
  }

  void finish() {
    errors.throwIfAny();
    for (const Warning &warning : description.warnings)
      scene.addWarning(warning);
    for (const Warning &warning : variables.warnings())
      scene.addWarning(warning);
  }

  /// The ray generations of all passes; the scene has that of the first.
  void addPasses() {
    std::vector<RtslRef> added;
    for (const PassDescription &pass : description.passes)
      added.push_back(add(pass.rayGeneration, nameOfPass(added.size()), &pass.render));
    scene.setRayGeneration(added.front());
  }

  void addNamed() {
    for (const auto *section : sections)
      for (const auto &object : *section)
        attempt([&, &object = object] {
          if (!isMade(object.first))
            named(object.first, object.second.className.place);
        });
  }

  /// Thrown when a reference is to an object that was rejected, which has been reported.
  struct Refused {};

  /// An error in one part of the scene does not prevent checking the others. Gives whether there
  /// was none.
  template <typename Step>
  bool attempt(Step step) {
    try {
      return errors.attempt(step);
    } catch (const Refused &) {
      return false;
    }
  }

  /// `launch`: of a ray generation, whose output buffers that are not set get its size.
  RtslRef add(const ObjectDescription &object, const std::string &name,
              const RenderSettings *launch = nullptr) {
    if (object.image)
      return images.of(*object.image, object.className.text, name);
    if (description.refused.classes.count(object.className.text))
      throw Refused();
    const ClassInfo *classInfo = program.find(object.className.text);
    ObjectValues values;
    values.place = object.className.place;
    // Where a value has an error, those of the others are still reported.
    bool isRefused = false;
    const auto valueOf = [&](auto read) {
      Value value = Value::refused();
      isRefused |= !attempt([&] { value = read(); });
      return value;
    };
    if (object.constructor && object.constructor->kind == Kind::Array) {
      std::vector<Value> arguments;
      const auto &elements = object.constructor->elements;
      for (std::size_t i = 0; i < elements.size(); ++i)
        arguments.push_back(valueOf([&] {
          return convert(elements[i],
                         classInfo && i < classInfo->parameters.size()
                             ? &classInfo->parameters[i].type
                             : nullptr,
                         fmt::format("argument {} of `{}`", i + 1, object.className.text));
        }));
      values.constructor = std::move(arguments);
    } else if (object.constructor) {
      std::vector<NamedValue> arguments;
      for (const auto &[key, json] : object.constructor->members)
        arguments.push_back(
            {key.text, valueOf([&, &key = key, &json = json] {
               return convert(
                   json, classInfo ? typeOf(classInfo->parameters, key.text) : nullptr,
                   fmt::format("parameter `{}` of `{}`", key.text, object.className.text));
             }),
             object.constructor->place(key)});
      values.constructor = std::move(arguments);
    }
    const auto ofMember = [&](const MemberInfo *member, const JsonValue &json,
                              const std::string &what) {
      const bool mayBeEmpty =
          member && member->hasDefault && member->type.kind == ValueType::Kind::Reference;
      return convert(json, member ? &member->type : nullptr, what, mayBeEmpty);
    };
    if (classInfo)
      for (const MemberInfo &member : classInfo->members)
        if (const VariableDefinition *variable = variables.of(member, object))
          values.members.push_back(
              {member.name, valueOf([&] {
                 const Variables::Taking taking(variables, *variable);
                 return ofMember(&member, *variable->second,
                                 fmt::format("the variable `{}`, which member `{}` of `{}` takes,",
                                             member.name, member.name, name));
               }),
               variable->first});
    for (const auto &[key, json] : object.members)
      values.members.push_back({key.text, valueOf([&, &key = key, &json = json] {
                                  return ofMember(
                                      classInfo ? find(classInfo->members, key.text) : nullptr,
                                      *json, fmt::format("member `{}` of `{}`", key.text, name));
                                }),
                                key.place});
    if (launch && classInfo)
      for (const MemberInfo &member : classInfo->members)
        if (member.type.isOutput && !isGiven(object, member.name) && !variables.of(member, object))
          values.members.push_back(
              {member.name, valueOf([&] { return outputOf(member, name, *launch, object.place); }),
               object.place});
    if (complete && !isRefused)
      complete(object.className.text, values);
    if (classInfo && leavesOut(*classInfo, values))
      values.variablePlaces = variablePlaces.of(object);
    const RtslRef added = scene.addObject(object.className.text, values, name);
    if (isRefused)
      throw Refused();
    return added;
  }

  /// Is a public member without a default not set?
  static bool leavesOut(const ClassInfo &classInfo, const ObjectValues &values) {
    const auto isSet = [&](const MemberInfo &member) {
      return std::any_of(values.members.begin(), values.members.end(),
                         [&](const NamedValue &one) { return one.name == member.name; });
    };
    return std::any_of(classInfo.members.begin(), classInfo.members.end(), [&](const auto &one) {
      return one.isPublic && !one.hasDefault && !isSet(one);
    });
  }

  Value bufferOf(const BufferDescription &buffer, const ValueType &type, const std::string &what,
                 const Place &place) const {
    try {
      return readBuffer(buffer, type, program.colorComponents, what).at(place);
    } catch (Error &error) {
      error.place = place;
      throw;
    }
  }

  /// An element for each launch index.
  Value outputOf(const MemberInfo &member, const std::string &name, const RenderSettings &launch,
                 const Place &place) const {
    const std::uint32_t width = launch.width, slices = launch.slices;
    const std::uint32_t height = launch.height / slices;
    const std::string what = fmt::format("member `{}` of `{}`", member.name, name);
    if (member.type.bufferRank == 1 && height == 1 && slices == 1)
      return zeros({width}, member.type, what);
    if (member.type.bufferRank == 3)
      return zeros({slices, height, width}, member.type, what);
    if (member.type.bufferRank == 2 && slices == 1)
      return zeros({height, width}, member.type, what);
    throw Error(message::bufferSizeMissing(what, member.type.name), place);
  }

  /// A buffer of `buffers`, whose elements all members that use it share.
  Value makeBuffer(const JsonValue &value, const ValueType &type, const std::string &name) {
    const std::string what = fmt::format("the buffer `{}`", name);
    if (const auto found = description.bufferValues.find(&value);
        found != description.bufferValues.end())
      return bufferOf(found->second, type, what, value.place());
    return runtime::blockOf(type, convert(value, &type, what), program.colorComponents, what,
                            value.place());
  }

  /// The buffer of this name, made on first use.
  Value namedBuffer(const JsonValue &json, const ValueType &type, const std::string &what) {
    if (description.refused.names.count(json.string))
      throw Refused();
    const auto described = description.buffers.find(json.string);
    if (described == description.buffers.end()) {
      Error error(message::noSuchBuffer(what, type.name, json.string), json.place());
      std::vector<std::string> names;
      for (const auto &buffer : description.buffers)
        names.push_back(buffer.first);
      if (const std::string near = closestName(json.string, names); !near.empty())
        error.fix(near);
      throw error;
    }
    auto made = buffers.made.find(json.string);
    if (made == buffers.made.end()) {
      made = buffers.made
                 .emplace(json.string, NamedBuffers::Buffer{type, makeBuffer(*described->second,
                                                                             type, json.string)})
                 .first;
    }
    if (made->second.type.name != type.name)
      throw Error(message::bufferTypeMismatch(what, type.name, json.string, made->second.type.name),
                  json.place());
    Value value = made->second.value;
    return value.at(json.place());
  }

  static const MemberInfo *find(const std::vector<MemberInfo> &members, const std::string &name) {
    for (const MemberInfo &member : members)
      if (member.name == name)
        return &member;
    return nullptr;
  }
  static const ValueType *typeOf(const std::vector<MemberInfo> &members, const std::string &name) {
    const MemberInfo *member = find(members, name);
    return member ? &member->type : nullptr;
  }

  static Value numberOf(const JsonValue &json) {
    Value value(json.number);
    if (json.keys) {
      std::vector<Value> keys;
      for (const JsonValue &key : *json.keys)
        keys.push_back(Value(key.number).at(key.place()));
      value.keys = std::make_shared<const std::vector<Value>>(std::move(keys));
    }
    return value.at(json.place());
  }

  /// Converts JSON to a value. Strings name objects if the type is a reference, and are not allowed
  /// otherwise; null is no object, for references that `mayBeEmpty`.
  Value convert(const JsonValue &json, const ValueType *type, const std::string &what,
                bool mayBeEmpty = false) {
    switch (json.kind) {
    case Kind::Number:
      return numberOf(json);
    case Kind::Boolean:
      return Value(json.boolean).at(json.place());
    case Kind::Array: {
      std::vector<Value> list;
      list.reserve(json.elements.size());
      for (const JsonValue &element : json.elements)
        list.push_back(convert(element, type, what, mayBeEmpty));
      return Value(std::move(list)).at(json.place());
    }
    case Kind::String:
      if (type && type->kind == ValueType::Kind::Int && type->bufferRank == 0)
        return Value(numberOfRoot(json, description, what)).at(json.place());
      if (type && type->bufferRank != 0 && type->kind != ValueType::Kind::Reference)
        return namedBuffer(json, *type, what);
      refuseUnlessReference(json, type, what);
      return Value::reference(named(json.string, json.place())).at(json.place());
    case Kind::Object: {
      if (const auto buffer = description.bufferValues.find(&json);
          type && buffer != description.bufferValues.end() && !isImageClass(type->className))
        return bufferOf(buffer->second, *type, what, json.place());
      refuseUnlessReference(json, type, what);
      if (isImage(json))
        return Value::reference(images.of(json, imageClass(json), what)).at(json.place());
      if (type && isImageClass(type->className) && !json.find("class"))
        throw Error(message::imageSourceMissing(what, type->className), json.place());
      ObjectDescription object = objectInPlace(json, what);
      return Value::reference(add(object, object.className.text)).at(json.place());
    }
    case Kind::Null:
      if (mayBeEmpty)
        return Value::reference(0).at(json.place());
      break;
    }
    throw Error(message::cannotBeNull(what), json.place());
  }

  static void refuseUnlessReference(const JsonValue &json, const ValueType *type,
                                    const std::string &what) {
    if (type && type->kind != ValueType::Kind::Reference)
      throw aboutKeyFrames(
          Error(message::typeMismatch(what, type->name, describe(json.kind)), json.place()), json);
  }

  /// Is there an object of this name, with whatever variables?
  bool isMade(const std::string &name) const {
    const auto found = made.lower_bound({name, {}});
    return found != made.end() && found->first.first == name;
  }

  /// The helper, texture or material of this name, created on first use, once for all uses for
  /// which it takes the same variables.
  RtslRef named(const std::string &name, const Place &place) {
    const ObjectDescription *object = findObject(description, name);
    if (!object && refused.count(name))
      throw Refused();
    if (!object) {
      Error error(message::noSuchObject(description.images.empty() ? "" : "image, ",
                                        description.helpers.empty() ? "" : "helper, ", name),
                  place);
      if (const std::string near = closestName(name, allNames()); !near.empty())
        error.fix(near);
      for (const NodeMention &node : description.nodes)
        if (node.name.text == name)
          error.related(node.name.place, "a node, not an object");
      throw error;
    }
    const std::pair key(name, variables.takenBy(*object));
    if (const auto found = made.find(key); found != made.end()) {
      if (found->second == 0)
        throw Error(message::objectCycle(name), place);
      return found->second;
    }
    if (refused.count(name))
      throw Refused();
    made[key] = 0; // being created
    try {
      return made[key] = add(*object, name);
    } catch (...) {
      made.erase(key);
      refused.insert(name);
      throw;
    }
  }

  std::vector<std::string> allNames() const {
    std::vector<std::string> names;
    for (const auto *section : sections)
      for (const auto &object : *section)
        names.push_back(object.first);
    return names;
  }

  //===--------------------------------------------------------------------===//
  // The graph
  //===--------------------------------------------------------------------===//

  /// An object written in place takes variables as a named one does: it is one object for all
  /// instances for which it takes the same.
  RtslRef addOnce(const ObjectDescription &object, const std::string &name) {
    const std::pair key(&object, variables.takenBy(object));
    if (const auto known = inPlaces.find(key); known != inPlaces.end())
      return known->second;
    return inPlaces[key] = add(object, name);
  }

  RtslRef referred(const ReferenceDescription &reference) {
    return reference.object ? addOnce(*reference.object, reference.shownName().text)
                            : named(reference.name.text, reference.name.place);
  }

  void addSelectors() {
    for (const SelectorDescription &selector : description.selectors) {
      selections.push_back(0);
      variables.enter(selector.scope);
      attempt([&] { selections.back() = addSelector(selector); });
    }
  }

  std::uint32_t addSelector(const SelectorDescription &selector) {
    const RtslRef object = referred(selector.object);
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
        isWhole =
            geometry.hasMaterial && attempt([&] {
              material = referred(geometry.material);
              requireRoot(material, "rt_Material", "a material", geometry.material.shownName());
            });
        if (geometry.primitive) {
          const std::size_t before = inPlaces.size();
          primitive = addOnce(*geometry.primitive, name);
          if (inPlaces.size() != before) // it is not that of another instance
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
      if (!files.isPlaced(number))
        return meshes[number] = scene.addMesh(std::move(mesh), name);
      meshes[number] = scene.addMesh(std::move(mesh), name, files.applied(number));
      placedMeshes.insert(meshes[number]);
      return meshes[number];
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
      runtime::NamedAttribute made = attributeFrom(
          attribute, read->type, convert(*attribute.values, &type, what), program.colorComponents);
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
    const RtslRef object = add(background, "background");
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
  const std::array<const std::map<std::string, ObjectDescription> *, 4> sections = {
      &description.images, &description.helpers, &description.textures,
      &description.materials}; // of named objects
  const Program &program;
  Variables variables;
  VariablePlaces variablePlaces;
  NamedBuffers &buffers;
  Scene &scene;
  const ValueCompletion complete;
  std::vector<PartInstance> *added = nullptr;                       // of a part
  std::map<std::pair<std::string, Variables::Taken>, RtslRef> made; // 0: being created
  std::map<std::pair<const ObjectDescription *, Variables::Taken>, RtslRef> inPlaces;
  std::vector<std::uint32_t> selections; // of child 0, by selector
  std::set<std::string> refused = description.refused.names;
  ErrorCollector errors;
  MeshFiles files;
  ImageObjects images;
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
