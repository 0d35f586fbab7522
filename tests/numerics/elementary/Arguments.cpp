#include "Arguments.h"

#include "HardArguments.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace rtsl::elementary {

namespace {

/// A stream of random numbers that depends on its seed alone (Steele, Lea, Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA 2014).
class Random {
public:
  explicit Random(std::uint64_t seed) : state(seed * 0x9e3779b97f4a7c15u) {}

  std::uint64_t bits() {
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>((bits() >> 32) * bound >> 32);
  }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  float anyFloat() { return floatOf(static_cast<std::uint32_t>(bits())); }
  float sign() { return (bits() & 1) != 0 ? 1.0f : -1.0f; }
  float special() {
    const std::vector<float> &all = specialArguments();
    return all[below(static_cast<std::uint32_t>(all.size()))];
  }

private:
  std::uint64_t state;
};

// ---- pow

/// y such that x^y = 2^exponent, roughly.
float powerFor(float x, double exponent) {
  return static_cast<float>(exponent / std::log2(static_cast<double>(x)));
}

Pair exactPowerArguments(Random &random) {
  // m^(2^j) to the power n / 2^j is m^n, which has 25 bits or a few more.
  int roots = static_cast<int>(random.below(4));
  std::uint32_t largest = 1u << (24 >> roots);
  double m = random.below(std::min(largest, 8192u)) | 1;
  double x = std::ldexp(std::pow(m, 1 << roots), static_cast<int>(random.below(8) << roots) - 32);
  double y = std::ldexp(1 + random.below(16), -roots);
  return {static_cast<float>(x), static_cast<float>(random.below(8) == 0 ? -y : y)};
}

Pair nearMidpointPowerArguments(Random &random) {
  // The result is to be c = 1 + k 2^-24 with odd k, midway between floats. Rounding y moves it by
  // only 2^-25 |ln c|.
  double k = random.below(1u << random.below(12)) | 1;
  double logarithm = std::log1p((random.sign() > 0 ? k * 0x1p-24 : -k * 0x1p-25));
  float x = static_cast<float>(std::exp2(random.between(-100.0, 100.0)));
  return {x, static_cast<float>(logarithm / std::log(static_cast<double>(x)))};
}

Pair powerArguments(Random &random) {
  float positive = std::fabs(random.anyFloat());
  float nearOne = floatOf(bitsOf(1.0f) + random.below(1u << random.below(20)) -
                          random.below(1u << random.below(20)));
  switch (random.below(9)) {
  case 0:
    return {random.anyFloat(), random.anyFloat()};
  case 1:
    return {positive, powerFor(positive, random.between(-151.0, 129.0))};
  case 2:
    return {nearOne, powerFor(nearOne, random.between(-151.0, 129.0))};
  case 3:
    return exactPowerArguments(random);
  case 4: // integers and halves
    return {random.anyFloat(), 0.5f * static_cast<float>(static_cast<int>(random.below(65)) - 32)};
  case 5: // subnormal results, and those near the largest float
    return {positive, powerFor(positive, random.below(2) != 0 ? random.between(-150.1, -125.9)
                                                              : random.between(127.9, 128.1))};
  case 6:
    return {static_cast<float>(random.between(0.0, 16.0)),
            static_cast<float>(random.between(-8.0, 8.0))};
  case 7:
    return nearMidpointPowerArguments(random);
  default:
    return {random.special(), random.special()};
  }
}

// ---- atan2

Pair nearMidpointAngleArguments(Random &random) {
  // A convergent p/q of the continued fraction of tan(c), c midway between floats, differs from
  // tan(c) by less than 1/q^2.
  float angle = static_cast<float>(std::exp2(random.between(-20.0, 0.65)));
  long double midpoint = (static_cast<long double>(angle) + std::nextafter(angle, 4.0f)) * 0.5L;
  long double rest = std::tan(midpoint);
  long double p = 1, q = 0, previousP = 0, previousQ = 1;
  for (;;) {
    long double digit = std::floor(rest);
    long double nextP = digit * p + previousP, nextQ = digit * q + previousQ;
    if (nextP >= 0x1p24L || nextQ >= 0x1p24L)
      break;
    previousP = p, previousQ = q, p = nextP, q = nextQ;
    if (rest == digit)
      break;
    rest = 1 / (rest - digit);
  }
  int scale = static_cast<int>(random.below(200)) - 110;
  return {random.sign() * static_cast<float>(std::ldexp(p, scale)),
          static_cast<float>(std::ldexp(q, scale))};
}

Pair angleArguments(Random &random) {
  float x = random.anyFloat();
  switch (random.below(8)) {
  case 0:
    return {random.anyFloat(), x};
  case 1: // quotients of any size
    return {static_cast<float>(x * std::exp2(random.between(-30.0, 30.0))), x};
  case 2: // near the lines where the method changes: y/x = i/16 + 1/32, and the diagonal
    return {static_cast<float>(x * ((random.below(17) + 0.5 * random.below(2)) / 16.0 +
                                    random.between(-1.0, 1.0) * 0x1p-20)),
            x};
  case 3: { // tiny quotients with few bits: midpoints among the subnormal floats
    float y = std::ldexp(static_cast<float>(random.below(1u << random.below(24))), -149);
    float power = std::ldexp(static_cast<float>(1 + random.below(1u << random.below(12))),
                             static_cast<int>(random.below(30)) - 10);
    return {random.sign() * y, random.sign() * power};
  }
  case 4: // far from an axis by no more than the axis is thick
    return {x, static_cast<float>(x * std::exp2(random.between(-30.0, -20.0)))};
  case 5:
    return nearMidpointAngleArguments(random);
  case 6:
    return {random.special(), random.special()};
  default:
    return {static_cast<float>(random.between(-1.0, 1.0)),
            static_cast<float>(random.between(-1.0, 1.0))};
  }
}

} // namespace

