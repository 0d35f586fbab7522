//===- NumberCheck.cpp - where a sample stops being finite -----------------===//
#include "runtime/program/NumberCheck.h"

#include <cmath>
#include <csetjmp>
#include <map>
#include <utility>

namespace rtsl::runtime {

namespace {

/// What is known of a place in one rendering of the sample.
struct PlaceRecord {
  std::uint64_t lastBirth = 0; // when it last made a number not finite, from finite ones; 0: never
  std::uint64_t lastSeen = 0;  // when a number there was last not finite
  bool isMended = false;       // numbers that are not finite are exchanged for others
};

/// The rendering that is under way on this thread.
struct Search {
  std::map<std::uint32_t, PlaceRecord> places;
  std::uint64_t time = 0;  // numbers that were looked at
  std::uint64_t limit = 0; // then it is given up: a mended number may keep a loop from ending
  std::jmp_buf giveUp;
};
thread_local Search *search = nullptr;

/// No shader needs so many for a sample that ends.
constexpr std::uint64_t mostNumbers = 200'000'000;

/// Far outside of scenes, yet its square is finite.
constexpr double large = 1e18;

template <typename Number>
Number check(Number value, bool fromFinite, std::uint32_t place) {
  if (!search)
    return value;
  if (++search->time > search->limit)
    std::longjmp(search->giveUp, 1); // over frames of shaders and traversal, which own nothing
  if (std::isfinite(value))
    return value;
  PlaceRecord &record = search->places[place];
  record.lastSeen = search->time;
  if (fromFinite)
    record.lastBirth = search->time;
  if (!record.isMended)
    return value;
  return std::isnan(value) ? Number(1) : std::copysign(Number(large), value);
}

bool runOnce(Search &current, const std::function<bool()> &isFinite) {
  for (auto &[place, record] : current.places)
    record.lastBirth = record.lastSeen = 0;
  current.time = 0;
  search = &current;
  volatile bool result = false; // also where it was given up
  if (setjmp(current.giveUp) == 0)
    result = isFinite();
  search = nullptr;
  return result;
}

/// The latest place that made a number not finite; if there is none, where one was seen last.
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

} // namespace

std::optional<std::uint32_t> findOrigin(const std::function<bool()> &isFinite) {
  Search current;
  current.limit = mostNumbers;
  if (runOnce(current, isFinite))
    return std::nullopt;
  // A mended sample may take another path, but none that is endlessly longer.
  current.limit = 16 * current.time + 100'000;
  for (;;) {
    const auto place = latest(current);
    if (place == current.places.end())
      return std::nullopt;
    place->second.isMended = true;
    if (runOnce(current, isFinite))
      return place->first;
  }
}

} // namespace rtsl::runtime

float rtsl_check_number(float value, float a, float b, float c, std::uint32_t place) {
  const bool fromFinite = std::isfinite(a) && std::isfinite(b) && std::isfinite(c);
  return rtsl::runtime::check(value, fromFinite, place);
}

double rtsl_double_check_number(double value, double a, double b, double c, std::uint32_t place) {
  const bool fromFinite = std::isfinite(a) && std::isfinite(b) && std::isfinite(c);
  return rtsl::runtime::check(value, fromFinite, place);
}
