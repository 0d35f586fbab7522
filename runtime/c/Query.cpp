//===- Query.cpp - rays against a mesh without shaders, for C -------------===//
#include "runtime/c/Handle.h"
#include "runtime/query/MeshQuery.h"

#include <type_traits>

namespace runtime = rtsl::runtime;
using rtsl::c::guarded;

struct RtslQuery {
  runtime::MeshQuery query;
};

// The structs of both interfaces are the same.
static_assert(sizeof(RtslQueryRay) == sizeof(runtime::QueryRay) &&
              offsetof(RtslQueryRay, direction) == offsetof(runtime::QueryRay, direction));
static_assert(sizeof(RtslQueryHit) == sizeof(runtime::QueryHit) &&
              offsetof(RtslQueryHit, u) == offsetof(runtime::QueryHit, u));

extern "C" {

RtslQuery *rtslQueryCreate(const float *positions, size_t vertices, const uint32_t *indices,
                           size_t triangles, uint32_t threads) {
  return guarded<RtslQuery *>(
      nullptr, {{positions, "positions", vertices}, {indices, "indices", triangles}}, [&] {
        runtime::Mesh mesh;
        mesh.positions.assign(positions, positions + 3 * vertices);
        mesh.indices.assign(indices, indices + 3 * triangles);
        return new RtslQuery{runtime::MeshQuery(std::move(mesh), threads)};
      });
}

RtslQuery *rtslQueryLoad(const char *path, uint32_t threads) {
  return guarded<RtslQuery *>(nullptr, {{path, "path"}}, [&] {
    return new RtslQuery{runtime::MeshQuery(runtime::loadMesh(path), threads)};
  });
}

void rtslQueryDestroy(RtslQuery *query) {
  delete query;
}

int rtslQueryNearest(const RtslQuery *query, const RtslQueryRay *rays, size_t count,
                     RtslQueryHit *hits) {
  return guarded(0, {{query, "query"}, {rays, "rays", count}, {hits, "hits", count}}, [&] {
    query->query.nearest(reinterpret_cast<const runtime::QueryRay *>(rays), count,
                         reinterpret_cast<runtime::QueryHit *>(hits));
    return 1;
  });
}

int rtslQueryAny(const RtslQuery *query, const RtslQueryRay *rays, size_t count, uint8_t *hits) {
  return guarded(0, {{query, "query"}, {rays, "rays", count}, {hits, "hits", count}}, [&] {
    query->query.any(reinterpret_cast<const runtime::QueryRay *>(rays), count, hits);
    return 1;
  });
}

int rtslQueryMove(RtslQuery *query, const float *positions, size_t vertices) {
  return guarded(0, {{query, "query"}, {positions, "positions", vertices}}, [&] {
    query->query.move({positions, positions + 3 * vertices});
    return 1;
  });
}

} // extern "C"
