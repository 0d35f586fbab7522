#include "scenefile/json/JsonText.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace rtsl::scene {

static nlohmann::ordered_json toJson(const JsonValue &value) {
  switch (value.kind) {
  case JsonValue::Kind::Null:
    break;
  case JsonValue::Kind::Boolean:
    return value.boolean;
  case JsonValue::Kind::Number:
    return value.number;
  case JsonValue::Kind::String:
    return value.string;
  case JsonValue::Kind::Array: {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const JsonValue &element : value.elements)
      list.push_back(toJson(element));
    return list;
  }
  case JsonValue::Kind::Object: {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const auto &[key, member] : value.members)
      object[key.text] = toJson(member);
    return object;
  }
  }
  return nullptr;
}

std::string jsonText(const JsonValue &value) {
  return toJson(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace rtsl::scene
