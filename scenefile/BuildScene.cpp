//===- BuildScene.cpp - from a description to objects of a program --------===//
#include "scenefile/MeshFiles.h"
#include "scenefile/SceneFile.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"

#include <fmt/format.h>

#include <algorithm>
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
  SceneBuilder(const SceneDescription &description, std::shared_ptr<const Program> program,
               NamedBuffers &buffers)
      : description(description), program(*program), buffers(buffers), scene(std::move(program)),
        files(description), images(description, [this](const std::string &className) {
          return readsLevels(className);
        }) {}

  Scene build() {
    attempt([&] {
      if (description.camera)
        scene.setCamera(add(*description.camera, "camera"));
      if (description.rayGeneration && description.render.engine != runtime::Engine::Classic)
        scene.setRayGeneration(add(*description.rayGeneration, "rayGeneration", true));
    });
    // Named objects are created in the order of their names, after those that they refer to.
    for (const auto *section : sections)
      for (const auto &object : *section)
        attempt([&, &object = object] { named(object.first, object.second.className.place); });
    for (std::size_t i = 0; i < description.objects.size(); ++i)
      attempt([&] { addGeometry(description.objects[i], i); });
    for (std::size_t i = 0; i < description.lights.size(); ++i)
      attempt([&] {
        const ObjectDescription &light = description.lights[i];
        scene.addLight(add(light, fmt::format("{} (lights.{})", light.className.text, i)));
      });
    attempt([&] {
      if (description.background)
        scene.setBackground(add(*description.background, "background"));
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
    errors.throwIfAny();
    for (const Warning &warning : description.warnings)
      scene.addWarning(warning);
    return std::move(scene);
  }

private:
  /// Thrown when a reference is to an object that was rejected, which has been reported.
  struct Refused {};

  /// An error in one part of the scene does not prevent checking the others.
  template <typename Step>
  void attempt(Step step) {
    try {
      errors.attempt(step);
    } catch (const Refused &) {
    }
  }

  /// `isLaunched`: its output buffers that are not set get the size of the launch.
  RtslRef add(const ObjectDescription &object, const std::string &name, bool isLaunched = false) {
    if (object.image)
      return addImage(*object.image, object.className.text, name);
    const ClassInfo *classInfo = program.find(object.className.text);
    ObjectValues values;
    values.place = object.className.place;
    if (object.constructor && object.constructor->kind == Kind::Array) {
      std::vector<Value> arguments;
      const auto &elements = object.constructor->elements;
      for (std::size_t i = 0; i < elements.size(); ++i)
        arguments.push_back(
            convert(elements[i],
                    classInfo && i < classInfo->parameters.size() ? &classInfo->parameters[i].type
                                                                  : nullptr,
                    fmt::format("argument {} of `{}`", i + 1, object.className.text)));
      values.constructor = std::move(arguments);
    } else if (object.constructor) {
      std::vector<NamedValue> arguments;
      for (const auto &[key, value] : object.constructor->members)
        arguments.push_back(
            {key.text,
             convert(value, classInfo ? typeOf(classInfo->parameters, key.text) : nullptr,
                     fmt::format("parameter `{}` of `{}`", key.text, object.className.text)),
             value.fromOverride ? value.place() : object.constructor->place(key)});
      values.constructor = std::move(arguments);
    }
    ErrorCollector ofMembers;
    for (const auto &[key, value] : object.members)
      ofMembers.attempt([&, &key = key, &value = value] {
        const MemberInfo *member = classInfo ? find(classInfo->members, key.text) : nullptr;
        const bool mayBeEmpty =
            member && member->hasDefault && member->type.kind == ValueType::Kind::Reference;
        values.members.push_back(
            {key.text,
             convert(*value, member ? &member->type : nullptr,
                     fmt::format("member `{}` of `{}`", key.text, name), mayBeEmpty),
             key.place});
      });
    if (isLaunched && classInfo)
      for (const MemberInfo &member : classInfo->members)
        if (member.type.isOutput && !isGiven(object, member.name))
          ofMembers.attempt([&] {
            values.members.push_back({member.name, outputOf(member, name), object.place});
          });
    ofMembers.throwIfAny();
    return scene.addObject(object.className.text, values, name);
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

  static bool isGiven(const ObjectDescription &object, const std::string &member) {
    return std::any_of(object.members.begin(), object.members.end(),
                       [&](const auto &one) { return one.first.text == member; });
  }

  /// An element for each launch index.
  Value outputOf(const MemberInfo &member, const std::string &name) const {
    const auto &[width, height] = std::pair(description.render.width, description.render.height);
    const std::string what = fmt::format("member `{}` of `{}`", member.name, name);
    if (member.type.bufferRank == 1 && height == 1)
      return zeros({width}, member.type, what);
    if (member.type.bufferRank == 2)
      return zeros({height, width}, member.type, what);
    throw Error(
        ErrorCode::MissingMember,
        fmt::format("{}, a `{}`, needs a size: {{\"size\": [...]}}", what, member.type.name),
        description.rayGeneration->place);
  }

  /// The buffer of this name, made on first use.
  Value namedBuffer(const JsonValue &json, const ValueType &type, const std::string &what) {
    const auto described = description.buffers.find(json.string);
    if (described == description.buffers.end()) {
      Error error(
          ErrorCode::UnknownName,
          fmt::format("{} is a `{}`, and no buffer is named `{}`", what, type.name, json.string),
          json.place());
      std::vector<std::string> names;
      for (const auto &buffer : description.buffers)
        names.push_back(buffer.first);
      if (const std::string near = closestName(json.string, names); !near.empty())
        error.fix(near);
      throw error;
    }
    auto made = buffers.made.find(json.string);
    if (made == buffers.made.end()) {
      const JsonValue &value = *described->second;
      made = buffers.made
                 .emplace(json.string,
                          NamedBuffers::Buffer{type,
                                               bufferOf(description.bufferValues.at(&value), type,
                                                        fmt::format("the buffer `{}`", json.string),
                                                        value.place())})
                 .first;
    }
    if (made->second.type.name != type.name)
      throw Error(ErrorCode::WrongType,
                  fmt::format("{} is a `{}`, and the buffer `{}` a `{}`", what, type.name,
                              json.string, made->second.type.name),
                  json.place());
    Value value = made->second.value;
    return value.at(json.place());
  }

  /// Whether the program reads more of an image than level 0.
  bool readsLevels(const std::string &className) const {
    const ClassInfo *sampler = program.find(className);
    const MemberInfo *starts = sampler ? find(sampler->members, "levelStarts") : nullptr;
    return starts && starts->isRead;
  }

  /// Equal images are one object.
  RtslRef addImage(const JsonValue &image, const std::string &className, const std::string &name) {
    const std::size_t number = images.numberOf(image);
    if (const auto found = samplers.find(number); found != samplers.end())
      return found->second;
    try {
      std::size_t notFinite = 0;
      runtime::Texels texels = images.take(number, notFinite);
      if (notFinite != 0)
        scene.addWarning({fmt::format("{}: {} numbers of the image are not finite, and count as 0",
                                      name, notFinite),
                          image.place()});
      return samplers[number] =
                 scene.addObject(className,
                                 runtime::samplerValues(std::move(texels),
                                                        description.imageValues.at(&image).sampling,
                                                        className == "sampler3D"),
                                 name);
    } catch (Error &error) {
      error.place = image.place();
      throw;
    }
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

  /// Converts JSON to a value. Strings name objects if the type is a reference, and are not allowed
  /// otherwise; null is no object, for references that `mayBeEmpty`.
  Value convert(const JsonValue &json, const ValueType *type, const std::string &what,
                bool mayBeEmpty = false) {
    switch (json.kind) {
    case Kind::Number:
      return Value(json.number).at(json.place());
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
        return Value(numberOfRoot(json, what)).at(json.place());
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
        return Value::reference(addImage(json, imageClass(json), what)).at(json.place());
      if (type && isImageClass(type->className) && !json.find("class"))
        throw Error(ErrorCode::MissingKey,
                    fmt::format("{} is a `{}`: an image needs a `file`, `slices` or `raw`", what,
                                type->className),
                    json.place());
      ObjectDescription object = inPlace(json, what);
      return Value::reference(add(object, object.className.text)).at(json.place());
    }
    case Kind::Null:
      if (mayBeEmpty)
        return Value::reference(0).at(json.place());
      break;
    }
    throw Error(ErrorCode::WrongType, fmt::format("{} cannot be null", what), json.place());
  }

  /// A string that stands for an int is the name of a root.
  double numberOfRoot(const JsonValue &json, const std::string &what) const {
    const auto &roots = description.roots;
    const auto found = std::find(roots.begin(), roots.end(), json.string);
    if (found != roots.end())
      return double(found - roots.begin());
    Error error(ErrorCode::WrongType,
                fmt::format("{} is an `int`, and no root is named `{}`", what, json.string),
                json.place());
    if (const std::string near = closestName(json.string, roots); !near.empty())
      error.fix(near);
    throw error;
  }

  static void refuseUnlessReference(const JsonValue &json, const ValueType *type,
                                    const std::string &what) {
    if (type && type->kind != ValueType::Kind::Reference)
      throw Error(ErrorCode::WrongType,
                  fmt::format("{} is a `{}`, not {}", what, type->name, describe(json.kind)),
                  json.place());
  }

  /// An object written in place of a reference.
  static ObjectDescription inPlace(const JsonValue &json, const std::string &what) {
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

  /// The helper, texture or material of this name, created on first use.
  RtslRef named(const std::string &name, const Place &place) {
    auto found = made.find(name);
    if (found != made.end()) {
      if (found->second == 0)
        throw Error(ErrorCode::ReferenceCycle,
                    fmt::format("`{}` refers to itself indirectly", name), place);
      return found->second;
    }
    const ObjectDescription *object = nullptr;
    for (const auto *section : sections)
      if (auto known = section->find(name); known != section->end())
        object = &known->second;
    if (!object) {
      Error error(ErrorCode::UnknownName,
                  fmt::format("no {}{}texture or material is named `{}`",
                              description.images.empty() ? "" : "image, ",
                              description.helpers.empty() ? "" : "helper, ", name),
                  place);
      if (const std::string near = closestName(name, allNames()); !near.empty())
        error.fix(near);
      throw error;
    }
    if (refused.count(name))
      throw Refused();
    made[name] = 0; // being created
    try {
      return made[name] = add(*object, name);
    } catch (...) {
      made.erase(name);
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

  /// Adds all instances of a geometry. Instances of a primitive share its object.
  void addGeometry(const GeometryDescription &geometry, std::size_t index) {
    RtslRef material =
        geometry.material.object
            ? add(*geometry.material.object, geometry.material.object->className.text)
            : named(geometry.material.name.text, geometry.material.name.place);
    requireMaterial(material, geometry);
    if (geometry.primitive) {
      std::string name =
          geometry.name.text.empty()
              ? fmt::format("{} (objects.{})", geometry.primitive->className.text, index)
              : geometry.name.text;
      const RtslRef primitive = add(*geometry.primitive, name);
      for (const runtime::Placement &placement : geometry.placements)
        scene.addPrimitive(primitive, material, placement);
      return;
    }
    const std::uint32_t number = mesh(geometry);
    for (const runtime::Placement &placement : geometry.placements)
      try {
        scene.addMeshInstance(number, material, placement);
      } catch (Error &error) {
        if (!error.place)
          error.place = geometry.place;
        throw;
      }
  }

  /// The error is at the reference to the material.
  void requireMaterial(RtslRef material, const GeometryDescription &geometry) const {
    const ClassInfo &classInfo = scene.classOf(material);
    if (classInfo.root == "rt_Material")
      return;
    const LocatedName &name =
        geometry.material.object ? geometry.material.object->className : geometry.material.name;
    throw Error(ErrorCode::WrongClass,
                fmt::format("`{}` is a `{}`, a `{}`, where a material is needed", name.text,
                            classInfo.name, classInfo.root),
                name.place);
  }

  /// Objects with the same file and the same transform share its mesh.
  std::uint32_t mesh(const GeometryDescription &geometry) {
    const std::size_t number = files.numberOf(geometry);
    auto found = meshes.find(number);
    if (found != meshes.end())
      return found->second;
    try {
      return meshes[number] =
                 scene.addMesh(files.take(number),
                               geometry.name.text.empty() ? geometry.meshPath : geometry.name.text);
    } catch (Error &error) {
      error.place = geometry.mesh.place;
      throw;
    }
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
  NamedBuffers &buffers;
  Scene scene;
  std::map<std::string, RtslRef> made; // 0: being created
  std::set<std::string> refused;
  ErrorCollector errors;
  MeshFiles files;
  ImageFiles images;
  std::map<std::size_t, RtslRef> samplers;     // by their number in `images`
  std::map<std::size_t, std::uint32_t> meshes; // by their number in `files`
};

} // namespace

Scene buildScene(const SceneDescription &description, std::shared_ptr<const Program> program) {
  NamedBuffers buffers;
  return buildScene(description, std::move(program), buffers);
}

Scene buildScene(const SceneDescription &description, std::shared_ptr<const Program> program,
                 NamedBuffers &buffers) {
  return SceneBuilder(description, std::move(program), buffers).build();
}

} // namespace rtsl::scene
