//===- KeptMeshes.h - meshes for several scenes, one after the other ------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <ctime>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <sys/types.h>
#include <tuple>
#include <vector>

namespace rtsl::scene {

/// Meshes as their files have them, so that the next scene, another frame or another launch, reads
/// only files that have changed. Calls may be at the same time.
class KeptMeshes {
public:
  /// runtime::loadMesh, unless the last call for this path was for the same file: one of the same
  /// size, last modified at the same time, in the same place on the disk. Files that have just been
  /// written are read again.
  std::shared_ptr<const runtime::Mesh> load(const std::string &path,
                                            const runtime::MeshRequest &request);

  /// Forgets the meshes that have not been loaded since the last call.
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

  using Key = std::tuple<std::string, std::vector<std::string>, bool>; // a path and a request
  struct Kept {
    Version version;
    std::shared_ptr<const runtime::Mesh> mesh;
    bool isUsed = true;
  };

  std::mutex mutex;
  std::map<Key, Kept> meshes;
};

} // namespace rtsl::scene
