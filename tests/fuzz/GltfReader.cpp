//===- GltfReader.cpp - any bytes through the reader of glTF files --------===//
//
// As JSON or as a container: the parts of a scene that the file stands for, in rest and during a
// frame, and the triangles of all its meshes. The bytes of buffers are in the file itself.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "scenefile/gltf/Animation.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/gltf/Model.h"
#include "support/Error.h"

#include <algorithm>
#include <string>

using namespace rtsl;
using namespace rtsl::scene;
using fuzz::expectAboutFile;
using fuzz::require;

namespace {

void makeModel(const gltf::File &file, bool isDuringFrame) {
  gltf::Play play;
  play.frame = 7;
  play.isDuringFrame = isDuringFrame;
  try {
    const gltf::Model model =
        gltf::modelOf(file, play, "model", gltf::Mention{"model.gltf"}, file.root());
    require(!model.root.empty(), "a model has a root");
    for (const Warning &warning : model.warnings)
      require(!warning.message.empty(), "a warning has a text");
  } catch (const Error &error) {
    expectAboutFile(error);
  }
}

void readMeshes(const gltf::File &file) {
  constexpr std::size_t most = 16; // of those, and of the parts of each
  for (std::size_t mesh = 0; mesh < std::min(most, file.list("meshes").size()); ++mesh)
    for (std::size_t primitive = 0; primitive < most; ++primitive)
      try {
        const runtime::Mesh read = gltf::readMesh(file, gltf::partOfPrimitive(mesh, primitive));
        for (const std::uint32_t index : read.indices)
          require(index < read.vertexCount(), "an index is that of a vertex");
      } catch (const Error &error) {
        expectAboutFile(error);
      }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  try {
    const gltf::File file(std::string(reinterpret_cast<const char *>(data), size), "model.gltf");
    makeModel(file, false);
    makeModel(file, true);
    readMeshes(file);
  } catch (const Error &error) {
    expectAboutFile(error);
  }
  return 0;
}
