//===- CornerNumbers.h - vertices of corners that are equal ---------------===//
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// Turns corners into vertices, in the order in which they first occur; equal corners share one. A
/// corner is `width` indices, of which the first is below `positionCount`.
template <std::size_t width>
class CornerNumbers {
public:
  explicit CornerNumbers(std::size_t positionCount) : firstAt(positionCount, none) {
    vertices.reserve(width * positionCount);
  }

  /// The number of its vertex.
  std::uint32_t of(const std::uint32_t *corner) {
    std::uint32_t *link = &firstAt[corner[0]];
    while (*link != none) {
      if (width == 1 || std::equal(corner + 1, corner + width, &vertices[width * *link + 1]))
        return *link;
      link = &nextAt[*link];
    }
    const auto number = std::uint32_t(vertices.size() / width);
    *link = number;
    vertices.insert(vertices.end(), corner, corner + width);
    if (width > 1)
      nextAt.push_back(none);
    return number;
  }

  /// The corner of each vertex.
  std::vector<std::uint32_t> take() { return std::move(vertices); }

private:
  static constexpr std::uint32_t none = ~std::uint32_t(0);

  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> firstAt; // by position
  std::vector<std::uint32_t> nextAt;  // by vertex: another one with the same position
};

} // namespace rtsl::runtime
