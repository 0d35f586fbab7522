//===- Scattering.cpp - glass, diffuse floors and lights of the examples --===//
#include "ChiSquare.h"
#include "Floor.h"
#include "HighPrecision.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

namespace rtsl::numerics {

namespace {

using device::Vec3;

const Floor &glass(Path path) {
  static const Floor only("examples/glass/Glass.rtsl", "Glass", path);
  return only;
}
const Floor &lambert(Path path) {
  static const Floor only("examples/glass/Lambert.rtsl", "Lambert", path);
  return only;
}
const Floor &lightReader(Path path) {
  static const Floor only(ownShaders + "LightReader.rtsl", "LightReader", path);
  return only;
}

/// Relative to air, from nearly nothing to more than any glass has.
float randomIndex(Random &random) {
  return random.integer(0, 3) ? random.between(1.01f, 4)
                              : 1 + std::ldexp(1.0f, -random.integer(1, 20));
}

/// In a white furnace glass is invisible: what is reflected and what passes make 1, from both
/// sides.
Outcome runGlassFurnace(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = glass(path);
  floor.set(floor.surroundings, "isWhite", {1});
  floor.set(floor.material, "transmission", {1, 1, 1});
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float index = randomIndex(random), cosine = randomCosine(random);
    floor.set(floor.material, "innerIndex", {index});
    floor.set(floor.material, "outerIndex", {1});
    const Incidence ray =
        incidence(cosine, random.integer(0, 1), std::ldexp(1.0f, random.integer(-4, 4)));
    worst.add(roundingUnits(floor.look(ray.origin, ray.direction)[0], 1),
              [&] { return fmt::format("index {:a}, cosine {:a}", index, cosine); });
  }
  return worst.outcome();
}

/// The same share is reflected along a path and along the same path backwards. Where the outer ray
/// grazes, the inner one's angle no longer tells the outer one's.
Outcome runGlassReciprocity(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = glass(path);
  floor.set(floor.surroundings, "isWhite", {0});
  floor.set(floor.material, "transmission", {1, 1, 1});
  floor.set(floor.material, "outerIndex", {1});
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float index = random.between(1.05f, 4),
                cosine = i % 8 == 0 ? 1.0f : random.between(0.05f, 1);
    floor.set(floor.material, "innerIndex", {index});
    const Incidence outside = incidence(cosine, true, 1);
    const Precise inner =
        sqrt(1 - (1 - Precise(cosine) * Precise(cosine)) / (Precise(index) * Precise(index)));
    const Incidence inside = incidence(static_cast<float>(inner), false, 1);
    const float forwards = floor.look(outside.origin, outside.direction)[0],
                backwards = floor.look(inside.origin, inside.direction)[1];
    // The inner ray's rounding moves the outer cosine by index / cosine as much.
    worst.add(std::fabs(double(forwards) - double(backwards)) / 0x1p-24 * double(cosine) /
                  double(index),
              [&] {
                return fmt::format("index {:a}, cosine {:a}: {} and {}", index, cosine, forwards,
                                   backwards);
              });
  }
  return worst.outcome();
}

/// Where the refracted ray goes: its sine against Snell's law.
Outcome runGlassSnell(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = glass(path);
  floor.set(floor.surroundings, "isWhite", {0});
  floor.set(floor.material, "transmission", {1, 1, 1});
  floor.set(floor.material, "outerIndex", {1});
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float index = randomIndex(random), cosine = randomCosine(random);
    floor.set(floor.material, "innerIndex", {index});
    const Incidence ray = incidence(cosine, true, 1);
    const std::array<float, 3> color = floor.look(ray.origin, ray.direction);
    if (color[1] < 0.01f) // nearly all is reflected
      continue;
    const Precise length = sqrt(Precise(ray.direction.x) * ray.direction.x +
                                Precise(ray.direction.y) * ray.direction.y);
    const Precise sine = Precise(ray.direction.x) / length / Precise(index);
    worst.add(static_cast<double>(abs(Precise(color[2]) / Precise(color[1]) - sine)) / 0x1p-24,
              [&] { return fmt::format("index {:a}, cosine {:a}", index, cosine); });
  }
  return worst.outcome();
}

/// The transmittance of colored glass: the tint to the power of the path's length.
Outcome runGlassTint(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = glass(path);
  floor.set(floor.surroundings, "isWhite", {1});
  floor.set(floor.material, "innerIndex", {1.5f});
  floor.set(floor.material, "outerIndex", {1});
  for (std::uint64_t i = 0; i < cases; ++i) {
    // From clear to black, over ways from 1e-6 to 1e6.
    const float depth = std::pow(10.0f, random.between(-8, 1.5f)),
                way = std::pow(10.0f, random.between(-6, 6));
    const float tint = std::exp(-depth / way);
    if (!(tint > 0))
      continue;
    floor.set(floor.material, "transmission", {tint, 1, 0});
    const std::array<float, 3> color =
        floor.look({0, -way, 0}, {0, std::ldexp(1.0f, random.integer(-4, 4)), 0});
    const Precise exact = pow(Precise(tint), Precise(way));
    const double passed = roundingUnits(color[0], exact) / (1 + static_cast<double>(-log(exact)));
    const bool isClear = roundingUnits(color[1], 1) <= 8, isBlack = color[2] == 0;
    worst.add(isClear && isBlack ? passed : std::numeric_limits<double>::infinity(),
              [&] { return fmt::format("tint {:a} over {:a}", tint, way); });
  }
  return worst.outcome();
}

