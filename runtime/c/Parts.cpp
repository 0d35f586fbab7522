//===- Parts.cpp - primitives of glTF files, for C ------------------------===//
#include "runtime/c/Handle.h"
#include "scenefile/Models.h"
#include "scenefile/gltf/Mesh.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace runtime = rtsl::runtime;
namespace gltf = rtsl::scene::gltf;
using rtsl::c::guarded;

const std::shared_ptr<rtsl::scene::ModelFiles> &RtslScene::openModels() {
  if (!models)
    models = std::make_shared<rtsl::scene::ModelFiles>();
  return models;
}

namespace {

/// The mesh of a primitive, with these weights of its morph targets; none: all are 0.
runtime::Mesh loadPart(RtslScene &scene, const std::string &path, const std::string &part,
                       std::vector<double> weights) {
  const gltf::File &file = scene.openModels()->open(path);
  const std::size_t targets =
      gltf::targetCount(gltf::primitiveOf(file, part, rtsl::Place{path}), part);
  if (!weights.empty() && weights.size() != targets)
    throw rtsl::Error(rtsl::message::numberCount(fmt::format("`weights` of `{}`", part), targets,
                                                 weights.size()));
  runtime::Mesh mesh = gltf::readMesh(file, part, scene.meshRequest(), weights);
  scene.setTextureCoordinates(mesh);
  return mesh;
}

} // namespace

extern "C" {

int32_t rtslSceneLoadMeshPart(RtslScene *scene, const char *path, const char *part,
                              const double *weights, size_t targets) {
  return guarded<int32_t>(
      -1, {{scene, "scene"}, {path, "path"}, {part, "part"}, {weights, "weights", targets}}, [&] {
        runtime::Mesh mesh = loadPart(*scene, path, part, {weights, weights + targets});
        scene->giveAttributes(mesh, path);
        return static_cast<int32_t>(scene->scene.addMesh(std::move(mesh), path));
      });
}

int32_t rtslSceneLoadMovingMeshPart(RtslScene *scene, const char *path, const char *part,
                                    const double *weights, size_t targets, const float *times,
                                    uint32_t count) {
  return guarded<int32_t>(
      -1,
      {{scene, "scene"},
       {path, "path"},
       {part, "part"},
       {weights, "weights", targets},
       {times, "times"}},
      [&] {
        std::vector<float> ofKeys = rtsl::c::keyTimes("a mesh", times, count, sizeof *times);
        std::vector<runtime::Mesh> keys;
        for (std::uint32_t i = 0; i < count; ++i) {
          const double *ofKey = weights + i * targets;
          keys.push_back(loadPart(*scene, path, part, {ofKey, ofKey + targets}));
        }
        scene->giveAttributes(keys.front(), path);
        return static_cast<int32_t>(
            scene->scene.addMesh(runtime::movingMesh(std::move(keys), std::move(ofKeys),
                                                     std::vector<std::string>(count, path)),
                                 path));
      });
}

} // extern "C"
