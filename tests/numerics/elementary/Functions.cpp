#include "Functions.h"

#include "runtime/device/math/Elementary.h"

#include <cmath>

namespace rtsl::elementary {

namespace {

float systemInverseSquareRoot(float x) {
  return 1.0f / std::sqrt(x);
}
double systemInverseSquareRootDouble(double x) {
  return 1.0 / std::sqrt(x);
}

} // namespace

#define UNARY(name, low, high)                                                                     \
  { #name, device::name, ::name##f, ::name, mpfr_##name, low, high }

const std::vector<Unary> &unaryFunctions() {
  static const std::vector<Unary> functions = {
      UNARY(sin, -6.0f, 6.0f),
      UNARY(cos, -6.0f, 6.0f),
      UNARY(tan, -6.0f, 6.0f),
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

} // namespace rtsl::elementary
