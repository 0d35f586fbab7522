#include "scenefile/json/KeyFrames.h"

#include "scenefile/json/Reader.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;

constexpr const char *stepHint =
    "`\"interpolate\": \"step\"` beside `frames` makes values change at once";

struct Key {
  double frame;
  const JsonKey *name;
  const JsonValue *value;
};

std::optional<double> numberOf(const std::string &text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    return std::nullopt;
  return number;
}

/// Other objects may have a member, a parameter or a name that is called `frames`.
bool isKeyFrames(const JsonValue &value) {
  const JsonValue *frames = value.find("frames");
  if (!frames || frames->kind != Kind::Object || frames->members.empty() ||
      value.members.size() > (value.find("interpolate") ? 2u : 1u))
    return false;
  return std::any_of(frames->members.begin(), frames->members.end(),
                     [](const auto &member) { return numberOf(member.first.text).has_value(); });
}

Place placeOf(const JsonValue &object, const Key &key) {
  return key.value->fromOverride ? key.value->place() : object.place(*key.name);
}

std::vector<Key> keysOf(const JsonValue &frames) {
  std::vector<Key> keys;
  for (const auto &[name, value] : frames.members) {
    const std::optional<double> frame = numberOf(name.text);
    const Key key{frame.value_or(0), &name, &value};
    if (!frame)
      throw Error(message::keyNotFrame(name.text), placeOf(frames, key));
    for (const Key &other : keys)
      if (other.frame == key.frame)
        throw Error(message::frameTwice(other.name->text, name.text), placeOf(frames, key));
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end(), [](const Key &a, const Key &b) { return a.frame < b.frame; });
  return keys;
}

/// Changes the numbers of `value` to those at `share` of the way to `next`.
void interpolate(JsonValue &value, const JsonValue &next, double share);

void interpolateMembers(JsonValue &value, const JsonValue &next, double share) {
  if (value.members.size() != next.members.size())
    throw Error(message::frameObjectsDiffer(), next.place()).note(stepHint);
  for (auto &[key, member] : value.members) {
    const JsonValue *other = next.find(key.text);
    if (!other)
      throw Error(message::frameKeyMissing(key.text), next.place()).note(stepHint);
    interpolate(member, *other, share);
  }
}

bool isSame(const JsonValue &a, const JsonValue &b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.string == b.string;
}

void interpolate(JsonValue &value, const JsonValue &next, double share) {
  if (value.kind == Kind::Number && next.kind == Kind::Number) {
    value.number = between(value.number, next.number, share);
    value.isInteger = value.isInteger && next.isInteger && value.number == std::floor(value.number);
  } else if (value.kind == Kind::Array && next.kind == Kind::Array) {
    if (value.elements.size() != next.elements.size())
      throw Error(message::frameListsDiffer(value.elements.size(), next.elements.size()),
                  next.place())
          .note(stepHint);
    for (std::size_t i = 0; i < value.elements.size(); ++i)
      interpolate(value.elements[i], next.elements[i], share);
  } else if (value.kind == Kind::Object && next.kind == Kind::Object) {
    interpolateMembers(value, next, share);
  } else if (!isSame(value, next)) {
    throw Error(value.kind == next.kind
                    ? message::notInterpolated(describe(value.kind))
                    : message::notInterpolatedWith(describe(value.kind), describe(next.kind)),
                next.place())
        .note(stepHint);
  }
}

bool isStep(const JsonValue &value) {
  const JsonValue *how = value.find("interpolate");
  if (!how)
    return false;
  expect(*how, Kind::String, "`interpolate`");
  if (how->string != "linear" && how->string != "step")
    throw Error(message::badInterpolation(how->string), how->place());
  return how->string == "step";
}

