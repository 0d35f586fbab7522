//===- ErrorMetrics.h - the error of a picture against a reference --------===//
#pragma once

#include "runtime/image/Image.h"

#include <cstddef>

namespace rtsl::report {

/// Added to the squared reference in relMSE, so that black pixels do not dominate it (F. Rousselle,
/// C. Knaus, M. Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error Minimization",
/// 2011).
constexpr double relMseEpsilon = 1e-2;

/// Errors over all channels of the pixels in which both pictures are finite; 0 if there is none.
struct ErrorMetrics {
  double rmse = 0;                  // root of the mean of (test - reference)^2
  double relMse = 0;                // mean of (test - reference)^2 / (reference^2 + relMseEpsilon)
  double bias = 0;                  // mean of test - reference
  double largest = 0;               // |test - reference|
  std::size_t pixels = 0;           // finite in both
  std::size_t pixelsThatDiffer = 0; // some channel has different bits
  std::size_t incomparable = 0;     // of those, the ones that are not finite in either picture
  std::size_t nanPixels = 0, infinitePixels = 0; // of the test picture
};

/// Sums in double, in a fixed order. Throws BadImage if the shapes differ.
ErrorMetrics measureError(const runtime::Image &reference, const runtime::Image &test);

/// (test - reference)^2 / (reference^2 + relMseEpsilon), one value a pixel: the mean over its
/// channels.
runtime::Image relativeSquaredErrorMap(const runtime::Image &reference, const runtime::Image &test);

} // namespace rtsl::report
