//===- SceneDescription.cpp - what a description contains -----------------===//
#include "scenefile/SceneFile.h"

#include "scenefile/Models.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;

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
      visit(nameOfClass(*className), members);
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

void forEachObject(const ReferenceDescription &reference, const ObjectVisitor &visit) {
  if (reference.object)
    forEachObject(*reference.object, visit);
}

/// Visits the objects in the order of the file's sections.
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
    forEachObject(geometry.material, visit);
  }
  for (const SelectorDescription &selector : description.selectors)
    forEachObject(selector.object, visit);
  forEachVariable(description, [&](const std::string &, const JsonValue &value) {
    forEachObject(value, visit);
  });
  for (const ObjectDescription &light : description.lights)
    forEachObject(light, visit);
  for (const auto &object : {description.background, description.exception})
    if (object)
      forEachObject(*object, visit);
}

/// The class of the object that a value is or names; empty: it is another one.
std::string classOfReferred(const SceneDescription &description, const JsonValue &value) {
  if (isImage(value))
    return imageClass(value);
  if (value.kind == Kind::Object) {
    const JsonValue *className = value.find("class");
    return className && className->kind == Kind::String ? className->string : "";
  }
  if (value.kind != Kind::String)
    return "";
  std::string className;
  for (const auto *section :
       {&description.images, &description.helpers, &description.textures, &description.materials})
    if (const auto found = section->find(value.string); found != section->end()) {
      if (!className.empty()) // the member's type decides between them
        return "";
      className = found->second.className.text;
    }
  return className;
}

bool isNothing(const JsonValue &value) {
  return value.kind == Kind::Null ||
         (value.kind == Kind::Array &&
          std::all_of(value.elements.begin(), value.elements.end(), isNothing));
}

} // namespace

LocatedName nameOfClass(const JsonValue &className) {
  return {className.string, className.place(), className.isOfLibrary};
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
    throw Error(message::classMissing(what), json.place());
  ObjectDescription object;
  object.className = nameOfClass(*className);
  object.place = json.place();
  for (const auto &[key, member] : json.members) {
    if (key.text == "constructor")
      object.constructor = &member;
    else if (key.text != "class")
      object.members.push_back({{key.text, json.place(key)}, &member});
  }
  if (object.constructor && object.constructor->kind != Kind::Array &&
      object.constructor->kind != Kind::Object)
    throw Error(message::constructorNotArguments(), object.constructor->place());
  return object;
}

double numberOfRoot(const JsonValue &json, const SceneDescription &description,
                    const std::string &what) {
  const auto &roots = description.roots;
  const auto found = std::find(roots.begin(), roots.end(), json.string);
  if (found != roots.end())
    return double(found - roots.begin());
  Error error(message::noSuchRoot(what, json.string), json.place());
  if (const std::string near = closestName(json.string, roots); !near.empty())
    error.fix(near);
  throw error;
}

std::size_t launchCount(const SceneDescription &description) {
  return std::max<std::size_t>(description.passes.size(), 1);
}

std::string nameOfPass(std::size_t pass) {
  return fmt::format("passes.{}", pass);
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
  for (const std::string &file : description.included)
    add(file);
  for (const GeometryDescription &geometry : description.objects)
    for (const MeshPath &key : geometry.mesh)
      add(key.path);
  for (const auto &image : description.imageValues)
    for (const std::string &file : image.second.files)
      add(file);
  for (const auto &buffer : description.bufferValues)
    add(buffer.second.file);
  if (description.models)
    for (const std::string &file : description.models->files())
      add(file);
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

std::map<std::pair<std::string, std::string>, std::set<std::string>>
referredClasses(const SceneDescription &description) {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> referred;
  std::set<std::pair<std::string, std::string>> unknown;
  std::set<std::string> variables;
  forEachVariable(description,
                  [&](const std::string &name, const JsonValue &) { variables.insert(name); });
  forEachObject(description, [&](const LocatedName &name, const auto &members) {
    for (const auto &[member, value] : members) {
      const std::pair<std::string, std::string> key(name.text, member.text);
      if (isNothing(*value))
        continue;
      const std::string className = classOfReferred(description, *value);
      if (className.empty() || variables.count(member.text))
        unknown.insert(key);
      else
        referred[key].insert(className);
    }
  });
  for (const auto &key : unknown)
    referred.erase(key);
  return referred;
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
  options.slices = settings.slices;
  options.samplesPerPixel = settings.samplesPerPixel;
  options.maxDepth = settings.depth;
  options.seed = settings.seed;
  return options;
}

} // namespace rtsl::scene