/// The numbers of `value`, which is one of the keys or between two, get those of all keys.
void keepKeys(JsonValue &value, const std::vector<const JsonValue *> &keys) {
  std::vector<const JsonValue *> alike; // steps may be between values of different kinds
  for (const JsonValue *key : keys)
    if (key->kind == value.kind)
      alike.push_back(key);
  const auto partsOf = [&](const auto &find) {
    std::vector<const JsonValue *> parts;
    for (const JsonValue *key : alike)
      if (const JsonValue *part = find(*key))
        parts.push_back(part);
    return parts;
  };
  if (value.kind == Kind::Number) {
    auto numbers = std::make_shared<std::vector<JsonValue>>();
    for (const JsonValue *key : alike)
      if (key->keys) // key frames within key frames
        numbers->insert(numbers->end(), key->keys->begin(), key->keys->end());
      else
        numbers->push_back(*key);
    value.keys = std::move(numbers);
  }
  for (std::size_t i = 0; i < value.elements.size(); ++i)
    keepKeys(value.elements[i], partsOf([&](const JsonValue &key) {
               return i < key.elements.size() ? &key.elements[i] : nullptr;
             }));
  for (auto &[name, member] : value.members)
    keepKeys(member,
             partsOf([&, &name = name](const JsonValue &key) { return key.find(name.text); }));
}

/// The value with the position of its key, or of the one before.
JsonValue valueAt(const JsonValue &value, double frame) {
  const std::vector<Key> keys = keysOf(*value.find("frames"));
  const bool steps = isStep(value);
  if (!steps) // whatever the frame is
    for (std::size_t i = 1; i < keys.size(); ++i) {
      JsonValue between = *keys[i - 1].value;
      interpolate(between, *keys[i].value, 0.5);
    }
  std::vector<double> frames;
  for (const Key &key : keys)
    frames.push_back(key.frame);
  const FramePlace place = placeAmong(frames, frame);
  JsonValue found = *keys[place.key].value;
  if (!steps && place.next != place.key)
    interpolate(found, *keys[place.next].value, place.share);
  std::vector<const JsonValue *> values;
  for (const Key &key : keys)
    values.push_back(key.value);
  keepKeys(found, values);
  return found;
}

/// Whether a number in the value is none of those that its key frames give.
bool isBetweenKeys(const JsonValue &value) {
  const auto isKey = [&](const JsonValue &key) { return key.number == value.number; };
  return (value.keys && std::none_of(value.keys->begin(), value.keys->end(), isKey)) ||
         std::any_of(value.elements.begin(), value.elements.end(), isBetweenKeys) ||
         std::any_of(value.members.begin(), value.members.end(),
                     [](const auto &member) { return isBetweenKeys(member.second); });
}

/// In place of a value that its key frames do not give, so that the rest can be checked.
JsonValue firstOf(const JsonValue &value) {
  const auto &frames = value.find("frames")->members;
  return std::find_if(frames.begin(), frames.end(),
                      [](const auto &member) { return numberOf(member.first.text).has_value(); })
      ->second;
}

} // namespace

FramePlace placeAmong(const std::vector<double> &frames, double frame) {
  const auto after = std::upper_bound(frames.begin(), frames.end(), frame);
  const auto next = static_cast<std::size_t>(after - frames.begin());
  if (next == 0 || next == frames.size())
    return {next == 0 ? 0 : next - 1, next == 0 ? 0 : next - 1, 0};
  return {next - 1, next, (frame - frames[next - 1]) / (frames[next] - frames[next - 1])};
}

std::set<double> resolveKeyFrames(JsonValue &root, double frame, ErrorCollector &errors) {
  std::set<double> frames;
  for (JsonValue &element : root.elements)
    frames.merge(resolveKeyFrames(element, frame, errors));
  for (auto &member : root.members)
    frames.merge(resolveKeyFrames(member.second, frame, errors));
  if (!isKeyFrames(root))
    return frames;
  for (const auto &member : root.find("frames")->members)
    if (const std::optional<double> number = numberOf(member.first.text))
      frames.insert(*number);
  if (!errors.attempt([&] { root = valueAt(root, frame); }))
    root = firstOf(root);
  return frames;
}

Error aboutKeyFrames(Error error, const JsonValue &value) {
  if (value.find("frames"))
    error.note("key frames are values by the number of a frame, `{\"frames\": {\"0\": ..., \"24\": "
               "...}}`, with nothing beside `frames` but `interpolate`");
  else if (isBetweenKeys(value))
    error.note(fmt::format("this is between two key frames; {}", stepHint));
  return error;
}

} // namespace rtsl::scene
