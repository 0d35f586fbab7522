#include "runtime/accel/BlockTree.h"

#include "runtime/accel/trees/BinaryTree.h"
#include "runtime/accel/trees/BoxRuns.h"
#include "runtime/accel/trees/WideTree.h"
#include "runtime/device/trees/Bounds.h"
#include "support/Parallel.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

using device::build::emptyBox;
using device::build::extend;
using device::build::halfArea;

namespace {

//===----------------------------------------------------------------------===//
// Blocks
//===----------------------------------------------------------------------===//

/// Triangles of one mesh, and the destination of their boxes.
struct Piece {
  std::uint32_t use, first, count;
  std::size_t to;
};

/// All triangles, in pieces that are distributed to threads.
std::vector<Piece> cutIntoPieces(const std::vector<MeshUse> &meshes) {
  constexpr std::uint32_t largest = 1 << 15;
  std::vector<Piece> pieces;
  std::size_t to = 0;
  for (std::uint32_t i = 0; i < meshes.size(); ++i) {
    const std::uint32_t triangles = meshes[i].mesh->triangleCount;
    for (std::uint32_t first = 0; first < triangles; first += largest) {
      const std::uint32_t count = std::min(largest, triangles - first);
      pieces.push_back({i, first, count, to});
      to += count;
    }
  }
  return pieces;
}

/// Every triangle with its box, and the index of its mesh.
LargeArray<TriangleBox> triangleBoxes(const std::vector<MeshUse> &meshes, unsigned threads) {
  const std::vector<Piece> pieces = cutIntoPieces(meshes);
  if (pieces.empty())
    return {};
  LargeArray<TriangleBox> boxes(pieces.back().to + pieces.back().count);
  forEachInParallel(threads, pieces.size(), [&](std::size_t number) {
    const Piece &piece = pieces[number];
    const RtslMesh &mesh = *meshes[piece.use].mesh;
    for (std::uint32_t i = 0; i < piece.count; ++i) {
      const auto [a, b, c] = device::triangleVertices(mesh, piece.first + i);
      TriangleBox &box = boxes[piece.to + i];
      for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min({a[axis], b[axis], c[axis]});
        box.upper[axis] = std::max({a[axis], b[axis], c[axis]});
      }
      box.mesh = piece.use;
      box.triangle = piece.first + i;
    }
  });
  return boxes;
}

RtslBox boxOf(const LargeArray<TriangleBox> &boxes, const BoxRun &run) {
  RtslBox all = emptyBox();
  for (std::size_t i = run.first; i < run.first + run.length; ++i) {
    RtslBox box;
    std::copy_n(boxes[i].lower, 3, box.lower);
    std::copy_n(boxes[i].upper, 3, box.upper);
    extend(all, box);
  }
  return all;
}

RtslBox boxOf(const TriangleBlock &block) {
  RtslBox box = emptyBox();
  for (const auto &vertex : block.vertices)
    for (int axis = 0; axis < 3; ++axis)
      for (const float x : vertex[axis]) {
        box.lower[axis] = std::min(box.lower[axis], x);
        box.upper[axis] = std::max(box.upper[axis], x);
      }
  return box;
}

TriangleBlock makeBlock(const std::vector<MeshUse> &meshes, const LargeArray<TriangleBox> &boxes,
                        const BoxRun &run) {
  TriangleBlock block;
  for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
    const bool isEmpty = lane >= run.length;
    const TriangleBox &box = boxes[run.first + (isEmpty ? 0 : lane)];
    const MeshUse &use = meshes[box.mesh];
    block.setLane(lane, device::triangleVertices(*use.mesh, box.triangle),
                  isEmpty ? RTSL_NO_HIT : use.instance, box.triangle);
  }
  return block;
}

constexpr std::size_t blocksAtOnce = 1024; // on a thread

//===----------------------------------------------------------------------===//
// The tree
//===----------------------------------------------------------------------===//

/// A node whose boxes are still empty.
BlockNode blockNode(const RtslBvhNode &of) {
  BlockNode node;
  std::fill_n(node.sides[0], 3 * BlockNode::width, device::infinity);
  std::fill_n(node.sides[3], 3 * BlockNode::width, -device::infinity);
  std::uint32_t nodes = 0;
  for (unsigned slot = 0; slot < BlockNode::width; ++slot) {
    if (of.inner >> slot & 1)
      node.children[slot] = placeOf<BlockNode>(of.firstNode + nodes++);
    else if (of.child[slot] == 0)
      node.children[slot] = BlockNode::none;
    else
      node.children[slot] =
          BlockNode::isBlock | placeOf<TriangleBlock>(of.firstItem + (of.child[slot] & 31u));
  }
  return node;
}

} // namespace

BlockTree::BlockTree(const std::vector<MeshUse> &meshes, unsigned threads) {
  static_assert(longestRun == TriangleBlock::lanes);
  LargeArray<TriangleBox> boxes = triangleBoxes(meshes, threads);
  if (boxes.empty())
    return;
  const std::vector<BoxRun> runs = sortIntoRuns(boxes, threads);
  std::vector<NumberedBox> ofRuns(runs.size());
  forEachInParallel(threads, runs.size(), blocksAtOnce,
                    [&](std::size_t i) { ofRuns[i] = {boxOf(boxes, runs[i]), std::uint32_t(i)}; });
  const WideTree wide = widen(buildBinaryTree(std::move(ofRuns), threads, 1), threads);
  blocks = LargeArray<TriangleBlock>(runs.size());
  forEachInParallel(threads, runs.size(), blocksAtOnce, [&](std::size_t i) {
    blocks[i] = makeBlock(meshes, boxes, runs[wide.contents[i]]);
  });
  nodes = LargeArray<BlockNode>(wide.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = blockNode(wide.nodes[i]);
  refit(threads);
  costWhenBuilt = cost;
}

void BlockTree::refit(unsigned threads) {
  if (isEmpty())
    return;
  std::vector<RtslBox> ofBlocks(blocks.size()), ofNodes(nodes.size());
  forEachInParallel(threads, blocks.size(), blocksAtOnce,
                    [&](std::size_t i) { ofBlocks[i] = boxOf(blocks[i]); });
  double area = 0;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    ofNodes[i] = emptyBox();
    for (unsigned slot = 0; slot < BlockNode::width; ++slot) {
      const std::uint32_t child = nodes[i].children[slot];
      if (child == BlockNode::none)
        continue;
      const RtslBox &one = child & BlockNode::isBlock
                               ? ofBlocks[numberAt<TriangleBlock>(child & ~BlockNode::isBlock)]
                               : ofNodes[numberAt<BlockNode>(child)];
      for (int axis = 0; axis < 3; ++axis) {
        nodes[i].sides[axis][slot] = one.lower[axis];
        nodes[i].sides[3 + axis][slot] = one.upper[axis];
      }
      area += double(halfArea(one));
      extend(ofNodes[i], one);
    }
  }
  box = ofNodes[0];
  cost = area / double(halfArea(box));
  if (!(cost > 0 && cost < double(device::infinity)))
    cost = 0;
}

} // namespace rtsl::runtime