/// A point light over a diffuse floor at any angle, right above and below, and in the floor's
/// plane: cosine / distance^2 and the surroundings' nothing, in rounding units of 1 / distance^2.
Outcome runLambert(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = lambert(path);
  floor.set(floor.light, "radius", {0});
  floor.set(floor.light, "intensity", {1, 1, 1});
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float cosines[] = {1, 0, -1, std::ldexp(1.0f, -random.integer(1, 30)),
                             random.between(-1, 1)},
                cosine = cosines[i % 5];
    const float distance = std::pow(10.0f, random.between(-3, 3)),
                angle = random.between(0, 6.2831853f), sine = sineOf(cosine);
    const Vec3 at = Vec3{sine * std::cos(angle), cosine, sine * std::sin(angle)} * distance;
    floor.set(floor.light, "position", {at.x, at.y, at.z});
    const float seen = floor.look({0, 1, 0}, {0, -1, 0})[0];
    const PreciseVec3 path = precise(at);
    const Precise square = dot(path, path),
                  exact = at.y > 0 ? path[1] / (square * sqrt(square)) : Precise(0);
    // In the plane itself the floor may hide the light: both answers are off by a cosine of less
    // than 1e-3 (see Spawn.h).
    const bool isHidden = seen == 0 && cosine < 1e-3f;
    const double error = isHidden && cosine > 0
                             ? 0
                             : static_cast<double>(abs(Precise(seen) - exact) * square) / 0x1p-24;
    worst.add(std::isfinite(seen) && seen >= 0 ? error : std::numeric_limits<double>::infinity(),
              [&] { return fmt::format("light at {}: {}", numerics::show(at), seen); });
  }
  return worst.outcome();
}

/// The points that BallLight draws, in 512 cells of equal area.
Outcome runBallLight(Path path, std::uint64_t cases, std::uint32_t seed) {
  const Floor &floor = lightReader(path);
  constexpr float radius = 1, above = 2;
  floor.set(floor.light, "position", {0, above, 0});
  floor.set(floor.light, "radius", {radius});
  floor.set(floor.light, "intensity", {1, 1, 1});
  constexpr int heights = 16, turns = 32, cells = heights * turns;
  std::vector<std::uint64_t> counts(cells);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const std::array<float, 3> direction =
        floor.look({0, 1, 0}, {0, -1, 0}, std::uint32_t(i * 0x9E3779B9u) + seed);
    const double d[] = {direction[0] / radius, (double(direction[1]) - above) / radius,
                        direction[2] / radius};
    const double height = (d[1] + 1) / 2 * heights,
                 turn = (std::atan2(d[2], d[0]) / 6.283185307179586 + 0.5) * turns;
    ++counts[std::size_t(std::clamp(int(height), 0, heights - 1) * turns +
                         std::clamp(int(turn), 0, turns - 1))];
  }
  Worst worst;
  worst.add(ChiSquare::ofEqualShares(counts), [&] { return fmt::format("{} cells", cells); });
  Outcome outcome = worst.outcome();
  outcome.cases = cases;
  return outcome;
}

double nanosecondsALook(const Floor &floor) {
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += floor.look({0.1f, 1, 0}, {0.1f, -1, 0})[0];
    return sum;
  });
}

} // namespace

std::vector<Row> scatteringRows(Path path) {
  const auto of = [&](const Floor &(*floor)(Path)) {
    return rowsOf(path, [=](Path p) { return nanosecondsALook(floor(p)); });
  };
  return {
      of(glass)("scattering.glassFurnace",
                "glass in a white furnace, from both sides, at cosines from 2^-12 to 1: reflected "
                "and refracted light against 1",
                "rounding units", 500'000, runGlassFurnace),
      of(glass)(
          "scattering.glassReciprocity",
          "what is reflected along a path and along its reverse, at outer cosines from 0.05 to 1",
          "rounding units times index / outer cosine", 500'000, runGlassReciprocity),
      of(glass)("scattering.glassSnell", "the sine of the refracted ray against Snell's law",
                "rounding units of 1", 500'000, runGlassSnell),
      of(glass)("scattering.glassTint",
                "white light through colored glass of thickness 1e-6 to 1e6",
                "rounding units times 1 + optical depth", 500'000, runGlassTint),
      of(lambert)("scattering.lambert",
                  "a diffuse floor under a point light, at cosines 0, 1, -1 and between",
                  "rounding units of the light's irradiance", 500'000, runLambert),
      of(lightReader)(
          "scattering.ballLight",
          "the points that the ball light draws: chi-square over 512 cells of equal area",
          "standard deviations", 5'000'000, runBallLight),
  };
}

} // namespace rtsl::numerics
