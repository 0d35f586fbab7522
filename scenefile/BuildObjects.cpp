//===- BuildObjects.cpp - objects of a program from their descriptions ----===//
#include "scenefile/BuildObjects.h"

#include "runtime/buffers/BufferFiles.h"
#include "runtime/scene/ValueStore.h"
#include "scenefile/files/Images.h"
#include "scenefile/json/KeyFrames.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::scene {

using runtime::ClassInfo;
using runtime::MemberInfo;
using runtime::NamedValue;
using runtime::ObjectValues;
using runtime::Value;
using runtime::ValueType;

using Kind = JsonValue::Kind;

namespace {

const MemberInfo *find(const std::vector<MemberInfo> &members, const std::string &name) {
  for (const MemberInfo &member : members)
    if (member.name == name)
      return &member;
  return nullptr;
}

const ValueType *typeOf(const std::vector<MemberInfo> &members, const std::string &name) {
  const MemberInfo *member = find(members, name);
  return member ? &member->type : nullptr;
}

/// Is a public member without a default not set?
bool leavesOut(const ClassInfo &classInfo, const ObjectValues &values) {
  const auto isSet = [&](const MemberInfo &member) {
    return std::any_of(values.members.begin(), values.members.end(),
                       [&](const NamedValue &one) { return one.name == member.name; });
  };
  return std::any_of(classInfo.members.begin(), classInfo.members.end(), [&](const auto &one) {
    return one.isPublic && !one.hasDefault && !isSet(one);
  });
}

Value numberOf(const JsonValue &json) {
  Value value(json.number);
  if (json.keys) {
    std::vector<Value> keys;
    for (const JsonValue &key : *json.keys)
      keys.push_back(Value(key.number).at(key.place()));
    value.keys = std::make_shared<const std::vector<Value>>(std::move(keys));
  }
  return value.at(json.place());
}

void refuseUnlessReference(const JsonValue &json, const ValueType *type, const std::string &what) {
  if (type && type->kind != ValueType::Kind::Reference)
    throw aboutKeyFrames(
        Error(message::typeMismatch(what, type->name, describe(json.kind)), json.place()), json);
}

} // namespace

ObjectBuilder::ObjectBuilder(const SceneDescription &description, runtime::Scene &scene,
                             Variables &variables, ImageObjects &images, NamedBuffers &buffers,
                             ValueCompletion complete)
    : description(description), program(scene.program()), scene(scene), variables(variables),
      variablePlaces(description), images(images), buffers(buffers), complete(std::move(complete)) {
}

void ObjectBuilder::addNamed() {
  for (const auto *section : sections)
    for (const auto &object : *section)
      attempt([&, &object = object] {
        if (!isMade(object.first))
          named(object.first, object.second.className.place);
      });
}

RtslRef ObjectBuilder::add(const ObjectDescription &object, const std::string &name,
                           const RenderSettings *launch) {
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
             return convert(json, classInfo ? typeOf(classInfo->parameters, key.text) : nullptr,
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
                                    classInfo ? find(classInfo->members, key.text) : nullptr, *json,
                                    fmt::format("member `{}` of `{}`", key.text, name));
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

RtslRef ObjectBuilder::addOnce(const ObjectDescription &object, const std::string &name) {
  const std::pair key(&object, variables.takenBy(object));
  if (const auto known = inPlaces.find(key); known != inPlaces.end())
    return known->second;
  return inPlaces[key] = add(object, name);
}

RtslRef ObjectBuilder::referred(const ReferenceDescription &reference) {
  return reference.object ? addOnce(*reference.object, reference.shownName().text)
                          : named(reference.name.text, reference.name.place);
}

bool ObjectBuilder::isMade(const std::string &name) const {
  const auto found = made.lower_bound({name, {}});
  return found != made.end() && found->first.first == name;
}

RtslRef ObjectBuilder::named(const std::string &name, const Place &place) {
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

std::vector<std::string> ObjectBuilder::allNames() const {
  std::vector<std::string> names;
  for (const auto *section : sections)
    for (const auto &object : *section)
      names.push_back(object.first);
  return names;
}

Value ObjectBuilder::convert(const JsonValue &json, const ValueType *type, const std::string &what,
                             bool mayBeEmpty) {
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

Value ObjectBuilder::bufferOf(const BufferDescription &buffer, const ValueType &type,
                              const std::string &what, const Place &place) const {
  try {
    return readBuffer(buffer, type, program.colorComponents, what).at(place);
  } catch (Error &error) {
    error.place = place;
    throw;
  }
}

Value ObjectBuilder::outputOf(const MemberInfo &member, const std::string &name,
                              const RenderSettings &launch, const Place &place) const {
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

Value ObjectBuilder::makeBuffer(const JsonValue &value, const ValueType &type,
                                const std::string &name) {
  const std::string what = fmt::format("the buffer `{}`", name);
  if (const auto found = description.bufferValues.find(&value);
      found != description.bufferValues.end())
    return bufferOf(found->second, type, what, value.place());
  return runtime::blockOf(type, convert(value, &type, what), program.colorComponents, what,
                          value.place());
}

Value ObjectBuilder::namedBuffer(const JsonValue &json, const ValueType &type,
                                 const std::string &what) {
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
    made =
        buffers.made
            .emplace(json.string,
                     NamedBuffers::Buffer{type, makeBuffer(*described->second, type, json.string)})
            .first;
  }
  if (made->second.type.name != type.name)
    throw Error(message::bufferTypeMismatch(what, type.name, json.string, made->second.type.name),
                json.place());
  Value value = made->second.value;
  return value.at(json.place());
}

} // namespace rtsl::scene
