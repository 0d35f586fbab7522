//===- TreeKind.h - how trees are built -----------------------------------===//
#pragma once

#include <cstdint>
#include <optional>

namespace rtsl::runtime {

enum class TreeKind : std::uint8_t {
  Good, // top down by the surface area heuristic (BinaryTree.h): the fewest nodes for a ray
  Fast, // by joining neighbours (ClusterTree.h), on a GPU if there is one: built sooner
};

/// Trees of fewer items are built in a tenth of a second whatever builds them.
constexpr std::uint64_t manyItems = 1 << 18;

/// The kind of trees that is built for a rendering: the requested one, or else one chosen by the
/// number of items in all trees.
inline TreeKind treeKind(std::optional<TreeKind> requested, std::uint64_t items) {
  return requested.value_or(items < manyItems ? TreeKind::Good : TreeKind::Fast);
}

/// The time that the trees of a scene took to build, and their quality.
struct TreeFigures {
  TreeKind kind = TreeKind::Good;
  std::uint32_t nodes = 0, items = 0;
  float cost = 0;          // of the tree of the world (WideTree::cost)
  double seconds = 0;      // to build them; 0: they were there
  bool isRefitted = false; // they have followed what moved: `cost` is that of when they were built
};

} // namespace rtsl::runtime
