//===- MeshReader.cpp - any bytes through the readers of meshes -----------===//
//
// As an OBJ and a PLY file: the mesh with its attributes, and the meshes of the OBJ file's
// materials. What the own readers leave to assimp is read by it.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "runtime/geometry/Mesh.h"
#include "runtime/geometry/ObjFile.h"

#include <optional>
#include <string>
#include <string_view>

using namespace rtsl;
using fuzz::attempt;
using fuzz::require;

namespace {

void check(const runtime::Mesh &mesh) {
  validateMesh(mesh, "mesh");
  if (mesh.order.isKnown) {
    require(mesh.order.vertices.empty() || mesh.order.vertices.size() == mesh.vertexCount(),
            "each vertex is one of the file");
    require(mesh.order.faces.size() == mesh.triangleCount(), "each triangle is of a face");
  }
}

bool areEqual(const std::optional<runtime::Mesh> &a, const std::optional<runtime::Mesh> &b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->indices == b->indices && a->positions == b->positions &&
                 a->normals == b->normals && a->uvs == b->uvs));
}

void read(const fuzz::File &file, bool isObj) {
  const runtime::MeshRequest all{{"color", "wear", "id"}, true};
  attempt([&] { check(runtime::loadMesh(file.path)); });
  attempt([&] { check(runtime::loadMesh(file.path, all)); });
  if (isObj)
    attempt([&] {
      for (const runtime::MeshGroup &group : runtime::loadMeshGroups(file.path))
        check(group.mesh);
    });
}

} // namespace

/// What assimp leaves behind is not ours.
extern "C" const char *__lsan_default_suppressions() {
  return "leak:libassimp";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char *>(data), size);
  read(fuzz::File(bytes, "mesh.obj"), true);
  read(fuzz::File(bytes, "mesh.ply"), false);
  constexpr std::size_t fewBytes = 16; // a part begins on another line
  require(areEqual(runtime::readPlainObj(bytes), runtime::readPlainObj(bytes, {}, fewBytes)),
          "the size of parts does not matter");
  return 0;
}
