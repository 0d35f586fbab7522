#include "Oracle.h"

#include <cmath>

namespace rtsl::elementary {

namespace {

constexpr double decisive = 0x1p-42;
constexpr mpfr_exp_t smallestExponent = -148; // binary32's subnormal numbers, in MPFR's convention

} // namespace

Oracle::Oracle() {
  mpfr_set_emin(smallestExponent);
  mpfr_set_emax(128);
  mpfr_inits2(24, first, second, result, static_cast<mpfr_ptr>(nullptr));
  mpfr_init2(precise, 200);
  mpfr_init2(midpoint, 25);
}

Oracle::~Oracle() {
  mpfr_clears(first, second, result, precise, midpoint, static_cast<mpfr_ptr>(nullptr));
}

double Oracle::distanceToMidpoint(const Unary &function, float x) {
  mpfr_set_emin(-1000); // the distance may be far below the floats
  mpfr_set_flt(first, x, MPFR_RNDN);
  function.exact(precise, first, MPFR_RNDN);
  mpfr_abs(precise, precise, MPFR_RNDN);
  mpfr_set(result, precise, MPFR_RNDZ); // the float below, and half a unit of its last place
  mpfr_set(midpoint, result, MPFR_RNDN);
  mpfr_nextabove(midpoint);
  double magnitude = mpfr_get_d(precise, MPFR_RNDN);
  mpfr_sub(precise, precise, midpoint, MPFR_RNDN);
  double distance = std::fabs(mpfr_get_d(precise, MPFR_RNDN));
  mpfr_set_emin(smallestExponent);
  return distance / magnitude;
}

template <typename Evaluate>
Oracle::Answer Oracle::round(double approximation, Evaluate evaluate) {
  if (std::isnan(approximation))
    return {__builtin_bit_cast(float, 0x7fc00000u), approximation};
  float below = static_cast<float>(approximation * (1.0 - decisive));
  float above = static_cast<float>(approximation * (1.0 + decisive));
  if (below == above)
    return {above, approximation};
  ++asked;
  int ternary = evaluate();
  mpfr_subnormalize(result, ternary, MPFR_RNDN);
  return {mpfr_get_flt(result, MPFR_RNDN), approximation};
}

Oracle::Answer Oracle::operator()(const Unary &function, float x) {
  return round(function.systemDouble(x), [&] {
    mpfr_set_flt(first, x, MPFR_RNDN);
    return function.exact(result, first, MPFR_RNDN);
  });
}

Oracle::Answer Oracle::operator()(const Binary &function, float x, float y) {
  return round(function.systemDouble(x, y), [&] {
    mpfr_set_flt(first, x, MPFR_RNDN);
    mpfr_set_flt(second, y, MPFR_RNDN);
    return function.exact(result, first, second, MPFR_RNDN);
  });
}

} // namespace rtsl::elementary
