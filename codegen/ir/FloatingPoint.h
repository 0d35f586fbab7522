//===- FloatingPoint.h - the modes of floating-point arithmetic -----------===//
#pragma once

#include <cstdint>

namespace rtsl {

/// Strict: IEEE single precision, each operation as written, with the same bits everywhere. Fast:
/// approximations and reassociation (docs/fast.md). Double: for reference renderings, on the host
/// only (docs/report.md).
enum class FloatingPoint : std::uint8_t { Strict, Fast, Double };

} // namespace rtsl
