//===- Checkpoint.h - a rendering that is kept in a file -------------------===//
//
// The file has the exact sums of each pixel, what rays have met so far, and what the rendering
// depends on: it can be resumed by a rendering of the same program, scene and options alone.
// docs/scene-format.md describes how to use it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/render/passes/Passes.h"

#include <string>
#include <string_view>
#include <vector>

namespace rtsl::runtime {

/// One thing that the bits of a picture depend on.
struct Dependence {
  std::string what;       // "the seed", "`Clay.rtsl`"
  std::string value;      // "1", or the checksum of a file
  bool isContent = false; // `value` is a checksum, which means nothing to people
};

/// What a rendering depends on, in an order that is the same for all renderings.
struct Identity {
  std::string producer; // "rtslc 0.1.0", at most 31 bytes
  std::vector<Dependence> dependences;
};

/// Replaces the file atomically: whatever ends the process, the file is the old or the new one.
/// Throws FileUnwritable.
void writeCheckpoint(const std::string &path, const Identity &identity,
                     const PartialRendering &rendering);

/// The contents of a file with this name. Throws BadCheckpoint: it is no checkpoint, of another
/// version or another rendering, truncated, or damaged (a change of any one byte is found). The
/// sums have this many pixels and components, and are adaptive or not.
PartialRendering parseCheckpoint(std::string_view bytes, const std::string &path,
                                 const Identity &identity, std::uint64_t pixels,
                                 std::uint32_t components, bool isAdaptive = false);

} // namespace rtsl::runtime
