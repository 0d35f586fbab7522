//===- Articles.h - "a" and "an" before names -----------------------------===//
#pragma once

#include <string>

namespace rtsl {

/// Replaces "a" by "an" before quoted names that are spoken with a vowel: an `Emitter`, an
/// `rt_Light`, an `int[]`, but a `uint`.
std::string withArticles(std::string text);

} // namespace rtsl
