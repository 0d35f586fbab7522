#include "runtime/scene/MemberRanges.h"

#include "runtime/scene/Elements.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <cstring>

namespace rtsl::runtime {

namespace {

struct Component {
  std::size_t position; // among those of all elements
  double number;
};

double numberAt(ValueType::Kind kind, const std::uint8_t *word) {
  const auto read = [&](auto number) {
    std::memcpy(&number, word, sizeof number);
    return double(number);
  };
  return kind == ValueType::Kind::Int    ? read(std::int32_t(0))
         : kind == ValueType::Kind::UInt ? read(std::uint32_t(0))
                                         : read(0.0f);
}

/// The first component that is not in the range: of a number, vector or color, of the elements of
/// an array, or of those of a buffer.
std::optional<Component> firstOutside(const ValueType &type, const Range &range,
                                      const std::uint8_t *bytes, std::uint32_t colorComponents) {
  const Elements elements = elementsOf(type, bytes);
  const std::size_t components = type.kind == ValueType::Kind::Color ? colorComponents : type.rows;
  for (std::size_t i = 0; i < elements.count; ++i)
    for (std::size_t k = 0; k < components; ++k) {
      const double number = numberAt(type.kind, elements[i] + 4 * k);
      if (!range.contains(number))
        return Component{i * components + k, number};
    }
  return std::nullopt;
}

/// The number at a position among all those of a nested list; decrements `position` by the ones
/// before it. Null: there are fewer.
const Value *componentAt(const Value &value, std::size_t &position) {
  if (value.kind != Value::Kind::List)
    return position-- == 0 ? &value : nullptr;
  for (const Value &one : value.list)
    if (const Value *found = componentAt(one, position))
      return found;
  return nullptr;
}

/// Visits the numbers that the parts of a value are in key frames.
template <typename Visit>
void forEachKey(const Value &value, const Visit &visit) {
  if (value.keys)
    for (const Value &key : *value.keys)
      visit(key);
  for (const Value &one : value.list)
    forEachKey(one, visit);
}

} // namespace

void checkRange(const MemberInfo &declared, const std::uint8_t *start,
                std::uint32_t colorComponents, const std::string &owner, const std::string &what,
                const Value *value, const std::optional<Place> &fallback) {
  if (!declared.values)
    return;
  const ValueType &type = declared.type;
  const Range &range = *declared.values;
  const auto outside = [&](double number, const Value *at) {
    return Error(message::valueOutOfRange(what, numberText(number), toString(range)),
                 at && at->place ? at->place : fallback)
        .note(
            fmt::format("{} has `{} {} in {}`", owner, type.name, declared.name, toString(range)));
  };
  if (value) { // in whichever frame
    ErrorCollector errors;
    forEachKey(*value, [&](const Value &key) {
      const bool isFloat =
          type.kind == ValueType::Kind::Float || type.kind == ValueType::Kind::Color;
      const double number = isFloat ? double(float(key.number)) : key.number;
      if (!range.contains(number))
        errors.add(outside(number, &key));
    });
    errors.throwIfAny();
  }

  const std::optional<Component> found = firstOutside(type, range, start, colorComponents);
  if (!found)
    return;
  const Value *at = value;
  if (value && (type.kind != ValueType::Kind::Color || colorComponents == 3)) {
    std::size_t position = found->position;
    if (const Value *component = componentAt(*value, position))
      at = component; // else one number is for all components
  }
  throw outside(found->number, at);
}

} // namespace rtsl::runtime
