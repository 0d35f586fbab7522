//===- BlockTree.h - a tree over blocks of triangles ----------------------===//
//
// The host's tree of the triangles that do not move. A node has up to eight children, whose boxes
// are floats, tested at once (BlockSearch.h). A child is a node or one block of eight
// triangles, and blocks are in the order of the leaves: nothing is read between a node and a block.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TriangleBlock.h"
#include "runtime/device/trees/Bounds.h"
#include "support/LargeArray.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// A mesh with the number that blocks give its triangles as their instance.
struct MeshUse {
  std::uint32_t instance;
  const RtslMesh *mesh;
};

/// Up to eight children in slots. No ray enters the box of an empty slot.
struct alignas(32) BlockNode {
  static constexpr unsigned width = 8;
  static constexpr std::uint32_t isBlock = 1u << 31;
  static constexpr std::uint32_t none = 0; // the root, which is no child

  float sides[6][width];         // of the children's boxes: lower x, y, z, upper x, y, z
  std::uint32_t children[width]; // the place of a node, isBlock | that of a block, or none
};

/// The place of a node or a block is its distance from the first one, in units of 32 bytes: its
/// address needs no multiplication, which would take time between one node and the next.
constexpr std::size_t unitOfPlaces = 32;
template <typename Element>
constexpr std::uint32_t placeOf(std::size_t number) {
  static_assert(sizeof(Element) % unitOfPlaces == 0);
  return std::uint32_t(number * (sizeof(Element) / unitOfPlaces));
}
template <typename Element>
constexpr std::size_t numberAt(std::uint32_t place) {
  return place / (sizeof(Element) / unitOfPlaces);
}

class BlockTree {
public:
  BlockTree() = default;
  /// All triangles of the meshes in blocks of neighbours, and the tree. The result does not depend
  /// on the number of threads; 0: one per core. Throws std::bad_alloc.
  BlockTree(const std::vector<MeshUse> &meshes, unsigned threads);

  bool isEmpty() const { return blocks.empty(); }
  std::size_t bytes() const {
    return nodes.size() * sizeof(BlockNode) + blocks.size() * sizeof(TriangleBlock);
  }
  /// The exact box of all triangles; empty if there are none.
  const RtslBox &bounds() const { return box; }

  const BlockNode &node(std::uint32_t place) const { return at(nodes, place); }
  const TriangleBlock &block(std::uint32_t place) const { return at(blocks, place); }

  /// Begins to load a child of a node into the cache.
  [[gnu::always_inline]] void prefetch(std::uint32_t child) const {
    const std::uint32_t place = child & ~BlockNode::isBlock;
    const char *const first = child & BlockNode::isBlock
                                  ? reinterpret_cast<const char *>(&block(place))
                                  : reinterpret_cast<const char *>(&node(place));
    for (int line = 0; line < 5; ++line) // of a block all but what only hits need
      __builtin_prefetch(first + 64 * line);
  }

  /// The boxes of nodes follow those of the blocks; the tree keeps its shape.
  void refit(unsigned threads);
  /// The cost by the surface area heuristic, relative to that of the tree as it was built. At
  /// least 0; 1 if nothing has moved.
  double degradation() const { return costWhenBuilt > 0 && cost > 0 ? cost / costWhenBuilt : 1; }

  LargeArray<BlockNode> nodes; // the root first, and each after its parent; none without blocks
  LargeArray<TriangleBlock> blocks;

private:
  template <typename Element>
  static const Element &at(const LargeArray<Element> &array, std::uint32_t place) {
    const char *const first = reinterpret_cast<const char *>(array.begin());
    return *reinterpret_cast<const Element *>(first + unitOfPlaces * place);
  }

  RtslBox box = device::build::emptyBox();
  double cost = 0, costWhenBuilt = 0; // 0: unknown
};

} // namespace rtsl::runtime
