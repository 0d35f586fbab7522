#include "Bounds.h"

#include "Arguments.h"

#include "math/Elementary.h"

#include <mpfr.h>

#include <algorithm>
#include <cmath>

namespace rtsl::elementary {

namespace {

using device::detail::Double2;

class Ruler {
public:
  Ruler() { mpfr_inits2(300, first, second, exact, difference, static_cast<mpfr_ptr>(nullptr)); }
  ~Ruler() { mpfr_clears(first, second, exact, difference, static_cast<mpfr_ptr>(nullptr)); }
  Ruler(const Ruler &) = delete;
  Ruler &operator=(const Ruler &) = delete;

  template <typename Function>
  void setExact(Function function, double x, double y) {
    mpfr_set_d(first, x, MPFR_RNDN);
    mpfr_set_d(second, y, MPFR_RNDN);
    function(exact, first, second, MPFR_RNDN);
  }

  double relativeError(Double2 y) {
    mpfr_set_d(difference, y.hi, MPFR_RNDN);
    mpfr_add_d(difference, difference, y.lo, MPFR_RNDN);
    mpfr_sub(difference, difference, exact, MPFR_RNDN);
    mpfr_div(difference, difference, exact, MPFR_RNDN);
    return std::fabs(mpfr_get_d(difference, MPFR_RNDN));
  }

private:
  mpfr_t first, second, exact, difference;
};

/// Whether positivePower() goes past its checks for overflow and underflow.
bool isMeasurablePower(float x, float y) {
  if (!(x > 0.0f && std::isfinite(x) && std::isfinite(y)))
    return false;
  double exponent = y * std::log(static_cast<double>(x));
  return exponent < 89.0 && exponent > -104.0;
}

/// Whether roundedAngle() goes past the tiny quotients.
bool isMeasurableAngle(float y, float x) {
  if (!(std::isfinite(x) && std::isfinite(y)) || y == 0.0f)
    return false;
  return x < 0.0f || std::fabs(y) >= x * 0x1p-27f;
}

} // namespace

MeasuredBounds measureBounds(std::string_view function, std::uint64_t count) {
  namespace detail = device::detail;
  Ruler ruler;
  double fast = 0.0, accurate = 0.0;
  std::uint64_t measured = 0;
  bool isPower = function == "pow";
  for (std::uint64_t i = 0; i < count; ++i) {
    Pair pair = argumentPair(function, i);
    float x = pair.first, y = pair.second;
    if (isPower ? !isMeasurablePower(x, y) : !isMeasurableAngle(x, y))
      continue;
    ++measured;
    if (isPower) {
      ruler.setExact(mpfr_pow, x, y);
      double power = detail::plainExponential(detail::exponentOfPower(x, y));
      fast = std::max(fast, ruler.relativeError({power, 0.0}));
      accurate = std::max(accurate, ruler.relativeError(detail::accuratePower(x, y)));
    } else {
      double height = std::fabs(x), width = std::fabs(y);
      ruler.setExact(mpfr_atan2, height, y);
      fast = std::max(fast, ruler.relativeError(detail::fastAngle(height, width, y < 0.0f)));
      accurate =
          std::max(accurate, ruler.relativeError(detail::accurateAngle(height, width, y < 0.0f)));
    }
  }
  double fastBound = isPower ? detail::plainBound : detail::arcTangent2Bound;
  return {std::log2(fast), std::log2(fastBound), std::log2(accurate), -90.0, measured};
}

} // namespace rtsl::elementary
