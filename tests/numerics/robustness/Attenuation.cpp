//===- Attenuation.cpp - light through media, thin and thick --------------===//
#include "CompiledShaders.h"
#include "Generators.h"
#include "HighPrecision.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::numerics {

namespace {

constexpr int layerCount = 16;
struct Layer {
  float sigma = 0, length = 0;
  Precise depth() const { return Precise(sigma) * Precise(length); }
};
using Stack = std::array<Layer, layerCount>;

/// The shader's result for a stack.
struct Transmittances {
  float first, product, atOnce;
};

class Layers {
public:
  explicit Layers(Path path)
      : shaders({"tests/numerics/robustness/shaders/Layers.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Layers", "Probe"}, {}, path),
        object(shaders.scene().addObject("Layers")) {
    shaders.scene().setCamera(shaders.scene().addObject("Probe"));
    shaders.scene().setBackground(object);
    shaders.finish();
    sigmas = shaders.member(object, "sigmas");
    lengths = shaders.member(object, "lengths");
  }

  Transmittances operator()(const Stack &stack) const {
    for (int i = 0; i < layerCount; ++i) {
      sigmas[i] = stack[std::size_t(i)].sigma;
      lengths[i] = stack[std::size_t(i)].length;
    }
    const std::array<float, 3> color = shaders.look();
    return {color[0], color[1], color[2]};
  }

private:
  CompiledShaders shaders;
  RtslRef object;
  float *sigmas, *lengths;
};

const Layers &layers(Path path) {
  static const Layers only(path);
  return only;
}

float powerOfTen(Random &random, float low, float high) {
  return std::pow(10.0f, random.between(low, high));
}

/// Coefficients from 1e-8 to 1e8 over lengths from 1e-6 to 1e6. Nearly all such pairs are clear or
/// black, so that of three in four the length is chosen to leave something.
Layer randomLayer(Random &random) {
  Layer layer{powerOfTen(random, -8, 8), powerOfTen(random, -6, 6)};
  if (random.integer(0, 3))
    layer.length = std::clamp(powerOfTen(random, -10, 1.5f) / layer.sigma, 1e-6f, 1e6f);
  return layer;
}

/// One to sixteen layers; the rest is empty.
Stack randomStack(Random &random, Precise &depth) {
  Stack stack;
  depth = 0;
  const int count = random.integer(1, layerCount);
  for (int i = 0; i < count; ++i) {
    stack[std::size_t(i)] = randomLayer(random);
    depth += stack[std::size_t(i)].depth();
  }
  return stack;
}

std::string show(const Stack &stack) {
  std::string text;
  for (const Layer &layer : stack)
    if (layer.sigma != 0)
      text += fmt::format("{}{:a} over {:a}", text.empty() ? "" : ", ", layer.sigma, layer.length);
  return text;
}

/// A transmittance against the exact one. A relative error in the exponent is an error of that many
/// times the depth in the result, so the unit is a rounding unit of the result times 1 + depth.
/// Outside [0, 1] nothing is right.
double errorOf(float value, const Precise &depth) {
  if (!(value >= 0 && value <= 1))
    return std::numeric_limits<double>::infinity();
  return roundingUnits(value, exp(-depth)) / (1 + static_cast<double>(depth));
}

Outcome runSingle(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Stack stack;
    stack[0] = randomLayer(random);
    worst.add(errorOf(layers(path)(stack).first, stack[0].depth()), [&] { return show(stack); });
  }
  return worst.outcome();
}

Outcome runProduct(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Precise depth;
    const Stack stack = randomStack(random, depth);
    worst.add(errorOf(layers(path)(stack).product, depth), [&] { return show(stack); });
  }
  return worst.outcome();
}

Outcome runAtOnce(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Precise depth;
    const Stack stack = randomStack(random, depth);
    worst.add(errorOf(layers(path)(stack).atOnce, depth), [&] { return show(stack); });
  }
  return worst.outcome();
}

