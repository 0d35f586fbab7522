//===- KeptFiles.h - files for several scenes, one after the other --------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "scenefile/gltf/File.h"

#include <ctime>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <sys/types.h>
#include <tuple>
#include <vector>

namespace rtsl::scene {

/// Meshes and models as their files have them, so that the next scene, another frame or another
/// launch, reads only files that have changed. Calls may be at the same time.
class KeptFiles {
public:
  /// runtime::loadMesh, unless the last call for this path was for the same file: one of the same
  /// size, last modified at the same time, in the same place on the disk. Files that have just been
  /// written are read again.
  std::shared_ptr<const runtime::Mesh> mesh(const std::string &path,
                                            const runtime::MeshRequest &request);

  /// openModel, unless the last call for this path was for the same files: the model's own, those
  /// of its buffers, and those of its materials.
  std::shared_ptr<const gltf::File> model(const std::string &path);

  /// Forgets files that were not requested since the last call of this function.
  void forgetUnused();

private:
  /// What distinguishes a file from others that were at its path before.
  struct Version {
    bool isFile = false;
    dev_t device = 0;
    ino_t number = 0;
    off_t size = 0;
    std::timespec modified = {};

    bool operator==(const Version &other) const;
  };
  static Version versionOf(const std::string &path);
  static bool canBeKept(const Version &version, const std::timespec &start);

  /// What was read, and the files that it was read from.
  template <typename Contents>
  struct Kept {
    std::vector<std::pair<std::string, Version>> files;
    std::shared_ptr<const Contents> contents;
    bool isUsed = true;
  };
  template <typename Key, typename Contents>
  std::shared_ptr<const Contents> find(std::map<Key, Kept<Contents>> &all, const Key &key);

  using MeshKey = std::tuple<std::string, std::vector<std::string>, bool>; // a path and a request

  std::mutex mutex;
  std::map<MeshKey, Kept<runtime::Mesh>> meshes;
  std::map<std::string, Kept<gltf::File>> models;
};

} // namespace rtsl::scene
