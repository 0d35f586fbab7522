//===- JsonText.h - JSON as text ------------------------------------------===//
#pragma once

#include "scenefile/json/JsonValue.h"

#include <string>

namespace rtsl::scene {

/// The value in one line of JSON, with its keys in their order. Values that differ have different
/// texts: numbers are written with all digits that they have.
std::string jsonText(const JsonValue &value);

} // namespace rtsl::scene