const std::vector<float> &specialArguments() {
  static const std::vector<float> all = [] {
    std::vector<float> found;
    auto addWithNeighbours = [&](float x) {
      for (int step = -2; step <= 2; ++step)
        for (std::uint32_t sign : {0u, 0x80000000u})
          found.push_back(floatOf((bitsOf(x) + static_cast<std::uint32_t>(step)) ^ sign));
    };
    for (int exponent = -149; exponent <= 127; ++exponent)
      addWithNeighbours(std::ldexp(1.0f, exponent));
    for (std::uint32_t bits : {0x00000002u, 0x7f800000u, 0x7fc00000u, 0x7fffffffu, 0x7f800001u})
      addWithNeighbours(floatOf(bits));
    for (float x : {0.7853982f, 1.5707964f,  3.1415927f, 9.1f,   17.32868f,  18.0f,  24.95f,
                    88.72284f,  89.0f,       89.41599f,  90.0f,  103.97208f, 104.0f, 126.0f,
                    149.0f,     150.0f,      0.6875f,    1.375f, 0.5f,       3.0f,   1.5f,
                    0.8660254f, 0.70710677f, 10.0f,      1e10f,  0.1f})
      addWithNeighbours(x);
    return found;
  }();
  return all;
}

const std::vector<float> &hardArguments(std::string_view function) {
  static const auto all = [] {
    std::map<std::string_view, std::vector<float>> found;
    for (const auto &[name, bits] : hardArgumentBits)
      for (std::uint32_t argument : bits)
        found[name].push_back(floatOf(argument));
    return found;
  }();
  static const std::vector<float> none;
  auto found = all.find(function);
  return found == all.end() ? none : found->second;
}

Pair argumentPair(std::string_view function, std::uint64_t index) {
  Random random(index);
  bool isPower = function.find("pow") != std::string_view::npos; // fast.pow and pow4, too
  return isPower ? powerArguments(random) : angleArguments(random);
}

} // namespace rtsl::elementary
