// Runs a function over many arguments and compares every result with the oracle.
#pragma once

#include "Functions.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rtsl::elementary {

struct Mismatch {
  std::vector<float> arguments;
  float result, right;
  double error; ///< in units of the last place of `right`
};

/// An argument whose result is hard to round.
struct HardArgument {
  double distance; ///< of the result to a midpoint between floats, relative
  float argument;
};

struct Report {
  std::string function;
  std::uint64_t tested = 0, mismatches = 0, askedMpfr = 0;
  double worstRelativeError = 0.0; ///< with the smallest normal float for the smallest result
  double worstError = 0.0; ///< largest distance from the exact value, in units of the last place
  Mismatch worst;          ///< the mismatch with the largest error, if there is one
  std::vector<Mismatch> first;       ///< the first few mismatches
  std::vector<HardArgument> hardest; ///< in the order of their distance
  double seconds = 0.0;
};

struct SweepOptions {
  std::uint64_t step = 1; ///< every how manieth of the 2^32 arguments (or pairs)
  unsigned threads = 1;
  std::size_t hardest =
      0; ///< how many of the hardest arguments to collect (one-argument functions)
  bool testSystem = false; ///< test the C library instead of our code
  std::function<void(double)> progress = [](double) {};
};

/// All floats with bit patterns 0, step, 2 step, ... and the special arguments.
Report sweep(const Unary &function, const SweepOptions &options);

/// 2^32 / step pairs from argumentPair(), and all pairs of special values that matter.
Report sweep(const Binary &function, const SweepOptions &options);

} // namespace rtsl::elementary
