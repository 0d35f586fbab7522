// The correctly rounded result, independent of the code under test.
#pragma once

#include "Functions.h"

#include <cstdint>

namespace rtsl::elementary {

/// Rounds function values correctly: with the C library in double where that decides, with MPFR
/// where it does not. One oracle a thread (MPFR keeps its exponent range per thread).
///
/// "Decides" leaves the C library an error of 2^-42, more than 500 of its last places; glibc states
/// errors of at most 3 for the functions used here.
class Oracle {
public:
  Oracle();
  ~Oracle();
  Oracle(const Oracle &) = delete;
  Oracle &operator=(const Oracle &) = delete;

  struct Answer {
    float rounded; ///< a NaN is the canonical one
    double unrounded;
  };
  Answer operator()(const Unary &function, float x);
  Answer operator()(const Binary &function, float x, float y);

  /// How far f(x) lies from the nearest point midway between two floats, relative to f(x). For
  /// results that are normal floats.
  double distanceToMidpoint(const Unary &function, float x);

  /// How often MPFR was called.
  std::uint64_t timesAsked() const { return asked; }

private:
  template <typename Evaluate>
  Answer round(double approximation, Evaluate evaluate);

  mpfr_t first, second, result;
  mpfr_t precise, midpoint;
  std::uint64_t asked = 0;
};

} // namespace rtsl::elementary
