//===- FloatingPoint.h - how compiled code computes -----------------------===//
#pragma once

#include <cstdint>

namespace rtsl {

/// Strict: IEEE single, each operation as it is written, with the same bits everywhere. Fast:
/// approximations and reassociation (docs/fast.md). Double: for references, on the host alone
/// (docs/report.md).
enum class FloatingPoint : std::uint8_t { Strict, Fast, Double };

} // namespace rtsl
