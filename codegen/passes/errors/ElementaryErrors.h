//===- ElementaryErrors.h - errors of elementary functions ----------------===//
#pragma once

namespace rtsl {

/// A bound of the relative errors of elementary functions: `unit` for all of them, except, if
/// `powGrows`, pow(x, y), which has unit (1 + |y log2 x|). Relative to the smallest normal float if
/// the result is smaller (docs/elementary-functions.md).
struct ElementaryErrors {
  double unit;
  bool powGrows;
};

/// Correctly rounded. Used for double too: values in memory are single in both, and both are to
/// trace the same rays.
constexpr ElementaryErrors strictErrors{0x1p-24, false};
/// The errors with --fp=fast.
constexpr ElementaryErrors fastErrors{0x1p-21, true};

} // namespace rtsl
