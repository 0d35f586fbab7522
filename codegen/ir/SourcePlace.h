//===- SourcePlace.h - locations in source files --------------------------===//
#pragma once

#include <cstdint>
#include <string>

namespace mlir {
class Location;
} // namespace mlir

namespace rtsl::ir {

struct SourcePlace {
  std::string file; // as messages name it; empty: unknown
  std::uint32_t line = 0, column = 0;

  bool isKnown() const { return !file.empty(); }
  /// "glass.rtsl:40:20" without the folders of the file, or empty.
  std::string text() const;
};

/// The source location. For inlined code it is where the code was written, not that of the call.
SourcePlace placeOf(mlir::Location location);

} // namespace rtsl::ir
