// The functions under test, each with what it is compared to.
#pragma once

#include <mpfr.h>

#include <string_view>
#include <vector>

namespace rtsl::elementary {

/// A function of one argument.
struct Unary {
  const char *name;
  float (*ours)(float);
  float (*system)(float);         ///< the C library in single precision
  double (*systemDouble)(double); ///< the C library in double: right to 2^-45 or better
  int (*exact)(mpfr_t, const mpfr_t, mpfr_rnd_t);
  float low, high; ///< a usual range of arguments, for timing
};

/// A function of two arguments; atan2 takes (y, x).
struct Binary {
  const char *name;
  float (*ours)(float, float);
  float (*system)(float, float);
  double (*systemDouble)(double, double);
  int (*exact)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);
  float low, high;
};

const std::vector<Unary> &unaryFunctions();
const std::vector<Binary> &binaryFunctions();

} // namespace rtsl::elementary
