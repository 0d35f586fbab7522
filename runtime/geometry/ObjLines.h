//===- ObjLines.h - the lines of Wavefront OBJ files ----------------------===//
//
// A file is cut into parts of whole lines. Their lines are counted, so that each part knows what
// stands above it: the numbers of which lines its faces may use, and where its own belong. Then all
// parts are read at the same time.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace rtsl::runtime::obj {

/// The index of what a corner does not have.
constexpr std::uint32_t none = ~std::uint32_t(0);

/// How many lines there are of these kinds.
struct LineCounts {
  std::size_t positions = 0, uvs = 0, normals = 0, faces = 0;

  void add(const LineCounts &other);
};

LineCounts countLines(std::string_view text);

/// The numbers of a file, as it counts them: from 0.
struct Numbers {
  std::vector<float> positions, normals; // 3 each
  std::vector<float> uvs;                // 2 each
  std::vector<float> colors;             // 3 of each position; empty: they are not wanted

  Numbers(const LineCounts &counts, bool wantsColors);
  bool hasUvs() const { return !uvs.empty(); }
  bool hasNormals() const { return !normals.empty(); }

  /// The indices of a corner: that of its position, then those of its texture coordinates and of
  /// its normal, if the file has any.
  std::size_t cornerWidth() const { return std::size_t(1) + hasUvs() + hasNormals(); }
};

/// A name after `usemtl`.
struct MaterialUse {
  std::size_t firstTriangle; // of those that follow, in the part
  std::string_view material;
};

/// Whole lines, and what they hold beside numbers.
struct Part {
  std::string_view text;
  LineCounts before;         // of the lines above
  std::size_t faceLines = 0; // in the part

  std::vector<std::uint8_t> faceSizes; // corners of each face: 3 or 4
  std::vector<std::uint32_t> corners;  // Numbers::cornerWidth() indices of each
  std::size_t triangleCount = 0;
  std::size_t colorCount = 0; // of positions
  std::vector<MaterialUse> uses;
};

/// Cuts a text after ends of lines. Parts are not much larger than this number of bytes, unless a
/// line is.
std::vector<Part> cutIntoParts(std::string_view text, std::size_t bytes);

/// Reads the lines of a part, with their numbers. False if they contain anything that ObjFile.h
/// does not allow.
bool readLines(Part &part, Numbers &numbers);

} // namespace rtsl::runtime::obj
