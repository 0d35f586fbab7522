//===- Metal.cpp - the example's rough metal and matte surface ------------===//
//
// The oracles are the textbooks' formulas, in MPFR or, where they are integrated, in double.
//
//===----------------------------------------------------------------------===//
#include "ChiSquare.h"
#include "Floor.h"
#include "HighPrecision.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rtsl::numerics {

namespace {

using device::Vec3;

constexpr double pi = 3.14159265358979323846; // within 2^-54 of itself

/// What the functions of examples/metal/RoughMetal.rtsl say.
class Metal {
public:
  explicit Metal(Path path) : floor(ownShaders + "MetalReader.rtsl", "MetalReader", path) {}

  void polish(float theAlpha, const std::array<float, 3> &theReflectance) {
    alpha = theAlpha;
    reflectance = theReflectance;
    floor.set(floor.material, "alpha", {alpha});
    floor.set(floor.material, "reflectance", {reflectance[0], reflectance[1], reflectance[2]});
  }

  std::array<float, 3> value(Vec3 toLight, Vec3 toEye) const {
    place(toLight, toEye);
    return ask(0);
  }
  float density(Vec3 toLight, Vec3 toEye) const {
    place(toLight, toEye);
    return ask(1)[0];
  }
  struct Drawn {
    Vec3 toLight;
    std::array<float, 3> weight;
  };
  Drawn scatter(Vec3 toEye, float u, float v) const {
    const Vec3 toLight = draw(toEye, u, v);
    return {toLight, ask(3)};
  }
  Vec3 draw(Vec3 toEye, float u, float v) const {
    place({0, 0, 1}, toEye);
    floor.set(floor.material, "seed", {u, v});
    return device::load(ask(2).data());
  }

  std::string text() const {
    return fmt::format("alpha {:a}, reflectance {:a} {:a} {:a}", alpha, reflectance[0],
                       reflectance[1], reflectance[2]);
  }

  float alpha = 0;
  std::array<float, 3> reflectance{};

private:
  void place(Vec3 toLight, Vec3 toEye) const {
    floor.set(floor.material, "toLight", {toLight.x, toLight.y, toLight.z});
    floor.set(floor.material, "toEye", {toEye.x, toEye.y, toEye.z});
  }
  std::array<float, 3> ask(float what) const {
    floor.set(floor.material, "asks", {what});
    return floor.look({0, 1, 0}, {0, -1, 0});
  }

