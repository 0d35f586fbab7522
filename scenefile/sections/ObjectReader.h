//===- ObjectReader.h - objects and colors of a scene file ----------------===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::scene {

/// An object with its class, or an image. `what` begins messages, here and below. Throws WrongType,
/// MissingKey and others.
ObjectDescription readObject(const JsonValue &value, const std::string &what);

/// The name of an object, or an object in its place.
ReferenceDescription readReference(const JsonValue &value, const std::string &what);

/// A number or a list of numbers; the program determines how many.
const JsonValue &readColor(const JsonValue &value, const std::string &what);

} // namespace rtsl::scene
