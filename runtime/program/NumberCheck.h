//===- NumberCheck.h - where a sample becomes infinite or NaN -------------===//
//
// A program that was compiled with checks calls rtsl_check_number for every number that a shader
// computes, with its operands, and rtsl_check_stored_number for every number that it stores, each
// with the number of its place in the source. A sample that is infinite or NaN is rendered again by
// such a program, repeatedly, with finite numbers in place of those that a place made of finite
// ones. The result is the place that makes the sample finite, from as late a time on as possible.
// If there are several causes, no single place does; then one more place makes finite numbers each
// time, the latest first: without the result, and the later ones, the sample would be finite.
//
// Many numbers are rightly infinite, such as those of an inverse direction. They come earlier than
// the cause of the problem, or do not affect the sample. But a finite number in place of one of
// these may change where the sample's rays go; therefore the time counts, before which nothing
// changes.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

extern "C" {

/// Returns `value`, which was computed from `a`, `b` and `c`; unused operands are finite.
float rtsl_check_number(float value, float a, float b, float c, std::uint32_t place);
/// Returns `value`, which is about to be stored.
float rtsl_check_stored_number(float value, std::uint32_t place);

/// The same for --fp=double, where a number may become infinite because it is stored as a float.
double rtsl_double_check_number(double value, double a, double b, double c, std::uint32_t place);
double rtsl_double_check_stored_number(double value, std::uint32_t place);
}

namespace rtsl::runtime {

/// The place that makes a sample not finite; nothing if it is not found, or if the sample is finite
/// now. `isFinite` renders the sample on this thread with a checked program.
std::optional<std::uint32_t> findOrigin(const std::function<bool()> &isFinite);

} // namespace rtsl::runtime
