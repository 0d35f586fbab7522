#include "scenefile/files/MeshFiles.h"

#include "scenefile/Models.h"
#include "scenefile/files/KeptFiles.h"
#include "scenefile/files/PlacedMesh.h"
#include "scenefile/gltf/Mesh.h"
#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::scene {

using runtime::Mesh;

namespace {

/// A mesh of objects, and the numbers of its files, one for each key.
struct Use {
  std::vector<std::size_t> files;
  const GeometryDescription *geometry; // the first of them
  bool isShared = false;               // there are others
};

/// A file, or a part of one, and what it holds.
struct File {
  std::string path;
  std::string part;            // of a glTF file; empty: all of it
  std::vector<double> weights; // of its morph targets
  std::size_t uses = 0;
  bool keepsOrder = false; // the scene gives values for its vertices or faces
  Mesh mesh = {};
  std::shared_ptr<const Mesh> kept = nullptr; // instead of `mesh`, for other scenes, too
  std::exception_ptr failure = nullptr;

  /// The mesh, for one of the uses.
  Mesh use() {
    if (kept)
      return *kept;
    return uses == 1 ? std::move(mesh) : mesh;
  }
};

/// Reads a file.
void read(File &file, const SceneDescription &description, runtime::MeshRequest wanted) {
  wanted.keepsOrder = file.keepsOrder;
  if (!file.part.empty())
    file.mesh =
        gltf::readMesh(description.models->open(file.path), file.part, wanted, file.weights);
  else if (description.keptFiles)
    file.kept = description.keptFiles->mesh(file.path, wanted);
  else
    file.mesh = runtime::loadMesh(file.path, wanted);
}

bool hasValues(const GeometryDescription &geometry) {
  return std::any_of(geometry.attributes.begin(), geometry.attributes.end(),
                     [](const AttributeDescription &one) { return one.values != nullptr; });
}

/// Sets the spaces of attributes that the scene gives for those of the file.
void setSpaces(Mesh &mesh, const GeometryDescription &geometry) {
  for (const AttributeDescription &given : geometry.attributes)
    for (runtime::NamedAttribute &attribute : mesh.attributes)
      if (!given.values && attribute.name == given.name) {
        const std::uint32_t needed = componentsOf(given.space);
        if (needed != 0 && needed != attribute.components)
          throw Error(message::attributeNumberCount(given.name, attribute.components,
                                                    nameOf(given.space), needed),
                      given.place);
        attribute.space = given.space;
      }
}

} // namespace

MeshFiles::MeshFiles(const SceneDescription &description, const runtime::MeshRequest &request) {
  // by path, part and weights
  std::map<std::tuple<std::string, std::string, std::vector<double>>, std::size_t> fileNumbers;
  std::vector<File> files;
  std::vector<Use> uses;
  for (const GeometryDescription &geometry : description.objects) {
    if (geometry.primitive || !geometry.hasShape)
      continue;
    const auto [number, isFirst] = numbers.emplace(keyOf(geometry), numbers.size());
    if (!isFirst) {
      uses[number->second].isShared = true;
      continue;
    }
    uses.push_back({{}, &geometry});
    const std::size_t keys = std::max(geometry.mesh.size(), geometry.weights.size());
    for (std::size_t i = 0; i < keys; ++i) {
      const std::string &path = geometry.mesh[std::min(i, geometry.mesh.size() - 1)].path;
      const std::vector<double> weights =
          geometry.weights.empty() ? std::vector<double>() : geometry.weights[i];
      const auto [file, isNew] =
          fileNumbers.emplace(std::tuple(path, geometry.part, weights), files.size());
      if (isNew)
        files.push_back({path, geometry.part, weights});
      ++files[file->second].uses;
      files[file->second].keepsOrder |= hasValues(geometry);
      uses.back().files.push_back(file->second);
    }
  }

  forEachInParallel(0, files.size(), [&](std::size_t i) {
    File &file = files[i];
    try {
      read(file, description, request);
    } catch (...) {
      file.failure = std::current_exception();
    }
  });
  if (description.keptFiles)
    description.keptFiles->forgetUnused();
  results.resize(uses.size());
  forEachInParallel(0, results.size(), [&](std::size_t i) {
    const GeometryDescription &geometry = *uses[i].geometry;
    Result &result = results[i];
    try {
      std::vector<Mesh> keys;
      std::vector<std::string> names;
      for (const std::size_t number : uses[i].files) {
        File &file = files[number];
        if (file.failure)
          std::rethrow_exception(file.failure);
        keys.push_back(file.use());
        names.push_back(file.path);
      }
      result.mesh = keys.size() == 1
                        ? std::move(keys.front())
                        : runtime::movingMesh(std::move(keys), geometry.meshTimes, names);
      if (geometry.isBarycentric)
        result.mesh.uvs.clear();
      setSpaces(result.mesh, geometry);
      result.mesh.apply(geometry.transform);
      const runtime::Transform *toWorld =
          uses[i].isShared ? nullptr : placeOf(geometry, description);
      result.isPlaced = toWorld && place(result.mesh, *toWorld);
      result.applied = result.isPlaced ? *toWorld : geometry.transform;
    } catch (...) {
      result.failure = std::current_exception();
    }
  });
}

MeshFiles::Key MeshFiles::keyOf(const GeometryDescription &geometry) {
  std::vector<std::string> paths;
  for (const MeshPath &key : geometry.mesh)
    paths.push_back(key.path);
  std::vector<const JsonValue *> attributes;
  for (const AttributeDescription &attribute : geometry.attributes)
    attributes.push_back(attribute.json);
  return {
      std::move(paths),           geometry.part,          geometry.weights,     geometry.meshTimes,
      geometry.transform.columns, geometry.isBarycentric, std::move(attributes)};
}

std::size_t MeshFiles::numberOf(const GeometryDescription &geometry) const {
  return numbers.at(keyOf(geometry));
}

const runtime::Transform &MeshFiles::applied(std::size_t number) const {
  return results[number].applied;
}

bool MeshFiles::isPlaced(std::size_t number) const {
  return results[number].isPlaced;
}

Mesh MeshFiles::take(std::size_t number) {
  Result &result = results[number];
  if (result.failure)
    std::rethrow_exception(result.failure);
  return std::move(result.mesh);
}

} // namespace rtsl::scene
