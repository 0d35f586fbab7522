//===- Places.h - from locations in the IR to ranges in source files ------===//
#pragma once

#include "codegen/ir/SourcePlace.h"
#include "frontend/diagnostics/Diagnostics.h"

#include <string_view>

namespace rtsl::driver {

/// The range of `word` at a location in the IR; an empty range if its file is not known.
inline SourceRange rangeAt(const ir::SourcePlace &place, std::string_view word,
                           const Diagnostics &diagnostics) {
  const FileId file = diagnostics.sources().find(place.file);
  if (!file)
    return {};
  const std::uint32_t begin = diagnostics.sources().offset(file, {place.line, place.column});
  return {file, begin, begin + static_cast<std::uint32_t>(word.size())};
}

} // namespace rtsl::driver