  Floor floor;
};

Metal &metal(Path path) {
  static Metal only(path);
  return only;
}
const Floor &furnace(Path path) {
  static const Floor only("examples/metal/RoughMetal.rtsl", "RoughMetal", path);
  return only;
}
const Floor &sampled(Path path) {
  static const Floor only("examples/metal/RoughMetal.rtsl", "RoughMetal", path, /*isSampled=*/true);
  return only;
}
const Floor &matte(Path path) {
  static const Floor only(ownShaders + "MatteReader.rtsl", "MatteReader", path);
  return only;
}

float randomAlpha(Random &random) {
  return random.integer(0, 7)   ? std::pow(10.0f, random.between(-3, 0))
         : random.integer(0, 1) ? 1.0f
                                : 1e-3f;
}
std::array<float, 3> randomReflectance(Random &random) {
  return {1, random.between(0.3f, 1), random.between(0.04f, 1)};
}
/// In the surface's frame, with a cosine that is hard.
Vec3 directionWith(Random &random, float cosine) {
  const float turn = random.between(0, 6.2831853f), sine = sineOf(cosine);
  return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

using Vector = std::array<double, 3>;

/// The textbooks' functions, of vectors of any length. The tangent of the angle with the normal,
/// squared.
template <typename Number>
Number slopeSquare(const std::array<Number, 3> &v) {
  return (v[0] * v[0] + v[1] * v[1]) / (v[2] * v[2]);
}
/// Walter et al. 2007, equation 33.
template <typename Number>
Number distribution(const Number &alpha, const std::array<Number, 3> &normal) {
  const Number tan2 = slopeSquare<Number>(normal), cosine2 = 1 / (1 + tan2), alpha2 = alpha * alpha,
               sum = alpha2 + tan2;
  return alpha2 / (Number(pi) * cosine2 * cosine2 * sum * sum);
}
/// Heitz 2014, equation 72.
template <typename Number>
Number lambda(const Number &alpha, const std::array<Number, 3> &v) {
  using std::sqrt;
  return (sqrt(1 + alpha * alpha * slopeSquare<Number>(v)) - 1) / 2;
}

/// F D G2 / (4 cosine cosine) without F, and the density G1 D / (4 cosine).
struct Answer {
  Precise value, density, cosine; // the last one is that with the half vector
};
Answer exactly(float alpha, Vec3 toLight, Vec3 toEye) {
  const PreciseVec3 light = precise(toLight), eye = precise(toEye),
                    h = {light[0] + eye[0], light[1] + eye[1], light[2] + eye[2]};
  const Precise a(alpha), d = distribution<Precise>(a, h), seen = lambda<Precise>(a, eye),
                          lit = lambda<Precise>(a, light);
  return {d / (4 * light[2] * eye[2] * (1 + seen + lit)), d / (4 * eye[2] * (1 + seen)),
          length(h) / 2};
}
Precise fresnel(float reflectance, const Precise &cosine) {
  const Precise away = cosine < 1 ? Precise(1 - cosine) : Precise(0);
  return Precise(reflectance) + (1 - Precise(reflectance)) * pow(away, 5);
}

/// Values and densities, near the mirror's direction and anywhere, at cosines of 0, 1, -1, and from
/// 2^-40. Below the surface and in it both are 0.
Outcome runValues(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Metal &target = metal(path);
  const auto hardCosine = [&] {
    const float cosines[] = {0, 1, -1, std::ldexp(1.0f, -random.integer(12, 40)),
                             -randomCosine(random)};
    return random.integer(0, 3) ? randomCosine(random) : cosines[random.index(5)];
  };
  for (std::uint64_t i = 0; i < cases; ++i) {
    target.polish(randomAlpha(random), randomReflectance(random));
    const Vec3 toEye = directionWith(random, hardCosine());
    Vec3 toLight = directionWith(random, hardCosine());
    if (i % 2) // the mirror's direction itself, or some slopes beside it
      toLight = device::normalized(Vec3{-toEye.x, -toEye.y, toEye.z} +
                                   random.inBox(1) * (target.alpha * float(random.integer(0, 4))));
    const auto where = [&] {
      return fmt::format("{}, to light {}, to eye {}", target.text(), show(toLight), show(toEye));
    };
    const std::array<float, 3> value = target.value(toLight, toEye);
    const float density = target.density(toLight, toEye);
    if (toLight.z <= 0 || toEye.z <= 0) {
      const bool isNothing =
          density == 0 && std::all_of(value.begin(), value.end(), [](float v) { return v == 0; });
      worst.add(isNothing ? 0 : std::numeric_limits<double>::infinity(), where);
      continue;
    }
    const Answer exact = exactly(target.alpha, toLight, toEye);
    worst.add(roundingUnits(density, exact.density), where);
    for (std::size_t c = 0; c < 3; ++c)
      worst.add(roundingUnits(value[c], exact.value * fresnel(target.reflectance[c], exact.cosine)),
                where);
  }
  return worst.outcome();
}

Outcome runReciprocity(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Metal &target = metal(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    target.polish(randomAlpha(random), randomReflectance(random));
    const Vec3 a = directionWith(random, randomCosine(random));
    const Vec3 b = i % 2 ? directionWith(random, randomCosine(random))
                         : device::normalized(Vec3{-a.x, -a.y, a.z} + random.inBox(target.alpha));
    const std::array<float, 3> forwards = target.value(a, b), backwards = target.value(b, a);
    for (std::size_t c = 0; c < 3; ++c)
      worst.add(roundingUnits(forwards[c], Precise(backwards[c])),
                [&] { return fmt::format("{}, {} and {}", target.text(), show(a), show(b)); });
  }
  return worst.outcome();
}

/// The weight of a direction that was drawn, value * cosine / density = F G2 / G1; none leads below
/// the surface with any weight.
Outcome runWeights(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Metal &target = metal(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    target.polish(randomAlpha(random), randomReflectance(random));
    const Vec3 toEye = directionWith(random, i % 16 ? randomCosine(random) : 0);
    const float u = random.integer(0, 7) ? random.between(0, 1) : 1 - 0x1p-24f,
                v = random.between(0, 1);
    const Metal::Drawn drawn = target.scatter(toEye, u, v);
    const auto where = [&] {
      return fmt::format("{}, to eye {}, seed {:a} {:a}", target.text(), show(toEye), u, v);
    };
    Precise share = 0, cosine = 1; // of what is reflected
    if (drawn.toLight.z > 0) {
      // (1 + lambda of the eye) / (1 + both), times both cosines, for that of the eye may be 0.
      const PreciseVec3 light = precise(drawn.toLight), eye = precise(toEye),
                        h = {light[0] + eye[0], light[1] + eye[1], light[2] + eye[2]};
      const auto times = [&](const PreciseVec3 &v) {
        return sqrt(v[2] * v[2] +
                    Precise(target.alpha) * Precise(target.alpha) * (v[0] * v[0] + v[1] * v[1]));
      };
      share = light[2] * (eye[2] + times(eye)) / (times(eye) * light[2] + times(light) * eye[2]);
      cosine = length(h) / 2;
    }
    for (std::size_t c = 0; c < 3; ++c)
      worst.add(roundingUnits(drawn.weight[c], share * fresnel(target.reflectance[c], cosine)),
                where);
  }
  return worst.outcome();
}

/// The material's methods, as a host calls them that samples for itself, on surfaces in any
/// position. Of what sampleBSDF draws, and BSDF and evaluatePDF say of it once more, value * cosine
/// / density is F G2 / G1, and the densities are the same. A direction's rounding moves the half
/// vector, and the distribution by as much over the slope of the mirrors; and a small cosine is
/// moved by much of itself.
Outcome runMethods(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = sampled(path);
  const runtime::Program::Slots &slots = floor.scene().program().slots;
  const RtslLaunch launch = floor.scene().launch();
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float alpha = randomAlpha(random);
    const std::array<float, 3> reflectance = randomReflectance(random);
    floor.set(floor.material, "alpha", {alpha});
    floor.set(floor.material, "reflectance", {reflectance[0], reflectance[1], reflectance[2]});
    const Vec3 normal = random.direction(), toEye = random.direction();
    RtslState state{};
    state.launch = &launch;
    device::store(state.ShadingNormal, normal);
    device::store(state.GeometricNormal, normal);
    device::store(state.RayDirection, toEye * -std::ldexp(1.0f, random.integer(-10, 10)));
    state.BSDFSeed[0] = random.between(0, 1);
    state.BSDFSeed[1] = random.between(0, 1);
    slots.rt_Material_sampleBSDF(&state, floor.material);
    RtslState again = state;
    slots.rt_Material_BSDF(&again, floor.material);
    slots.rt_Material_evaluatePDF(&again, floor.material);

    const auto unit = [](const PreciseVec3 &v) {
      return PreciseVec3{v[0] / length(v), v[1] / length(v), v[2] / length(v)};
    };
    const PreciseVec3 n = unit(precise(normal)), eye = unit(precise(toEye)),
                      light = unit(precise(device::load(state.LightDirection)));
    const Precise faces = dot(n, eye), seen = abs(faces),
                  lit = faces < 0 ? Precise(-dot(n, light)) : dot(n, light),
                  least = std::min(seen, lit);
    if (least < 1e-3)
      continue;
    const Precise a(alpha),
        half = length(PreciseVec3{eye[0] + light[0], eye[1] + light[1], eye[2] + light[2]}) / 2;
    const double steepness = 1 + 1 / static_cast<double>(a * half);
    const auto times = [&](const Precise &cosine) {
      return sqrt(cosine * cosine + a * a * (1 - cosine * cosine));
    };
    const Precise share = lit * (seen + times(seen)) / (times(seen) * lit + times(lit) * seen);
    const auto where = [&] {
      return fmt::format("alpha {:a}, normal {}, to eye {}, seed {:a} {:a}", alpha, show(normal),
                         show(toEye), state.BSDFSeed[0], state.BSDFSeed[1]);
    };
    for (const RtslState *each : {&state, &again})
      for (std::size_t c = 0; c < 3; ++c) {
        const Precise exact = share * fresnel(reflectance[c], half);
        const bool isNumber =
            std::isfinite(each->BSDFValue[c]) && std::isfinite(each->PDF) && each->PDF > 0;
        const Precise weight = isNumber
                                   ? Precise(Precise(each->BSDFValue[c]) * lit / Precise(each->PDF))
                                   : Precise(-1);
        worst.add(isNumber ? static_cast<double>(abs(weight - exact) / exact * least) / 0x1p-24 /
                                 steepness
                           : std::numeric_limits<double>::infinity(),
                  where);
      }
    worst.add(roundingUnits(again.PDF, Precise(state.PDF)) * static_cast<double>(least) / steepness,
              where);
  }
  return worst.outcome();
}

/// Integrates over the mirrors of the metal that an eye sees, by their share: calls add(share,
/// mirror) for the middles of a grid over [from, to) of both parameters, each in [0, 1). The first
/// is the cosine's parameter 1 - sqrt(1 - u), where u is what the distribution's sampling by D
/// (Walter et al. 2007, equation 35) draws uniformly; the second the turn.
template <typename Add>
void overSeenMirrors(double alpha, const Vector &eye, std::array<double, 2> from,
                     std::array<double, 2> to, std::array<int, 2> steps, Add add) {
  const double dw = (to[0] - from[0]) / steps[0], dt = (to[1] - from[1]) / steps[1];
  const double visible = 1 / (1 + lambda<double>(alpha, eye)); // G1
  for (int i = 0; i < steps[0]; ++i) {
    const double rest = 1 - (from[0] + (i + 0.5) * dw), u = 1 - rest * rest; // du = 2 rest dw
    const double tangent = alpha * std::sqrt(u) / rest,
                 cosine = 1 / std::sqrt(1 + tangent * tangent), sine = tangent * cosine;
    for (int k = 0; k < steps[1]; ++k) {
      const double turn = 2 * pi * (from[1] + (k + 0.5) * dt);
      const Vector mirror = {sine * std::cos(turn), sine * std::sin(turn), cosine};
      const double facing = eye[0] * mirror[0] + eye[1] * mirror[1] + eye[2] * mirror[2];
      if (facing > 0)
        add(visible * facing / (eye[2] * cosine) * 2 * rest * dw * dt, mirror);
    }
  }
}

/// The mirrors by which directions are drawn, against the density of those that an eye sees, in
/// cells that are alike where the eye looks straight down. The largest deviation of some
/// roughnesses and angles.
Outcome runDirections(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Metal &target = metal(path);
  constexpr std::uint64_t samples = 12'500;
  constexpr int rings = 10, turns = 16;
  for (std::uint64_t i = 0; i < cases / samples; ++i) {
    const float alpha = i % 4 == 0   ? 1e-3f
                        : i % 4 == 1 ? 1.0f
                                     : std::pow(10.0f, random.between(-3, 0));
    target.polish(alpha, {1, 1, 1});
    // The half vector of what is drawn shall tell the mirror: its rounding grows where the eye
    // grazes polished metal.
    const float least = 1e-4f / alpha, cosine = i % 3 == 0   ? 1
                                                : i % 3 == 1 ? least
                                                             : random.between(least, 1);
    const Vec3 toEye = directionWith(random, cosine);
    std::array<std::uint64_t, rings * turns> counts{};
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      const float u = random.between(0, 1), v = random.between(0, 1);
      const Vec3 toLight = target.draw(toEye, u, v);
      const double h[] = {double(toLight.x) + toEye.x, double(toLight.y) + toEye.y,
                          double(toLight.z) + toEye.z};
      const double tangent = std::hypot(h[0], h[1]) / h[2] / alpha,
                   ring = (1 - 1 / std::sqrt(1 + tangent * tangent)) * rings;
      const double turn = (std::atan2(h[1], h[0]) / (2 * pi) + 1) * turns;
      ++counts[std::size_t(std::clamp(int(ring), 0, rings - 1) * turns + int(turn) % turns)];
    }
    ChiSquare chiSquare;
    double whole = 0;
    for (int ring = 0; ring < rings; ++ring)
      for (int turn = 0; turn < turns; ++turn) {
        double share = 0;
        overSeenMirrors(alpha, {toEye.x, toEye.y, toEye.z},
                        {double(ring) / rings, double(turn) / turns},
                        {double(ring + 1) / rings, double(turn + 1) / turns}, {24, 24},
                        [&](double part, const Vector &) { share += part; });
        whole += share;
        chiSquare.add(share * samples, counts[std::size_t(ring * turns + turn)]);
      }
    if (std::fabs(whole - 1) > 2e-3)
      worst.wrong(fmt::format("the oracle's density at alpha {}, cosine {} is {} in all", alpha,
                              cosine, whole));
    worst.add(chiSquare.deviation(),
              [&] { return fmt::format("alpha {}, cosine {}", alpha, cosine); });
  }
  Outcome outcome = worst.outcome();
  outcome.cases *= samples;
  return outcome;
}

