//===- Override.cpp - values given on the command line --------------------===//
#include "runtime/scene/Scene.h"
#include "scenefile/JsonValue.h"
#include "support/ClosestName.h"

#include <fmt/format.h>

#include <charconv>

namespace rtsl::scene {

namespace {

/// Marks a value and its parts as given on the command line.
void mark(JsonValue &value, const std::shared_ptr<const std::string> &origin) {
  value.file = origin;
  value.line = value.column = value.length = 0;
  value.fromOverride = true;
  for (JsonValue &element : value.elements)
    mark(element, origin);
  for (auto &member : value.members) {
    member.first.line = member.first.column = member.first.length = 0;
    mark(member.second, origin);
  }
}

JsonValue parseValue(const std::string &text, const std::string &origin) {
  try {
    return parseJson(text, origin);
  } catch (const Error &error) {
    // Text that begins like JSON must be JSON, and a number must be in range.
    if (error.code == ErrorCode::OutOfRange ||
        (!text.empty() && (text[0] == '{' || text[0] == '[' || text[0] == '"')))
      throw Error(ErrorCode::BadOverride, error.what(), Place{origin});
  }
  JsonValue value;
  value.kind = JsonValue::Kind::String;
  value.string = text;
  return value;
}

std::vector<std::string> splitPath(const std::string &path) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (;;) {
    std::size_t dot = path.find('.', start);
    parts.push_back(path.substr(start, dot - start));
    if (dot == std::string::npos)
      return parts;
    start = dot + 1;
  }
}

std::vector<std::string> keysOf(const JsonValue &object) {
  std::vector<std::string> keys;
  for (const auto &member : object.members)
    keys.push_back(member.first.text);
  return keys;
}

class Walk {
public:
  Walk(const std::string &text, JsonValue &root)
      : origin(std::make_shared<const std::string>("--set " + text)), root(root) {}

  void apply(const std::string &text) {
    std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      fail("an override is written `path.to.key=value`");
    std::vector<std::string> path = splitPath(text.substr(0, equals));
    JsonValue value = parseValue(text.substr(equals + 1), *origin);
    mark(value, origin);
    JsonValue *place = &root;
    for (std::size_t i = 0; i < path.size(); ++i) {
      place = &step(*place, path[i], i + 1 == path.size(), i == 0);
      walked += (i ? "." : "") + path[i];
    }
    *place = std::move(value);
  }

private:
  [[noreturn]] void fail(const std::string &message) const {
    throw Error(ErrorCode::BadOverride, message, Place{*origin});
  }

  JsonValue &step(JsonValue &from, const std::string &part, bool last, bool first) {
    if (part.empty())
      fail("the path of an override has an empty part");
    if (from.kind == JsonValue::Kind::Array)
      return element(from, part, last);
    if (from.kind != JsonValue::Kind::Object)
      fail(fmt::format("`{}` is {}: it has no `{}` in it", walked, describe(from.kind), part));
    if (JsonValue *found = from.find(part))
      return *found;
    // A section of the file may be missing; deeper down a missing name is more likely a mistake.
    if (!last && !first) {
      std::string message = fmt::format("`{}` has no `{}`", walked, part);
      if (const std::string near = closestName(part, keysOf(from)); !near.empty())
        message += fmt::format("; did you mean `{}`?", near);
      fail(message);
    }
    JsonValue added;
    added.kind = JsonValue::Kind::Object;
    added.file = origin;
    added.fromOverride = true;
    from.members.emplace_back(JsonKey{part, 0, 0, 0}, std::move(added));
    return from.members.back().second;
  }

  JsonValue &element(JsonValue &list, const std::string &part, bool last) {
    std::size_t index = 0;
    auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (error != std::errc() || end != part.data() + part.size())
      fail(fmt::format("`{}` is a list: `{}` is not an index", walked, part));
    if (last && index == list.elements.size())
      list.elements.emplace_back();
    if (index >= list.elements.size())
      fail(fmt::format("`{}` has {} element{}: index {} is out of range", walked,
                       list.elements.size(), list.elements.size() == 1 ? "" : "s", index));
    return list.elements[index];
  }

  std::shared_ptr<const std::string> origin;
  JsonValue &root;
  std::string walked;
};

} // namespace

void applyOverride(JsonValue &root, const std::string &text) {
  Walk(text, root).apply(text);
}

} // namespace rtsl::scene
