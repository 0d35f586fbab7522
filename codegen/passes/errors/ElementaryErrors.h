//===- ElementaryErrors.h - how far elementary functions are off ----------===//
#pragma once

namespace rtsl {

/// What bounds the relative errors of elementary functions: `unit` all of them, or, where
/// `powGrows`, all but pow(x, y), which has unit (1 + |y log2 x|). Relative to the smallest normal
/// float where the result is smaller (docs/elementary-functions.md).
struct ElementaryErrors {
  double unit;
  bool powGrows;
};

/// Correctly rounded. Holds for double too, for what both have in memory is single, and they are to
/// trace the same rays.
constexpr ElementaryErrors strictErrors{0x1p-24, false};
/// By --fp=fast.
constexpr ElementaryErrors fastErrors{0x1p-21, true};

} // namespace rtsl
