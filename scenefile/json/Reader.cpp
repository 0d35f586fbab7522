#include "scenefile/json/Reader.h"

#include "runtime/scene/Scene.h"
#include "scenefile/json/KeyFrames.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace rtsl::scene {

const JsonValue &expect(const JsonValue &value, JsonValue::Kind kind, const std::string &what) {
  if (value.kind != kind)
    throw aboutKeyFrames(
        Error(message::wrongKind(what, describe(kind), describe(value.kind)), value.place()),
        value);
  return value;
}

void checkKeys(const JsonValue &object, std::initializer_list<const char *> known,
               const std::string &what) {
  const std::vector<std::string> names(known.begin(), known.end());
  ErrorCollector errors;
  for (const auto &member : object.members) {
    const std::string &key = member.first.text;
    if (std::find(names.begin(), names.end(), key) != names.end())
      continue;
    Error error(message::unknownKey(what, key), object.place(member.first));
    if (const std::string near = closestName(key, names); !near.empty())
      error.fix(near);
    errors.add(key == "frames" ? aboutKeyFrames(std::move(error), object) : std::move(error));
  }
  errors.throwIfAny();
}

const JsonValue &require(const JsonValue &object, const char *key, const std::string &what) {
  if (const JsonValue *found = object.find(key))
    return *found;
  throw aboutKeyFrames(Error(message::missingKey(what, key), object.place()), object);
}

double readNumber(const JsonValue &value, const std::string &what) {
  expect(value, JsonValue::Kind::Number, what);
  if (!std::isfinite(value.number))
    throw Error(message::notFinite(what), value.place());
  return value.number;
}

std::uint32_t readInteger(const JsonValue &value, std::uint32_t lowest, std::uint32_t highest,
                          const std::string &what) {
  double number = readNumber(value, what);
  if (number != std::floor(number))
    throw aboutKeyFrames(Error(message::notInteger(what, number), value.place()), value);
  if (number < lowest || number > highest)
    throw Error(message::notBetween(what, lowest, highest, number), value.place());
  return std::uint32_t(number);
}

std::int32_t readId(const JsonValue &value) {
  const double number = readNumber(value, "`id`");
  if (number != std::floor(number) || number < -2147483648.0 || number > 2147483647.0)
    throw aboutKeyFrames(Error(message::badId(number), value.place()), value);
  return std::int32_t(number);
}

std::string resolvePath(const JsonValue &value, const std::string &sceneFile) {
  const std::filesystem::path path(value.string);
  if (path.is_absolute() || value.fromOverride)
    return value.string;
  const std::string &from = value.isIncluded ? *value.file : sceneFile;
  return (std::filesystem::path(from).parent_path() / path).lexically_normal().string();
}

std::vector<double> readNumbers(const JsonValue &value, std::size_t count,
                                const std::string &what) {
  expect(value, JsonValue::Kind::Array, what);
  if (value.elements.size() != count)
    throw Error(message::numberCount(what, count, value.elements.size()), value.place());
  std::vector<double> numbers;
  for (const JsonValue &element : value.elements)
    numbers.push_back(readNumber(element, fmt::format("each number of {}", what)));
  return numbers;
}

} // namespace rtsl::scene
