#include "scenefile/MeshFiles.h"

#include "support/WorkerThreads.h"

namespace rtsl::scene {

using runtime::Mesh;
using runtime::Transform;

namespace {

/// A mesh file with the transform of its objects.
struct Placement {
  std::size_t file;
  const Transform *transform;
  bool isBarycentric;
};

} // namespace

MeshFiles::MeshFiles(const SceneDescription &description) {
  std::map<std::string, std::size_t> fileNumbers;
  std::vector<const std::string *> paths;
  std::vector<std::size_t> uses; // placements of each file
  std::vector<Placement> placements;
  for (const GeometryDescription &geometry : description.objects) {
    if (geometry.primitive || !numbers.emplace(keyOf(geometry), numbers.size()).second)
      continue;
    const auto [file, isNew] = fileNumbers.emplace(geometry.meshPath, paths.size());
    if (isNew) {
      paths.push_back(&geometry.meshPath);
      uses.push_back(0);
    }
    ++uses[file->second];
    placements.push_back({file->second, &geometry.transform, geometry.isBarycentric});
  }

  std::vector<Result> files(paths.size());
  forEachOnThreads(0, files.size(), [&](std::size_t i) {
    try {
      files[i].mesh = runtime::loadMesh(*paths[i]);
    } catch (...) {
      files[i].failure = std::current_exception();
    }
  });
  results.resize(placements.size());
  forEachOnThreads(0, results.size(), [&](std::size_t i) {
    Result &file = files[placements[i].file], &result = results[i];
    try {
      result.failure = file.failure;
      if (uses[placements[i].file] == 1)
        result.mesh = std::move(file.mesh);
      else
        result.mesh = file.mesh;
      if (placements[i].isBarycentric)
        result.mesh.uvs.clear();
      result.mesh.apply(*placements[i].transform);
    } catch (...) {
      result.failure = std::current_exception();
    }
  });
}

MeshFiles::Key MeshFiles::keyOf(const GeometryDescription &geometry) {
  return {geometry.meshPath, geometry.transform.columns, geometry.isBarycentric};
}

std::size_t MeshFiles::numberOf(const GeometryDescription &geometry) const {
  return numbers.at(keyOf(geometry));
}

Mesh MeshFiles::take(std::size_t number) {
  Result &result = results[number];
  if (result.failure)
    std::rethrow_exception(result.failure);
  return std::move(result.mesh);
}

} // namespace rtsl::scene
