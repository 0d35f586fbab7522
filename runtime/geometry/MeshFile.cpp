//===- MeshFile.cpp - meshes from files -----------------------------------===//
//
// assimp reads all formats, but is slow: for each OBJ or PLY file it clears 32 MiB first. So files
// of these formats without unusual features are read here, and assimp reads the rest: other formats
// and rare features. Damaged files are reported here: assimp reads wrong numbers from some damaged
// OBJ files, and some PLY files crash it.
//
//===----------------------------------------------------------------------===//
#include "runtime/geometry/AssimpFile.h"
#include "runtime/geometry/Mesh.h"
#include "runtime/geometry/ObjDamage.h"
#include "runtime/geometry/ObjFile.h"
#include "runtime/geometry/PlyFile.h"
#include "support/ByteOrderMark.h"
#include "support/ErrorMessages.h"
#include "support/LargeFile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <new>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace rtsl::runtime {

void checkMeshFile(const std::string &path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0)
    throw Error(errno == ENOENT || errno == ENOTDIR
                    ? message::meshMissing(path, std::strerror(errno))
                    : message::meshUnreadable(path, std::strerror(errno)),
                Place{path});
  if (S_ISDIR(status.st_mode))
    throw Error(message::meshIsFolder(path), Place{path});
  if (::access(path.c_str(), R_OK) != 0)
    throw Error(message::meshUnreadable(path, std::strerror(errno)), Place{path});
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
    throw Error(message::meshIsDevice(path), Place{path});
  if (S_ISREG(status.st_mode) && status.st_size == 0)
    throw Error(message::meshEmpty(path), Place{path});
}

namespace {

/// The extension with the dot, in lower case.
std::string extensionOf(const std::string &path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] == '/')
    return "";
  std::string extension = path.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

bool isPipe(const std::string &path) {
  struct stat status;
  return ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

std::string_view objTextOf(const LargeFile &file) {
  return file.bytes().substr(byteOrderMarkLength(file.bytes()));
}

/// Nothing if assimp must read the file, which is not possible after a pipe has been read.
std::optional<Mesh> readPlain(const std::string &path, const std::string &extension,
                              const MeshRequest &request) {
  const bool isPly = extension == ".ply";
  if (!isPly && extension != ".obj")
    return std::nullopt;
  const bool isRead = isPipe(path);
  const LargeFile file(path);
  const std::string_view bytes = isPly ? file.bytes() : objTextOf(file);
  std::optional<Mesh> mesh = isPly ? readPlainPly(bytes, request) : readPlainObj(bytes, request);
  if (mesh)
    return mesh;
  if (const std::optional<Message> damage =
          isPly ? findPlyDamage(bytes, path) : findObjDamage(bytes, path))
    throw Error(*damage, Place{path});
  if (isRead)
    throw Error(message::meshUnreadableFromPipe(path), Place{path});
  return std::nullopt;
}

} // namespace

Mesh loadMesh(const std::string &path, const MeshRequest &request) {
  checkMeshFile(path);
  const std::string extension = extensionOf(path);
  try {
    if (std::optional<Mesh> mesh = readPlain(path, extension, request)) {
      validateMesh(*mesh, path);
      return std::move(*mesh);
    }
    if (extension.empty() || !isReadByAssimp(extension))
      throw Error(message::meshFormatUnknown(path, path.substr(path.size() - extension.size())),
                  Place{path});
    return readByAssimp(path, request);
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryForMesh(path), Place{path});
  }
}

std::vector<MeshGroup> loadMeshGroups(const std::string &path) {
  checkMeshFile(path);
  try {
    if (isPipe(path))
      throw Error(message::meshUnreadableFromPipe(path), Place{path});
    const LargeFile file(path);
    if (std::optional<std::vector<MeshGroup>> groups = readPlainObjGroups(objTextOf(file))) {
      for (const MeshGroup &group : *groups)
        validateMesh(group.mesh, path);
      return std::move(*groups);
    }
    if (const std::optional<Message> damage = findObjDamage(objTextOf(file), path))
      throw Error(*damage, Place{path});
    std::vector<MeshGroup> groups = readGroupsByAssimp(path);
    if (groups.empty())
      validateMesh({}, path); // throws: there is no triangle
    return groups;
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryForMesh(path), Place{path});
  }
}

} // namespace rtsl::runtime
