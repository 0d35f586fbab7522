#include "runtime/accel/TriangleBlocks.h"

#include "runtime/accel/trees/BoxRuns.h"
#include "support/Parallel.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

namespace {

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

} // namespace

LargeArray<TriangleBlock> makeTriangleBlocks(const std::vector<MeshUse> &meshes, unsigned threads) {
  static_assert(longestRun == TriangleBlock::lanes);
  LargeArray<TriangleBox> boxes = triangleBoxes(meshes, threads);
  if (boxes.empty())
    return {};
  const std::vector<BoxRun> runs = sortIntoRuns(boxes, threads);
  LargeArray<TriangleBlock> blocks(runs.size());
  forRangesInParallel(threads, runs.size(), 1024, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
        const bool isEmpty = lane >= runs[i].length;
        const TriangleBox &box = boxes[runs[i].first + (isEmpty ? 0 : lane)];
        const MeshUse &use = meshes[box.mesh];
        blocks[i].setLane(lane, device::triangleVertices(*use.mesh, box.triangle),
                          isEmpty ? RTSL_NO_HIT : use.instance, box.triangle);
      }
  });
  return blocks;
}

} // namespace rtsl::runtime
