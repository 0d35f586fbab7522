#include "runtime/accel/TriangleBlocks.h"

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

/// Every triangle with its box. geomID is the index of the mesh.
LargeArray<RTCBuildPrimitive> triangleBoxes(const std::vector<MeshUse> &meshes, unsigned threads) {
  const std::vector<Piece> pieces = cutIntoPieces(meshes);
  if (pieces.empty())
    return {};
  LargeArray<RTCBuildPrimitive> boxes(pieces.back().to + pieces.back().count);
  forEachInParallel(threads, pieces.size(), [&](std::size_t number) {
    const Piece &piece = pieces[number];
    const RtslMesh &mesh = *meshes[piece.use].mesh;
    for (std::uint32_t i = 0; i < piece.count; ++i) {
      const auto [a, b, c] = device::triangleVertices(mesh, piece.first + i);
      RTCBuildPrimitive &box = boxes[piece.to + i];
      box.lower_x = std::min({a.x, b.x, c.x}), box.upper_x = std::max({a.x, b.x, c.x});
      box.lower_y = std::min({a.y, b.y, c.y}), box.upper_y = std::max({a.y, b.y, c.y});
      box.lower_z = std::min({a.z, b.z, c.z}), box.upper_z = std::max({a.z, b.z, c.z});
      box.geomID = piece.use;
      box.primID = piece.first + i;
    }
  });
  return boxes;
}

/// Boxes that are close together.
struct Run {
  std::size_t first;
  unsigned length;
};

/// Partitions the boxes into runs of up to TriangleBlock::lanes, with Embree's builder.
std::vector<Run> sortIntoRuns(RTCDevice device, LargeArray<RTCBuildPrimitive> &boxes) {
  struct Lengths {
    const RTCBuildPrimitive *first;
    std::vector<std::uint8_t> of; // the length of a run, at its first box
  } lengths{boxes.data(), std::vector<std::uint8_t>(boxes.size())};
  RTCBVH tree = rtcNewBVH(device);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.byteSize = sizeof arguments;
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = 2; // more would make leaves that are not full
  arguments.maxDepth = 1024;
  arguments.sahBlockSize = TriangleBlock::lanes;
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = TriangleBlock::lanes;
  arguments.bvh = tree;
  arguments.primitives = boxes.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = boxes.size();
  arguments.userPtr = &lengths;
  // Only the leaves of the tree are used: nodes are dummies, but must not be null.
  arguments.createNode = [](RTCThreadLocalAllocator, unsigned, void *user) { return user; };
  arguments.setNodeChildren = [](void *, void **, unsigned, void *) {};
  arguments.setNodeBounds = [](void *, const RTCBounds **, unsigned, void *) {};
  arguments.createLeaf = [](RTCThreadLocalAllocator, const RTCBuildPrimitive *leaf,
                            std::size_t count, void *user) -> void * {
    Lengths &lengths = *static_cast<Lengths *>(user);
    lengths.of[std::size_t(leaf - lengths.first)] = std::uint8_t(count);
    return user;
  };
  const bool isBuilt = rtcBuildBVH(&arguments) != nullptr;
  rtcReleaseBVH(tree);

  std::vector<Run> runs;
  if (!isBuilt)
    return runs;
  runs.reserve(boxes.size() - std::size_t(std::count(lengths.of.begin(), lengths.of.end(), 0)));
  for (std::size_t first = 0; first < boxes.size(); first += lengths.of[first])
    runs.push_back({first, lengths.of[first]});
  return runs;
}

} // namespace

LargeArray<TriangleBlock> makeTriangleBlocks(RTCDevice device, const std::vector<MeshUse> &meshes,
                                             unsigned threads) {
  LargeArray<RTCBuildPrimitive> boxes = triangleBoxes(meshes, threads);
  if (boxes.empty())
    return {};
  const std::vector<Run> runs = sortIntoRuns(device, boxes);
  LargeArray<TriangleBlock> blocks(runs.size());
  constexpr std::size_t atOnce = 1024;
  forEachInParallel(threads, (runs.size() + atOnce - 1) / atOnce, [&](std::size_t part) {
    const std::size_t end = std::min(runs.size(), (part + 1) * atOnce);
    for (std::size_t i = part * atOnce; i < end; ++i)
      for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
        const bool isEmpty = lane >= runs[i].length;
        const RTCBuildPrimitive &box = boxes[runs[i].first + (isEmpty ? 0 : lane)];
        const MeshUse &use = meshes[box.geomID];
        blocks[i].setLane(lane, device::triangleVertices(*use.mesh, box.primID),
                          isEmpty ? RTSL_NO_HIT : use.instance, box.primID);
      }
  });
  return blocks;
}

} // namespace rtsl::runtime
