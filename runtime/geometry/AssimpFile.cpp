#include "runtime/geometry/AssimpFile.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace rtsl::runtime {

namespace {

/// Appends one of the file's meshes, transformed by its node.
void append(Mesh &whole, const aiMesh &part, const Transform &transform, bool normals, bool uvs,
            const std::string &path) {
  Mesh mesh;
  std::size_t vertices = part.mNumVertices;
  for (std::size_t i = 0; i < vertices; ++i)
    mesh.positions.insert(mesh.positions.end(),
                          {part.mVertices[i].x, part.mVertices[i].y, part.mVertices[i].z});
  if (normals) {
    mesh.normals.assign(3 * vertices, 0.0f); // 0: the device runtime uses the geometric normal
    if (part.HasNormals())
      for (std::size_t i = 0; i < vertices; ++i)
        std::copy_n(&part.mNormals[i].x, 3, &mesh.normals[3 * i]);
  }
  if (uvs) {
    mesh.uvs.assign(2 * vertices, 0.0f);
    if (part.HasTextureCoords(0))
      for (std::size_t i = 0; i < vertices; ++i)
        std::copy_n(&part.mTextureCoords[0][i].x, 2, &mesh.uvs[2 * i]);
  }
  for (std::size_t i = 0; i < part.mNumFaces; ++i) {
    const aiFace &face = part.mFaces[i];
    if (face.mNumIndices != 3)
      continue; // points and lines
    mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + 3);
  }
  if (mesh.indices.empty())
    return;
  validateMesh(mesh, path); // before indices are offset and coordinates transformed
  mesh.apply(transform);
  std::size_t offset = whole.vertexCount();
  if (offset + vertices > 0xffffffffu)
    throw Error(ErrorCode::BadMesh, fmt::format("mesh `{}` has more than 2^32 vertices", path),
                Place{path});
  for (std::uint32_t &index : mesh.indices)
    index += std::uint32_t(offset);
  auto join = [](auto &to, auto &from) {
    if (to.empty())
      to = std::move(from);
    else
      to.insert(to.end(), from.begin(), from.end());
  };
  join(whole.positions, mesh.positions);
  join(whole.normals, mesh.normals);
  join(whole.uvs, mesh.uvs);
  join(whole.indices, mesh.indices);
}

Transform transformOf(const aiMatrix4x4 &m) {
  Transform transform;
  transform.columns = {
      {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}}};
  return transform;
}

} // namespace

bool isReadByAssimp(const std::string &extension) {
  return Assimp::Importer().IsExtensionSupported(extension);
}

Mesh readByAssimp(const std::string &path) {
  Assimp::Importer importer;
  const aiScene *scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_SortByPType);
  if (!scene || !scene->mRootNode) {
    std::string reason = importer.GetErrorString();
    while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' '))
      reason.pop_back();
    if (reason.find("bad_alloc") != std::string::npos) // assimp catches the reader's exceptions
      throw Error(ErrorCode::OutOfMemory, fmt::format("not enough memory to read mesh `{}`", path),
                  Place{path});
    throw Error(ErrorCode::BadMesh,
                fmt::format("cannot read mesh `{}`: {}", path,
                            reason.empty() ? "the file is damaged" : reason),
                Place{path});
  }

  bool normals = false, uvs = false;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    normals |= scene->mMeshes[i]->HasNormals();
    uvs |= scene->mMeshes[i]->HasTextureCoords(0);
  }
  Mesh whole;
  std::vector<std::pair<const aiNode *, Transform>> open{{scene->mRootNode, Transform()}};
  while (!open.empty()) {
    auto [node, above] = open.back();
    open.pop_back();
    Transform transform = transformOf(node->mTransformation).then(above);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      append(whole, *scene->mMeshes[node->mMeshes[i]], transform, normals, uvs, path);
    for (unsigned i = node->mNumChildren; i-- > 0;)
      open.emplace_back(node->mChildren[i], transform);
  }
  validateMesh(whole, path);
  return whole;
}

} // namespace rtsl::runtime
