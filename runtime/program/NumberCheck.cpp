//===- NumberCheck.cpp - where a sample becomes infinite or NaN -----------===//
#include "runtime/program/NumberCheck.h"

#include <cmath>
#include <csetjmp>
#include <map>
#include <utility>

namespace rtsl::runtime {

namespace {

constexpr std::uint64_t never = ~std::uint64_t(0);

/// A place in the renderings of the sample.
struct PlaceRecord {
  std::uint64_t lastBirth = 0; // when it last made a non-finite number from finite ones; 0: never
  std::uint64_t lastSeen = 0;  // when a number there was last not finite
  bool makesThem = false;      // in any rendering
  // From then on it makes finite numbers instead, or passes on finite ones if it makes none.
  std::uint64_t mendedFrom = never;
};

/// The current rendering on this thread. Times are numbers that were checked.
struct Search {
  std::map<std::uint32_t, PlaceRecord> places;
  std::uint64_t time = 0;
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
  if (search->time < record.mendedFrom || (record.makesThem && !fromFinite))
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
    if (place->second.mendedFrom == never && place->second.lastSeen != 0 &&
        (best == current.places.end() || rank(place->second) > rank(best->second)))
      best = place;
  return best;
}

/// The place that makes the sample finite if it alone returns finite numbers, from as late a time
/// on as possible: of those that make non-finite numbers, or of those that only pass them on.
/// `first` has rendered the sample.
std::optional<std::uint32_t> originAlone(const Search &first, bool makesThem,
                                         const std::function<bool()> &isFinite) {
  std::optional<std::uint32_t> origin;
  std::uint64_t latestTime = 0;
  for (const auto &[place, record] : first.places) {
    if (record.makesThem != makesThem)
      continue;
    const auto isFiniteFrom = [&, place = place](std::uint64_t time) {
      Search alone = first;
      alone.places[place].mendedFrom = time;
      return runOnce(alone, isFinite);
    };
    if (!isFiniteFrom(latestTime + 1)) // times begin with 1
      continue;
    origin = place;
    ++latestTime;
    for (std::uint64_t after = first.time + 1; after - latestTime > 1;) {
      const std::uint64_t middle = latestTime + (after - latestTime) / 2;
      (isFiniteFrom(middle) ? latestTime : after) = middle;
    }
  }
  return origin;
}

/// The place that makes it finite if later ones return finite numbers, too.
std::optional<std::uint32_t> originAmongLaterOnes(Search current,
                                                  const std::function<bool()> &isFinite) {
  for (;;) {
    const auto place = latest(current);
    if (place == current.places.end())
      return std::nullopt;
    place->second.mendedFrom = 0;
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
  for (const bool makesThem : {true, false})
    if (const std::optional<std::uint32_t> place = originAlone(first, makesThem, isFinite))
      return place;
  return originAmongLaterOnes(first, isFinite);
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