/// Metal that absorbs nothing, under white surroundings: every sample is within [0, 1], and their
/// mean is what the textbooks' BRDF reflects in all, in standard errors.
Outcome runFurnace(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = furnace(path);
  floor.set(floor.surroundings, "isWhite", {1});
  floor.set(floor.material, "reflectance", {1, 1, 1});
  constexpr std::uint64_t samples = 4'000;
  std::uint32_t number = seed;
  for (std::uint64_t i = 0; i < cases / samples; ++i) {
    const float alpha = i % 4 == 0 ? 1.0f : randomAlpha(random),
                cosine = i % 4 == 1 ? 0.02f : random.between(0.02f, 1);
    floor.set(floor.material, "alpha", {alpha});
    const Incidence ray =
        incidence(cosine, random.integer(0, 1), std::ldexp(1.0f, random.integer(-4, 4)));
    const auto where = [&] { return fmt::format("alpha {}, cosine {}", alpha, cosine); };
    double sum = 0;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      const float seen = floor.look(ray.origin, ray.direction, number++ * 0x9E3779B9u)[0];
      if (!(seen >= 0 && seen <= 1 + 0x1p-21f))
        worst.wrong(where() + fmt::format(": {:a}", seen));
      sum += double(seen);
    }
    // F D G2 / (4 cosine cosine) times the light's cosine, over the directions that the mirrors
    // make of the eye's.
    const Vector eye = {double(sineOf(cosine)), 0, double(cosine)};
    double mean = 0, square = 0;
    overSeenMirrors(
        alpha, eye, {0, 0}, {1, 1}, {400, 400}, [&](double share, const Vector &mirror) {
          const double facing = eye[0] * mirror[0] + eye[1] * mirror[1] + eye[2] * mirror[2];
          const Vector light = {2 * facing * mirror[0] - eye[0], 2 * facing * mirror[1] - eye[1],
                                2 * facing * mirror[2] - eye[2]};
          if (light[2] <= 0)
            return;
          const double seen = lambda<double>(alpha, eye), lit = lambda<double>(alpha, light);
          const double brdf =
              distribution<double>(alpha, mirror) / (4 * light[2] * eye[2] * (1 + seen + lit));
          const double density = distribution<double>(alpha, mirror) / (4 * eye[2] * (1 + seen));
          const double weight = brdf * light[2] / density;
          mean += share * weight;
          square += share * weight * weight;
        });
    // One sample more or less of what hardly ever happens is no error.
    const double variance =
        std::max(square - mean * mean, 0.0) / samples + 1.0 / (double(samples) * samples);
    worst.add(std::fabs(sum / samples - mean) / std::sqrt(variance),
              [&] { return where() + fmt::format(": {} for {}", sum / samples, mean); });
  }
  Outcome outcome = worst.outcome();
  outcome.cases *= samples;
  return outcome;
}

