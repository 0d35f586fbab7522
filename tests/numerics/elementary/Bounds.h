// Measures the error of the two paths of pow and atan2 against MPFR.
#pragma once

#include <cstdint>
#include <string_view>

namespace rtsl::elementary {

/// The largest relative errors found over `count` pairs, as binary logarithms, and the bounds that
/// the rounding test uses and the documentation states.
struct MeasuredBounds {
  double fast, fastBound;
  double accurate, accurateBound;
  std::uint64_t measured;
  bool hold() const { return fast < fastBound && accurate < accurateBound; }
};

MeasuredBounds measureBounds(std::string_view function, std::uint64_t count);

} // namespace rtsl::elementary
