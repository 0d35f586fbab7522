//===- Importer.h - assimp, in a library of its own -----------------------===//
//
// Loading assimp takes a fifth of the time in which `rtslc-render` starts, and few scenes have a
// mesh that is read by it. So a program opens `rtsl-meshes.so` when it has such a file.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <assimp/scene.h>

#include <memory>

namespace rtsl::runtime {

/// Reads one file.
class Importer {
public:
  virtual ~Importer() = default;

  /// Polygons are triangles, and meshes are of one kind of primitive. The scene lives as long as
  /// this. Null if the file is damaged.
  virtual const aiScene *read(const char *path) = 0;
  /// The reason why the last read() has failed.
  virtual const char *error() const = 0;
  /// The name of one of the scene's materials; valid until the next call.
  virtual const char *materialName(unsigned index) = 0;
};

/// What `rtsl-meshes.so` has, under its name.
struct ImporterLibrary {
  bool (*reads)(const char *extension); // such as ".glb"
  std::unique_ptr<Importer> (*open)();
};
constexpr const char *importerLibrarySymbol = "rtslImporterLibrary";

} // namespace rtsl::runtime