/// Directions of the matte surface, in cells of equal shares: of the square of the sine, and of the
/// turn.
Outcome runMatte(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const Floor &floor = matte(path);
  constexpr int rings = 16, turns = 16, cells = rings * turns;
  std::vector<std::uint64_t> counts(cells);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float u = random.between(0, 1), v = random.between(0, 1);
    floor.set(floor.material, "seed", {u, v});
    const std::array<float, 3> d = floor.look({0, 1, 0}, {0, -1, 0});
    const double across = double(d[0]) * d[0] + double(d[1]) * d[1],
                 turn = (std::atan2(double(d[1]), double(d[0])) / (2 * pi) + 1) * turns;
    if (!(std::fabs(across + double(d[2]) * d[2] - 1) < 1e-6) || !(d[2] >= 0))
      worst.wrong(fmt::format("seed {:a} {:a}", u, v));
    ++counts[std::size_t(std::clamp(int(across * rings), 0, rings - 1) * turns +
                         int(turn) % turns)];
  }
  worst.add(ChiSquare::ofEqualShares(counts), [&] { return fmt::format("{} cells", cells); });
  Outcome outcome = worst.outcome();
  outcome.cases = cases;
  return outcome;
}

double nanosecondsAValue(Path path) {
  constexpr int count = 100'000;
  Metal &target = metal(path);
  target.polish(0.1f, {1, 1, 1});
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += target.density({0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f});
    return sum;
  });
}

} // namespace

