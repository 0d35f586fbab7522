//===- NumberCheck.h - where a sample stops being finite -------------------===//
//
// A program that was compiled with checks calls rtsl_check_number for every number that a shader
// computes or stores, with the number of its place in the source and what it was computed from. A
// sample that is infinite or not a number is rendered again by such a program, again and again:
// each time one more of the places that made a number not finite gives some finite number instead,
// the latest first, until the sample is finite. The last of these places is the answer: without it,
// and what came after, the sample would be all right.
//
// Many numbers are rightly infinite, an inverse direction say. They come earlier than what spoils
// the sample, or make no difference to it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

extern "C" {

/// Gives `value`, which was computed from `a`, `b` and `c`; what does not matter is finite.
float rtsl_check_number(float value, float a, float b, float c, std::uint32_t place);
/// The same of --fp=double.
double rtsl_double_check_number(double value, double a, double b, double c, std::uint32_t place);
}

namespace rtsl::runtime {

/// The place to which it goes back that a sample is not finite; nothing if that is not found, or if
/// the sample is finite now. `isFinite` renders the sample on this thread by a program with checks.
std::optional<std::uint32_t> findOrigin(const std::function<bool()> &isFinite);

} // namespace rtsl::runtime
