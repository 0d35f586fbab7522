#include "runtime/query/MeshQuery.h"

#include "runtime/embree/HostScene.h"
#include "runtime/scene/Scene.h"
#include "support/Fibers.h"
#include "support/Parallel.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace rtsl::runtime {

namespace {

/// A program of two empty classes: a scene has a material and something that starts rays.
std::shared_ptr<const Program> emptyProgram() {
  Program program;
  program.engine = Engine::Programs;
  program.needs = program.sceneNeeds = 0;
  const auto add = [&](const char *name, const char *root, std::vector<std::string> methods) {
    ClassInfo info;
    info.name = name;
    info.base = info.root = root;
    info.id = std::uint32_t(program.classes.size() + 1);
    info.methods = std::move(methods);
    info.needs = 0;
    program.classes.push_back(std::move(info));
  };
  add("Surface", "rt_Material", {});
  add("Rays", "rt_RayGeneration", {"generate"});
  return std::make_shared<const Program>(std::move(program));
}

Scene sceneOf(Mesh mesh) {
  Scene scene(emptyProgram());
  scene.setRayGeneration(scene.addObject("Rays"));
  scene.addMeshInstance(scene.addMesh(std::move(mesh), "the mesh"), scene.addObject("Surface"));
  return scene;
}

} // namespace

struct MeshQuery::Implementation {
  Scene scene;
  unsigned threads, raysInTurns;
  HostScene trees;
  RtslLaunch launch;

  Implementation(Mesh mesh, unsigned threads, unsigned raysInTurns)
      : scene(sceneOf(std::move(mesh))), threads(threads), raysInTurns(raysInTurns),
        trees(scene, true, threads) {
    refresh();
  }

  void refresh() {
    launch = scene.launch();
    launch.host = &trees;
  }

  /// Traces all rays, and calls take(i, state, whether it hits something).
  template <typename Take>
  void trace(const QueryRay *rays, std::size_t count, std::uint32_t how, Take take) const {
    const unsigned inTurns = raysInTurns != 0 ? raysInTurns : trees.raysInTurns();
    forRangesInParallel(threads, count, 4096, [&](std::size_t next, std::size_t end) {
      Fibers::run(inTurns, 0, [&](unsigned) {
        RtslState state{};
        state.launch = &launch;
        state.rayMask = ~0u;
        while (next < end) {
          const std::size_t i = next++;
          const QueryRay &ray = rays[i];
          std::copy_n(ray.origin, 3, state.RayOrigin);
          std::copy_n(ray.direction, 3, state.RayDirection);
          state.Epsilon = ray.tMin;
          state.HitDistance = ray.tMax;
          state.instance = state.primitive = RTSL_NO_HIT;
          take(i, state, trees.traverse(state, how) == RTSL_HIT);
        }
      });
    });
  }
};

MeshQuery::MeshQuery(Mesh mesh, unsigned threads, unsigned raysInTurns)
    : self(std::make_unique<Implementation>(std::move(mesh), threads, raysInTurns)) {}
MeshQuery::~MeshQuery() = default;

void MeshQuery::nearest(const QueryRay *rays, std::size_t count, QueryHit *hits) const {
  self->trace(rays, count, 0, [&](std::size_t i, const RtslState &state, bool isHit) {
    hits[i] = isHit ? QueryHit{state.HitDistance, std::int32_t(state.primitive), state.u, state.v}
                    : QueryHit{-1, -1, 0, 0};
  });
}

void MeshQuery::any(const QueryRay *rays, std::size_t count, std::uint8_t *hits) const {
  self->trace(rays, count, RTSL_FIRST_HIT,
              [&](std::size_t i, const RtslState &, bool isHit) { hits[i] = isHit; });
}

void MeshQuery::move(std::vector<float> positions) {
  self->scene.moveMesh(0, std::move(positions));
  self->trees.update();
  self->refresh();
}

} // namespace rtsl::runtime