std::vector<Row> metalRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAValue);
  return {
      row("metal.values",
          "rough metal of alpha 1e-3 to 1, near the mirror's direction and anywhere, at cosines of "
          "0, 1, -1 and from 2^-40: BRDF and density",
          "rounding units", 200'000, runValues),
      row("metal.reciprocity", "the BRDF with light and eye exchanged: the difference",
          "rounding units", 200'000, runReciprocity),
      row("metal.weights",
          "the weights of directions that are drawn, at cosines of 0 to 1: value * cosine / "
          "density",
          "rounding units", 200'000, runWeights),
      row("metal.methods",
          "sampleBSDF, BSDF and evaluatePDF as a host calls them, on surfaces in any position: "
          "value * cosine / density",
          "rounding units (1 + 1 / (alpha * half vector)) / cosine", 200'000, runMethods),
      row("metal.directions",
          "the directions themselves, of mirrors that an eye sees: chi-square over 160 cells, for "
          "many alphas and cosines",
          "standard deviations", 5'000'000, runDirections),
      row("metal.furnace",
          "path-traced metal in a white furnace: samples in [0, 1], and their mean against the "
          "integral of the BRDF, for many alphas and cosines",
          "standard errors", 2'000'000, runFurnace),
      row("metal.matte",
          "the directions that the matte surface draws: chi-square over 256 cells of equal shares",
          "standard deviations", 2'000'000, runMatte),
  };
}

} // namespace rtsl::numerics