/// The same layers in another order.
Outcome runOrder(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Precise depth;
    Stack stack = randomStack(random, depth);
    const float first = layers(path)(stack).product;
    for (int k = layerCount - 1; k > 0; --k)
      std::swap(stack[std::size_t(k)], stack[std::size_t(random.integer(0, k))]);
    worst.add(roundingUnits(layers(path)(stack).product, Precise(first)),
              [&] { return show(stack); });
  }
  return worst.outcome();
}

/// Of thin media: what a row sets, and constants.
class ThinMedia {
public:
  ThinMedia(Path path, const char *className)
      : shaders({"tests/numerics/robustness/shaders/Thin.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Thin", "ThinConstants", "Probe"}, {}, path),
        object(shaders.scene().addObject(className)) {
    shaders.scene().setCamera(shaders.scene().addObject("Probe"));
    shaders.scene().setBackground(object);
    shaders.finish();
  }
  std::array<float, 3> with(const char *first, float a, const char *second, float b) const {
    shaders.set(object, first, {a});
    shaders.set(object, second, {b});
    return shaders.look();
  }

private:
  CompiledShaders shaders;
  RtslRef object;
};

const ThinMedia &thinMedia(Path path) {
  static const ThinMedia only(path, "Thin");
  return only;
}
const ThinMedia &thinConstants(Path path) {
  static const ThinMedia only(path, "ThinConstants");
  return only;
}

Precise meanTransmittance(const Precise &depth) {
  return -expm1(-depth) / depth;
}

/// The mean transmittance up to a depth of 1e-8 to 1e2: by expm1 and, in double, as it is often
/// written.
Outcome runThin(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Layer layer = {powerOfTen(random, -4, 1), powerOfTen(random, -4, 1)};
    const std::array<float, 3> seen =
        thinMedia(path).with("sigma", layer.sigma, "length", layer.length);
    const Precise exact = meanTransmittance(layer.depth());
    const double error = roundingUnits(seen[0], exact),
                 naive = path == Path::Double ? roundingUnits(seen[1], exact) : 0;
    worst.add(std::max(error, naive),
              [&] { return fmt::format("{:a} over {:a}", layer.sigma, layer.length); });
  }
  return worst.outcome();
}

/// What the compiler has computed of constants, against what the same arithmetic gives when it
/// runs; in double also against the exact value. Constants are strict in fast mode too, so that
/// there only depths count at which nothing cancels.
Outcome runThinConstants(Path path, std::uint64_t cases, std::uint32_t) {
  Worst worst;
  for (std::uint64_t i = path == Path::Fast ? 5 : 0; i < std::min<std::uint64_t>(cases, 8); ++i) {
    const std::array<float, 3> seen = thinConstants(path).with("which", float(i), "hidden", 0);
    const double error = roundingUnits(seen[0], Precise(seen[1]));
    const double exact =
        path == Path::Double ? roundingUnits(seen[0], meanTransmittance(Precise(seen[2]))) : 0;
    worst.add(std::max(error, exact), [&] { return fmt::format("depth {:a}", seen[2]); });
  }
  return worst.outcome();
}

double nanosecondsAStack(Path path) {
  constexpr int count = 100'000;
  Random random(1);
  Precise depth;
  const Stack stack = randomStack(random, depth);
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += layers(path)(stack).product;
    return sum;
  });
}

} // namespace

std::vector<Row> attenuationRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAStack);
  const char *unit = "rounding units times 1 + optical depth";
  return {
      row("attenuation.single", "exp(-sigma t), sigma from 1e-8 to 1e8, t from 1e-6 to 1e6", unit,
          500'000, runSingle),
      row("attenuation.layers", "up to 16 such layers, one after the other", unit, 500'000,
          runProduct),
      row("attenuation.atOnce", "the same by the sum of their depths", unit, 500'000, runAtOnce),
      row("attenuation.thin",
          "(1 - exp(-depth)) / depth by expm1, depths of 1e-8 to 100; in double also as it stands",
          "rounding units", 500'000, runThin),
      row("attenuation.constants",
          "the same of constants, which the compiler computes: the difference from what it is when "
          "it runs",
          "rounding units", 8, runThinConstants),
      row("attenuation.order", "the same layers in another order: the difference", "rounding units",
          500'000, runOrder),
  };
}

} // namespace rtsl::numerics
