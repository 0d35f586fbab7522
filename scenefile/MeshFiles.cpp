#include "scenefile/MeshFiles.h"

#include "support/WorkerThreads.h"

namespace rtsl::scene {

using runtime::Mesh;

namespace {

/// A mesh of an object, and the numbers of its files, one for each key.
struct Use {
  std::vector<std::size_t> files;
  const GeometryDescription *geometry;
};

} // namespace

MeshFiles::MeshFiles(const SceneDescription &description) {
  std::map<std::string, std::size_t> fileNumbers;
  std::vector<const std::string *> paths;
  std::vector<std::size_t> useCounts; // of each file
  std::vector<Use> uses;
  for (const GeometryDescription &geometry : description.objects) {
    if (geometry.primitive || !numbers.emplace(keyOf(geometry), numbers.size()).second)
      continue;
    uses.push_back({{}, &geometry});
    for (const MeshPath &key : geometry.mesh) {
      const auto [file, isNew] = fileNumbers.emplace(key.path, paths.size());
      if (isNew) {
        paths.push_back(&key.path);
        useCounts.push_back(0);
      }
      ++useCounts[file->second];
      uses.back().files.push_back(file->second);
    }
  }

  std::vector<Result> files(paths.size());
  forEachOnThreads(0, files.size(), [&](std::size_t i) {
    try {
      files[i].mesh = runtime::loadMesh(*paths[i]);
    } catch (...) {
      files[i].failure = std::current_exception();
    }
  });
  results.resize(uses.size());
  forEachOnThreads(0, results.size(), [&](std::size_t i) {
    const GeometryDescription &geometry = *uses[i].geometry;
    Result &result = results[i];
    try {
      std::vector<Mesh> keys;
      std::vector<std::string> names;
      for (const std::size_t number : uses[i].files) {
        Result &file = files[number];
        if (file.failure)
          std::rethrow_exception(file.failure);
        if (useCounts[number] == 1)
          keys.push_back(std::move(file.mesh));
        else
          keys.push_back(file.mesh);
        names.push_back(*paths[number]);
      }
      result.mesh = keys.size() == 1
                        ? std::move(keys.front())
                        : runtime::movingMesh(std::move(keys), geometry.meshTimes, names);
      if (geometry.isBarycentric)
        result.mesh.uvs.clear();
      result.mesh.apply(geometry.transform);
    } catch (...) {
      result.failure = std::current_exception();
    }
  });
}

MeshFiles::Key MeshFiles::keyOf(const GeometryDescription &geometry) {
  std::vector<std::string> paths;
  for (const MeshPath &key : geometry.mesh)
    paths.push_back(key.path);
  return {std::move(paths), geometry.meshTimes, geometry.transform.columns, geometry.isBarycentric};
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
