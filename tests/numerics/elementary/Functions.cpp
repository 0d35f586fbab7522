#include "Functions.h"

#include "math/Elementary.h"
#include "math/Fast.h"
#include "math/PowerLanes.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace rtsl::elementary {

namespace {

float systemInverseSquareRoot(float x) {
  return 1.0f / std::sqrt(x);
}
double systemInverseSquareRootDouble(double x) {
  return 1.0 / std::sqrt(x);
}

// The C library has none of pi x yet. All steps but the product with pi and the last are exact.
constexpr double pi = 3.14159265358979323846;

double systemSineOfPiDouble(double x) {
  double turn = std::remainder(x, 2.0);
  if (std::fabs(turn) > 0.5)
    turn = std::copysign(1.0, turn) - turn;
  return turn == 0.0 ? std::copysign(0.0, x) : std::sin(pi * turn);
}
double systemCosineOfPiDouble(double x) {
  const double turn = std::fabs(std::remainder(x, 2.0));
  if (turn > 0.75)
    return -std::cos(pi * (1.0 - turn));
  return turn < 0.25 ? std::cos(pi * turn) : std::sin(pi * (0.5 - turn));
}
float systemSineOfPi(float x) {
  return std::sin(static_cast<float>(pi) * x);
}
float systemCosineOfPi(float x) {
  return std::cos(static_cast<float>(pi) * x);
}

float powerInLane(float x, float y) {
  std::uint32_t hash = (device::detail::bitsOf(x) ^ device::detail::bitsOf(y)) * 0x9e3779b9u;
  alignas(16) float bases[4] = {0.3f, 0.97f, 7.0f, 1.0f}, exponents[4] = {2.5f, 11.0f, -0.5f, 1.0f};
  if (hash >> 30 == 0) // all lanes go the careful way
    bases[hash >> 26 & 3] = hash >> 25 & 1 ? 0.0f : -2.0f;
  std::uint32_t lane = hash >> 28 & 3;
  bases[lane] = x;
  exponents[lane] = y;
  _mm_store_ps(bases, device::pow(_mm_load_ps(bases), _mm_load_ps(exponents)));
  return bases[lane];
}

double boundOfFastPower(float x, float y) {
  // Elsewhere it is the strict function.
  bool isApproximate = x > 0.0f && std::isfinite(x) && std::isfinite(y);
  double exponent = y * std::log2(static_cast<double>(x));
  return isApproximate ? 0x1p-21 * (1.0 + std::fabs(exponent)) : 0x1p-23;
}

double boundOfFastAngle(float, float) {
  return 0x1p-21;
}

} // namespace

#define UNARY(name, low, high) {#name, device::name, ::name##f, ::name, mpfr_##name, low, high}

const std::vector<Unary> &unaryFunctions() {
  static const std::vector<Unary> functions = {
      UNARY(sin, -6.0f, 6.0f),
      UNARY(cos, -6.0f, 6.0f),
      UNARY(tan, -6.0f, 6.0f),
      {"sinpi", device::sinpi, systemSineOfPi, systemSineOfPiDouble, mpfr_sinpi, -2.0f, 2.0f},
      {"cospi", device::cospi, systemCosineOfPi, systemCosineOfPiDouble, mpfr_cospi, -2.0f, 2.0f},
      UNARY(asin, -1.0f, 1.0f),
      UNARY(acos, -1.0f, 1.0f),
      UNARY(atan, -8.0f, 8.0f),
      UNARY(sinh, -8.0f, 8.0f),
      UNARY(cosh, -8.0f, 8.0f),
      UNARY(tanh, -4.0f, 4.0f),
      UNARY(asinh, -8.0f, 8.0f),
      UNARY(acosh, 1.0f, 8.0f),
      UNARY(atanh, -1.0f, 1.0f),
      UNARY(exp, -8.0f, 8.0f),
      UNARY(exp2, -8.0f, 8.0f),
      UNARY(expm1, -8.0f, 8.0f),
      UNARY(log, 0.0f, 100.0f),
      UNARY(log2, 0.0f, 100.0f),
      UNARY(log1p, 0.0f, 100.0f),
      {"inversesqrt", device::inversesqrt, systemInverseSquareRoot, systemInverseSquareRootDouble,
       mpfr_rec_sqrt, 0.0f, 100.0f},
      UNARY(sqrt, 0.0f, 100.0f),
  };
  return functions;
}

const std::vector<Binary> &binaryFunctions() {
  static const std::vector<Binary> functions = {
      {"pow", device::pow, ::powf, ::pow, mpfr_pow, 0.0f, 8.0f},
      {"atan2", device::atan2, ::atan2f, ::atan2, mpfr_atan2, -8.0f, 8.0f},
  };
  return functions;
}

const std::vector<Binary> &laneFunctions() {
  static const std::vector<Binary> functions = {
      {"pow4", powerInLane, ::powf, ::pow, mpfr_pow, 0.0f, 8.0f},
  };
  return functions;
}

#define FAST(name, low, high, bound)                                                               \
  {"fast." #name, device::fast::name, ::name##f, ::name, mpfr_##name, low, high, bound}

const std::vector<Unary> &fastUnaryFunctions() {
  static const std::vector<Unary> functions = {
      FAST(sin, -6.0f, 6.0f, 0x1p-22),
      FAST(cos, -6.0f, 6.0f, 0x1p-22),
      FAST(tan, -6.0f, 6.0f, 0x1p-21),
      {"fast.sinpi", device::fast::sinpi, systemSineOfPi, systemSineOfPiDouble, mpfr_sinpi, -2.0f,
       2.0f, 0x1p-22},
      {"fast.cospi", device::fast::cospi, systemCosineOfPi, systemCosineOfPiDouble, mpfr_cospi,
       -2.0f, 2.0f, 0x1p-22},
      FAST(asin, -1.0f, 1.0f, 0x1p-21),
      FAST(acos, -1.0f, 1.0f, 0x1p-21),
      FAST(atan, -8.0f, 8.0f, 0x1p-22),
      FAST(exp, -8.0f, 8.0f, 0x1p-23),
      FAST(exp2, -8.0f, 8.0f, 0x1p-23),
      FAST(log, 0.0f, 100.0f, 0x1p-22),
      FAST(log2, 0.0f, 100.0f, 0x1p-22),
      {"fast.inversesqrt", device::fast::inversesqrt, systemInverseSquareRoot,
       systemInverseSquareRootDouble, mpfr_rec_sqrt, 0.0f, 100.0f, 0x1p-23},
  };
  return functions;
}

const std::vector<Binary> &fastBinaryFunctions() {
  static const std::vector<Binary> functions = {
      {"fast.pow", device::fast::pow, ::powf, ::pow, mpfr_pow, 0.0f, 8.0f, boundOfFastPower},
      {"fast.atan2", device::fast::atan2, ::atan2f, ::atan2, mpfr_atan2, -8.0f, 8.0f,
       boundOfFastAngle},
  };
  return functions;
}

} // namespace rtsl::elementary
