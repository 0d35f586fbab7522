#include "scenefile/files/KeptMeshes.h"

#include <sys/stat.h>

namespace rtsl::scene {

namespace {

/// Files of other formats may consist of several, as glTF files do.
bool isOneFile(const std::string &path) {
  const std::string extension = path.size() < 4 ? "" : path.substr(path.size() - 4);
  return extension == ".obj" || extension == ".ply";
}

/// Times of files advance in steps of some milliseconds: what was written less than a second ago
/// may change again at the same time.
bool isRecent(const std::timespec &time) {
  std::timespec now;
  std::timespec_get(&now, TIME_UTC);
  return time.tv_sec + 1 >= now.tv_sec;
}

} // namespace

bool KeptMeshes::Version::operator==(const Version &other) const {
  return isFile && other.isFile && device == other.device && number == other.number &&
         size == other.size && modified.tv_sec == other.modified.tv_sec &&
         modified.tv_nsec == other.modified.tv_nsec;
}

KeptMeshes::Version KeptMeshes::versionOf(const std::string &path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
    return {};
  return {true, status.st_dev, status.st_ino, status.st_size, status.st_mtim};
}

std::shared_ptr<const runtime::Mesh> KeptMeshes::load(const std::string &path,
                                                      const runtime::MeshRequest &request) {
  const Version version = versionOf(path); // before it is read: a later one is read again
  const Key key(path, request.attributes, request.keepsOrder);
  {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = meshes.find(key);
    if (found != meshes.end() && found->second.version == version) {
      found->second.isUsed = true;
      return found->second.mesh;
    }
  }
  auto mesh = std::make_shared<const runtime::Mesh>(runtime::loadMesh(path, request));
  if (isOneFile(path) && !isRecent(version.modified)) {
    const std::lock_guard<std::mutex> lock(mutex);
    meshes[key] = {version, mesh};
  }
  return mesh;
}

void KeptMeshes::forgetUnused() {
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto kept = meshes.begin(); kept != meshes.end();)
    if (kept->second.isUsed) {
      kept->second.isUsed = false;
      ++kept;
    } else {
      kept = meshes.erase(kept);
    }
}

} // namespace rtsl::scene
