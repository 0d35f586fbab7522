//===- MeshQuery.h - rays of an application's own against a mesh ----------===//
//
// The raw queries of `rtslc trace`, without shaders: arrays of rays in, arrays of hits out, in the
// caller's memory. The hits have the same bits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rtsl::runtime {

/// A ray from `origin` that hits at tMin < t < tMax, in units of the direction's length.
struct QueryRay {
  float origin[3], tMin, direction[3], tMax;
};

/// u and v are the barycentric coordinates of the hit at the second and third vertex. Nothing is
/// hit: -1, -1, 0, 0.
struct QueryHit {
  float t;
  std::int32_t triangle;
  float u, v;
};

class MeshQuery {
public:
  /// Builds the trees. `threads` 0: one per core, also for queries, of which each traces so many
  /// rays in turns (support/Fibers.h), at most Fibers::most; 0: by the size of the trees. Throws
  /// BadMesh, OutOfMemory.
  explicit MeshQuery(Mesh mesh, unsigned threads = 0, unsigned raysInTurns = 0);
  ~MeshQuery();

  /// The nearest hit of each ray. A ray that is not finite or has no direction hits nothing.
  void nearest(const QueryRay *rays, std::size_t count, QueryHit *hits) const;
  /// 1 for each ray that hits something, otherwise 0.
  void any(const QueryRay *rays, std::size_t count, std::uint8_t *hits) const;

  /// Other positions of as many vertices: the trees follow them. Throws BadMesh.
  void move(std::vector<float> positions);

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl::runtime
