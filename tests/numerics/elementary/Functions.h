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
  float low, high;    ///< a usual range of arguments, for timing
  double bound = 0.0; ///< of the relative error; 0: correctly rounded
};

/// A function of two arguments; atan2 takes (y, x).
struct Binary {
  const char *name;
  float (*ours)(float, float);
  float (*system)(float, float);
  double (*systemDouble)(double, double);
  int (*exact)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);
  float low, high;
  double (*bound)(float, float) = nullptr; ///< of the relative error; null: correctly rounded
};

const std::vector<Unary> &unaryFunctions();
const std::vector<Binary> &binaryFunctions();

/// pow with the pair in one of four lanes, beside others of which now and then one is special.
const std::vector<Binary> &laneFunctions();

/// The approximations of Fast.h, named `fast.sin` and so on.
const std::vector<Unary> &fastUnaryFunctions();
const std::vector<Binary> &fastBinaryFunctions();

} // namespace rtsl::elementary
