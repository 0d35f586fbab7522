//===- Override.cpp - values given on the command line --------------------===//
#include "runtime/scene/Scene.h"
#include "scenefile/json/JsonValue.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <charconv>

namespace rtsl::scene {

namespace {

/// What messages show of an override is the option and its text.
const std::string option = "--set ";

/// The column of what is `offset` characters into the text of an override.
std::uint32_t columnOf(std::size_t offset) {
  return static_cast<std::uint32_t>(option.size() + offset + 1);
}

/// Marks a value and its parts as given on the command line, `offset` characters into its text.
void mark(JsonValue &value, const std::shared_ptr<const std::string> &origin, std::size_t offset) {
  const auto move = [&](std::uint32_t line, std::uint32_t &column) {
    if (line == 1)
      column += columnOf(offset) - 1;
  };
  value.file = origin;
  move(value.line, value.column);
  value.fromOverride = true;
  for (JsonValue &element : value.elements)
    mark(element, origin, offset);
  for (auto &member : value.members) {
    move(member.first.line, member.first.column);
    mark(member.second, origin, offset);
  }
}

JsonValue parseValue(const std::string &text, const std::string &origin, std::size_t offset) {
  try {
    return parseJson(text, origin);
  } catch (const Error &error) {
    // Text that begins like JSON must be JSON, and a number must be in range.
    if (error.code == ErrorCode::OutOfRange ||
        (!text.empty() && (text[0] == '{' || text[0] == '[' || text[0] == '"'))) {
      Place place = error.place.value_or(Place{origin});
      if (place.line == 1)
        place.column += columnOf(offset) - 1;
      throw Error({ErrorCode::BadOverride, error.what()}, place);
    }
  }
  JsonValue value;
  value.kind = JsonValue::Kind::String;
  value.string = text;
  value.line = value.column = 1;
  value.length = static_cast<std::uint32_t>(text.size());
  return value;
}

struct PathPart {
  std::string text;
  std::size_t offset; // in the text of the override
};

std::vector<PathPart> splitPath(const std::string &path) {
  std::vector<PathPart> parts;
  std::size_t start = 0;
  for (;;) {
    std::size_t dot = path.find('.', start);
    parts.push_back({path.substr(start, dot - start), start});
    if (dot == std::string::npos)
      return parts;
    start = dot + 1;
  }
}

std::vector<std::string> namesOfMembers(const JsonValue &object) {
  std::vector<std::string> keys;
  for (const auto &member : object.members)
    keys.push_back(member.first.text);
  return keys;
}

class Walk {
public:
  Walk(const std::string &text, JsonValue &root)
      : origin(std::make_shared<const std::string>(option + text)), root(root) {}

  void apply(const std::string &text) {
    std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(message::overrideWithoutValue(), placeOf({text, 0}));
    const std::vector<PathPart> path = splitPath(text.substr(0, equals));
    JsonValue value = parseValue(text.substr(equals + 1), *origin, equals + 1);
    mark(value, origin, equals + 1);
    JsonValue *place = &root;
    for (std::size_t i = 0; i < path.size(); ++i) {
      place = &step(*place, path[i], i + 1 == path.size(), i == 0);
      walked += (i ? "." : "") + path[i].text;
    }
    *place = std::move(value);
  }

private:
  Place placeOf(const PathPart &part) const {
    return {*origin, 1, columnOf(part.offset), static_cast<std::uint32_t>(part.text.size())};
  }

  JsonValue &step(JsonValue &from, const PathPart &part, bool last, bool first) {
    const Place place = placeOf(part);
    if (part.text.empty())
      throw Error(message::overridePathEmpty(), place);
    if (from.kind == JsonValue::Kind::Array)
      return element(from, part, last);
    if (from.kind != JsonValue::Kind::Object)
      throw Error(message::overridePathEnds(walked, describe(from.kind), part.text), place);
    if (JsonValue *found = from.find(part.text))
      return *found;
    // A section of the file may be missing; deeper down a missing name is more likely a mistake.
    if (!last && !first) {
      Error error(message::overrideKeyUnknown(walked, part.text), place);
      if (const std::string near = closestName(part.text, namesOfMembers(from)); !near.empty())
        error.fix(near);
      throw error;
    }
    JsonValue added;
    added.kind = JsonValue::Kind::Object;
    added.file = origin;
    added.line = place.line;
    added.column = place.column;
    added.length = place.length;
    added.fromOverride = true;
    from.members.emplace_back(JsonKey{part.text, place.line, place.column, place.length, origin},
                              std::move(added));
    return from.members.back().second;
  }

  JsonValue &element(JsonValue &list, const PathPart &part, bool last) {
    const char *begin = part.text.data(), *textEnd = begin + part.text.size();
    std::size_t index = 0;
    auto [end, error] = std::from_chars(begin, textEnd, index);
    if (error != std::errc() || end != textEnd)
      throw Error(message::overrideIndexNotNumber(walked, part.text), placeOf(part));
    if (last && index == list.elements.size())
      list.elements.emplace_back();
    if (index >= list.elements.size())
      throw Error(message::overrideIndexTooLarge(walked, list.elements.size(),
                                                 list.elements.size() == 1 ? "" : "s", index),
                  placeOf(part));
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
