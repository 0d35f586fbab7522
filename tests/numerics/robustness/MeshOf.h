//===- MeshOf.h - triangles as a mesh -------------------------------------===//
#pragma once

#include "TriangleCases.h"

#include "runtime/geometry/Mesh.h"

#include <vector>

namespace rtsl::numerics {

/// In their order; none of them shares a vertex with another.
inline runtime::Mesh meshOf(const std::vector<Triangle> &triangles) {
  runtime::Mesh mesh;
  for (const Triangle &triangle : triangles)
    for (const device::Vec3 &vertex : triangle.v) {
      mesh.indices.push_back(std::uint32_t(mesh.vertexCount()));
      mesh.positions.insert(mesh.positions.end(), {vertex.x, vertex.y, vertex.z});
    }
  return mesh;
}

} // namespace rtsl::numerics
