//===- NumberCheck.cpp - where a sample becomes infinite or NaN -----------===//
#include "runtime/program/NumberCheck.h"

#include <cmath>
#include <csetjmp>
#include <map>
#include <utility>

namespace rtsl::runtime {

namespace {

/// The state of a place in one rendering of the sample.
struct PlaceRecord {
  std::uint64_t lastBirth = 0; // when it last made a non-finite number from finite ones; 0: never
  std::uint64_t lastSeen = 0;  // when a number there was last not finite
  bool makesThem = false;      // in any rendering
  bool isMended = false;       // it makes finite numbers instead, or passes on finite ones if it
                               // makes none
};

/// The current rendering on this thread.
struct Search {
  std::map<std::uint32_t, PlaceRecord> places;
  std::uint64_t time = 0;  // numbers that were checked
  std::uint64_t limit = 0; // when to give up: a replaced number may make a loop endless
  std::jmp_buf giveUp;
};
thread_local Search *search = nullptr;

/// No terminating sample of a shader computes more numbers.
constexpr std::uint64_t mostNumbers = 200'000'000;

/// Far outside of scenes, but with a finite square.
constexpr double large = 1e18;

template <typename Number>
Number check(Number value, bool fromFinite, std::uint32_t place) {
  if (!search)
    return value;
  if (++search->time > search->limit)
    std::longjmp(search->giveUp, 1); // over frames of shaders and traversal, which own no resources
  if (std::isfinite(value))
    return value;
  PlaceRecord &record = search->places[place];
  record.lastSeen = search->time;
  if (fromFinite) {
    record.lastBirth = search->time;
    record.makesThem = true;
  }
  if (!record.isMended || (record.makesThem && !fromFinite))
    return value;
  return std::isnan(value) ? Number(1) : std::copysign(Number(large), value);
}

bool runOnce(Search &current, const std::function<bool()> &isFinite) {
  for (auto &[place, record] : current.places)
    record.lastBirth = record.lastSeen = 0;
  current.time = 0;
  search = &current;
  volatile bool result = false; // also the result after longjmp
  if (setjmp(current.giveUp) == 0)
    result = isFinite();
  search = nullptr;
  return result;
}

/// The latest place that made a number not finite; if there is none, the last where one was seen.
std::map<std::uint32_t, PlaceRecord>::iterator latest(Search &current) {
  const auto rank = [](const PlaceRecord &record) {
    return std::make_pair(record.lastBirth, record.lastSeen);
  };
  auto best = current.places.end();
  for (auto place = current.places.begin(); place != current.places.end(); ++place)
    if (!place->second.isMended && place->second.lastSeen != 0 &&
        (best == current.places.end() || rank(place->second) > rank(best->second)))
      best = place;
  return best;
}

/// The latest place that makes the sample finite if it alone returns finite numbers. `first` has
/// rendered the sample.
std::optional<std::uint32_t> originAlone(const Search &first,
                                         const std::function<bool()> &isFinite) {
  Search untried = first;
  for (auto place = latest(untried); place != untried.places.end(); place = latest(untried)) {
    place->second.isMended = true;
    Search alone = first;
    alone.places[place->first].isMended = true;
    if (runOnce(alone, isFinite))
      return place->first;
  }
  return std::nullopt;
}

/// The place that makes it finite if later ones return finite numbers, too.
std::optional<std::uint32_t> originAmongLaterOnes(Search current,
                                                  const std::function<bool()> &isFinite) {
  for (;;) {
    const auto place = latest(current);
    if (place == current.places.end())
      return std::nullopt;
    place->second.isMended = true;
    if (runOnce(current, isFinite))
      return place->first;
  }
}

} // namespace

std::optional<std::uint32_t> findOrigin(const std::function<bool()> &isFinite) {
  Search first;
  first.limit = mostNumbers;
  if (runOnce(first, isFinite))
    return std::nullopt;
  // A sample with replaced numbers may take another path, but not a much longer one.
  first.limit = 16 * first.time + 100'000;
  const std::optional<std::uint32_t> alone = originAlone(first, isFinite);
  return alone ? alone : originAmongLaterOnes(first, isFinite);
}

} // namespace rtsl::runtime

float rtsl_check_number(float value, float a, float b, float c, std::uint32_t place) {
  const bool fromFinite = std::isfinite(a) && std::isfinite(b) && std::isfinite(c);
  return rtsl::runtime::check(value, fromFinite, place);
}

float rtsl_check_stored_number(float value, std::uint32_t place) {
  return rtsl::runtime::check(value, false, place);
}

double rtsl_double_check_number(double value, double a, double b, double c, std::uint32_t place) {
  const bool fromFinite = std::isfinite(a) && std::isfinite(b) && std::isfinite(c);
  return rtsl::runtime::check(value, fromFinite, place);
}

double rtsl_double_check_stored_number(double value, std::uint32_t place) {
  const auto stored = double(float(value));
  const double checked = rtsl::runtime::check(stored, std::isfinite(value), place);
  return std::isfinite(stored) ? value : checked;
}
