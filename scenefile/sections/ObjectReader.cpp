//===- ObjectReader.cpp - objects and colors of a scene file --------------===//
#include "scenefile/sections/ObjectReader.h"

#include "scenefile/json/KeyFrames.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

namespace rtsl::scene {

using Kind = JsonValue::Kind;

ObjectDescription readObject(const JsonValue &value, const std::string &what) {
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

ReferenceDescription readReference(const JsonValue &value, const std::string &what) {
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

const JsonValue &readColor(const JsonValue &value, const std::string &what) {
  if (value.kind == Kind::Number) {
    readNumber(value, what);
    return value;
  }
  if (value.kind != Kind::Array)
    throw aboutKeyFrames(Error(message::notColor(what, describe(value.kind)), value.place()),
                         value);
  readNumbers(value, value.elements.size(), what);
  return value;
}

} // namespace rtsl::scene
