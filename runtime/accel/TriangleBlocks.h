//===- TriangleBlocks.h - the triangles of a scene in blocks --------------===//
#pragma once

#include "runtime/accel/TriangleBlock.h"
#include "support/LargeArray.h"

#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// A mesh with the number that blocks give its triangles as their instance.
struct MeshUse {
  std::uint32_t instance;
  const RtslMesh *mesh;
};

/// All triangles of the meshes in blocks of neighbouring ones. Throws std::bad_alloc.
LargeArray<TriangleBlock> makeTriangleBlocks(const std::vector<MeshUse> &meshes, unsigned threads);

} // namespace rtsl::runtime
