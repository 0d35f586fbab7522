//===- KeyTimes.h - "times" of keys in a scene file -----------------------===//
#pragma once

#include "scenefile/json/JsonValue.h"

#include <string>
#include <vector>

namespace rtsl::scene {

/// The times of {"keys": [...], "times": [...]}: as many as there are keys, ascending, in [0, 1];
/// without `times` evenly spread over it. Throws the errors of Reader.h, and OutOfRange: fewer than
/// two keys, another number of times, or times that do not ascend. `what` is for messages.
std::vector<float> readKeyTimes(const JsonValue &value, const std::string &what);

} // namespace rtsl::scene
