#include "scenefile/graph/KeyTimes.h"

#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

namespace rtsl::scene {

std::vector<float> readKeyTimes(const JsonValue &value, const std::string &what) {
  const JsonValue &keys = require(value, "keys", what);
  expect(keys, JsonValue::Kind::Array, "`keys`");
  const std::size_t count = keys.elements.size();
  if (count < 2)
    throw Error(message::tooFewKeys(what), keys.place());
  std::vector<float> times;
  const JsonValue *given = value.find("times");
  if (!given) {
    for (std::size_t i = 0; i < count; ++i)
      times.push_back(float(double(i) / double(count - 1)));
    return times;
  }
  expect(*given, JsonValue::Kind::Array, "`times`");
  if (given->elements.size() != count)
    throw Error(message::timeCount(given->elements.size(), count), given->place());
  for (const JsonValue &element : given->elements) {
    const double time = readNumber(element, "a time");
    if (!(time >= 0 && time <= 1))
      throw Error(message::keyTimeOutOfRange(time), element.place());
    if (!times.empty() && !(float(time) > times.back()))
      throw Error(message::timesNotAscending(time, times.back()), element.place());
    times.push_back(float(time));
  }
  return times;
}

} // namespace rtsl::scene
