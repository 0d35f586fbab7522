//===- Choices.h - JSON strings that name one of several values -----------===//
#pragma once

#include "scenefile/json/Reader.h"
#include "support/ClosestName.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {

template <typename Value>
using Choice = std::pair<const char *, Value>;

/// The value that a string names. `what` begins the messages: "`filter`". Throws WrongType, and
/// OutOfRange with the name that is closest.
template <typename Value, std::size_t count>
Value choose(const JsonValue &json, const Choice<Value> (&choices)[count], const char *what) {
  expect(json, JsonValue::Kind::String, what);
  std::vector<std::string> names;
  for (const auto &[name, value] : choices) {
    if (json.string == name)
      return value;
    names.emplace_back(name);
  }
  Error error(message::notOneOf(what, fmt::join(names, "`, `"), json.string), json.place());
  if (const std::string near = closestName(json.string, names); !near.empty())
    error.fix(near);
  throw error;
}

} // namespace rtsl::scene
