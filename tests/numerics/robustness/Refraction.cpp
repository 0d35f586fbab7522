//===- Refraction.cpp - refract() near the angle of total reflection ------===//
#include "CompiledShaders.h"
#include "Generators.h"
#include "HighPrecision.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

struct Case {
  Vec3 incident, normal;
  float eta;
};

class Refraction {
public:
  explicit Refraction(Path path)
      : shaders({"tests/numerics/robustness/shaders/Refraction.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Refraction", "Probe"}, {}, path),
        object(shaders.scene().addObject("Refraction")) {
    shaders.scene().setCamera(shaders.scene().addObject("Probe"));
    shaders.scene().setBackground(object);
    shaders.finish();
  }

  std::array<float, 3> operator()(const Case &one) const {
    shaders.set(object, "incident", {one.incident.x, one.incident.y, one.incident.z});
    shaders.set(object, "normal", {one.normal.x, one.normal.y, one.normal.z});
    shaders.set(object, "eta", {one.eta});
    return shaders.look();
  }

private:
  CompiledShaders shaders;
  RtslRef object;
};

const Refraction &refraction(Path path) {
  static const Refraction only(path);
  return only;
}

Vec3 randomUnit(Random &random) {
  for (;;) {
    const Vec3 v = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double length = std::sqrt(double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
    if (length > 0.1 && length < 1)
      return {float(v.x / length), float(v.y / length), float(v.z / length)};
  }
}

/// Unit vectors up to rounding, and an index at any distance from the one at which the ray begins
/// to be reflected totally: a few floats, a share of 2^-1 to 2^-24, or anything.
Case randomCase(Random &random) {
  Case one = {randomUnit(random), randomUnit(random), 0};
  const double cosine = double(one.incident.x) * one.normal.x +
                        double(one.incident.y) * one.normal.y +
                        double(one.incident.z) * one.normal.z;
  one.eta = float(1 / std::sqrt(std::max(1 - cosine * cosine, 1e-3)));
  switch (random.integer(0, 2)) {
  case 0:
    for (int steps = random.integer(-3, 3); steps != 0; steps += steps < 0 ? 1 : -1)
      one.eta = std::nextafter(one.eta, steps < 0 ? 0.0f : 10.0f);
    break;
  case 1:
    one.eta *= 1 + std::ldexp(random.between(-1, 1), -random.integer(1, 24));
    break;
  default:
    one.eta = random.between(0.25f, 4);
  }
  return one;
}

/// k and the direction, exactly (GLSL 4.60, 8.5); the direction counts where k is not negative.
Precise radicandOf(const Case &one, PreciseVec3 &direction) {
  const PreciseVec3 i = precise(one.incident), n = precise(one.normal);
  const Precise eta = one.eta, d = dot(n, i), k = 1 - eta * eta * (1 - d * d);
  const Precise along = k < 0 ? Precise(0) : Precise(eta * d + sqrt(k));
  for (std::size_t c = 0; c < 3; ++c)
    direction[c] = eta * i[c] - along * n[c];
  return k;
}

std::string show(const Case &one) {
  return fmt::format("incident {}, normal {}, eta {:a}", numerics::show(one.incident),
                     numerics::show(one.normal), one.eta);
}

Outcome runDirection(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Case one = randomCase(random);
    PreciseVec3 exact;
    if (radicandOf(one, exact) < 0)
      continue;
    const std::array<float, 3> seen = refraction(path)(one);
    Precise error = 0;
    for (std::size_t c = 0; c < 3; ++c)
      error = std::max(error, Precise(abs(Precise(seen[c]) - exact[c])));
    worst.add(static_cast<double>(error) / 0x1p-24 / std::max(1.0, double(one.eta)),
              [&] { return show(one); });
  }
  return worst.outcome();
}

Outcome runTotalReflection(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Case one = randomCase(random);
    PreciseVec3 exact;
    const bool isTotal = radicandOf(one, exact) < 0;
    worst.count(isTotal != (refraction(path)(one) == std::array<float, 3>{0, 0, 0}),
                [&] { return show(one); });
  }
  return worst.outcome();
}

double nanosecondsARefraction(Path path) {
  return timeOf(100'000, [&] {
    float sum = 0;
    for (int i = 0; i < 100'000; ++i)
      sum += refraction(path)({{0.6f, -0.8f, 0}, {0, 1, 0}, 0.7f})[0];
    return sum;
  });
}

} // namespace

std::vector<Row> refractionRows(Path path) {
  const auto row = rowsOf(path, nanosecondsARefraction);
  return {
      row("refraction.direction",
          "refract() at any distance from the angle of total reflection: the direction",
          "rounding units of max(1, eta)", 500'000, runDirection),
      row("refraction.total",
          "the same rays: those that are wrongly reflected totally, or wrongly not", "rays",
          500'000, runTotalReflection),
  };
}

} // namespace rtsl::numerics
