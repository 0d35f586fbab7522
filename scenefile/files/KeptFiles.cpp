#include "scenefile/files/KeptFiles.h"

#include "scenefile/Models.h"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

namespace rtsl::scene {

namespace {

/// Files of other formats may consist of several.
bool isOneFile(const std::string &path) {
  const std::string extension = path.size() < 4 ? "" : path.substr(path.size() - 4);
  return extension == ".obj" || extension == ".ply";
}

std::timespec now() {
  std::timespec time;
  std::timespec_get(&time, TIME_UTC);
  return time;
}

} // namespace

bool KeptFiles::Version::operator==(const Version &other) const {
  return isFile && other.isFile && device == other.device && number == other.number &&
         size == other.size && modified.tv_sec == other.modified.tv_sec &&
         modified.tv_nsec == other.modified.tv_nsec;
}

KeptFiles::Version KeptFiles::versionOf(const std::string &path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
    return {};
  return {true, status.st_dev, status.st_ino, status.st_size, status.st_mtim};
}

/// Whether a file that was read after `start` was the same all the time. Times of files advance in
/// steps of some milliseconds: what was written less than a second before may change again at the
/// same time.
bool KeptFiles::canBeKept(const Version &version, const std::timespec &start) {
  return version.isFile && version.modified.tv_sec + 1 < start.tv_sec;
}

/// What was kept, if all of its files are the same as they were; otherwise null.
template <typename Key, typename Contents>
std::shared_ptr<const Contents> KeptFiles::find(std::map<Key, Kept<Contents>> &all,
                                                const Key &key) {
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = all.find(key);
  if (found == all.end())
    return nullptr;
  Kept<Contents> &kept = found->second;
  if (!std::all_of(kept.files.begin(), kept.files.end(),
                   [](const auto &file) { return versionOf(file.first) == file.second; }))
    return nullptr;
  kept.isUsed = true;
  return kept.contents;
}

std::shared_ptr<const runtime::Mesh> KeptFiles::mesh(const std::string &path,
                                                     const runtime::MeshRequest &request) {
  const MeshKey key(path, request.attributes, request.keepsOrder);
  if (auto kept = find(meshes, key))
    return kept;
  const std::timespec start = now();
  const Version version = versionOf(path); // before it is read: a later one is read again
  auto mesh = std::make_shared<const runtime::Mesh>(runtime::loadMesh(path, request));
  if (isOneFile(path) && canBeKept(version, start)) {
    const std::lock_guard<std::mutex> lock(mutex);
    meshes[key] = {{{path, version}}, mesh};
  }
  return mesh;
}

std::shared_ptr<const gltf::File> KeptFiles::model(const std::string &path) {
  if (auto kept = find(models, path))
    return kept;
  const std::timespec start = now();
  std::shared_ptr<const gltf::File> model = openModel(path);
  // Which files it has is known only now. Those that were written since `start` are not kept.
  std::vector<std::pair<std::string, Version>> files;
  for (const std::string &file : model->files())
    files.emplace_back(file, versionOf(file));
  if (std::all_of(files.begin(), files.end(),
                  [&](const auto &file) { return canBeKept(file.second, start); })) {
    const std::lock_guard<std::mutex> lock(mutex);
    models[path] = {std::move(files), model};
  }
  return model;
}

void KeptFiles::forgetUnused() {
  const auto forget = [](auto &all) {
    for (auto kept = all.begin(); kept != all.end();)
      if (std::exchange(kept->second.isUsed, false))
        ++kept;
      else
        kept = all.erase(kept);
  };
  const std::lock_guard<std::mutex> lock(mutex);
  forget(meshes);
  forget(models);
}

} // namespace rtsl::scene
