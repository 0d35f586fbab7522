//===- Adaptive.h - samples where the picture needs them ------------------===//
//
// The samples of a pixel are in two independent halves, which take turns. What one half has seen
// decides how many samples of the other one the picture shows: a pixel's number of samples and
// their values have then nothing to do with each other, and its mean is right on average. Stopping
// when a pixel's own samples look alike would make pictures too dark, because pixels stop early
// when they have not met their rare bright samples yet (Kirk and Arvo, "Unbiased Sampling
// Techniques for Image Synthesis", SIGGRAPH 1991, who decide by samples that are not shown; two
// buffers, crosswise: Rousselle, Knaus and Zwicker, "Adaptive Rendering with Non-Local Means
// Filtering", SIGGRAPH Asia 2012).
//
// With n samples a pixel adds s^2 / n to the squared error of the picture, where s is the standard
// deviation of its samples. For a given error the fewest samples are taken if each pixel's next one
// gains the same, which is so if s / n is the same for all (Neyman's allocation, 1934). So half of
// a pixel is complete when s / n is at most E^2 M^2 / S: then the root of the mean of s^2 / n is at
// most E M, where E is the wanted error, M the mean of the picture and S that of s.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/render/passes/PixelSums.h"

#include <cstdint>

namespace rtsl::runtime {

/// Completes halves of pixels that need no more samples for a picture with this relative error
/// (PassState::error), and returns the estimate of what it is. `sums` are adaptive, and those of a
/// window `width` pixels wide. All pixels that take samples have the same number.
double closeHalves(PixelSums &sums, std::uint32_t width, double error);

} // namespace rtsl::runtime
