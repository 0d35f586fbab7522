#include "runtime/geometry/AssimpFile.h"

#include "runtime/geometry/assimp/Importer.h"
#include "support/ErrorMessages.h"
#include "support/OwnLibrary.h"

#include <assimp/material.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::runtime {

namespace {

/// Whether a mesh of the file has an attribute: `tangent`, `uv1`, `color`, `color1`.
struct Source {
  std::string name;
  std::uint32_t components;
  unsigned set; // of texture coordinates or colors

  bool isIn(const aiMesh &part) const {
    return name == "tangent" ? part.HasTangentsAndBitangents()
           : name[0] == 'u'  ? part.HasTextureCoords(set)
                             : part.HasVertexColors(set);
  }

  /// The value of a vertex.
  std::array<float, 4> at(const aiMesh &part, std::size_t vertex) const {
    if (name[0] == 'u') {
      const aiVector3D &uv = part.mTextureCoords[set][vertex];
      return {uv.x, uv.y, 0, 0};
    }
    if (name[0] == 'c') {
      const aiColor4D &color = part.mColors[set][vertex];
      return {color.r, color.g, color.b, color.a};
    }
    const aiVector3D &t = part.mTangents[vertex], &b = part.mBitangents[vertex];
    const aiVector3D across = part.HasNormals() ? part.mNormals[vertex] ^ t : b;
    return {t.x, t.y, t.z, across * b < 0 ? -1.0f : 1.0f};
  }
};

/// The attributes of the file's meshes; the others of its names go to `others`.
std::vector<Source> sourcesOf(const aiScene &scene, const MeshRequest &request,
                              std::vector<std::string> &others) {
  std::vector<Source> all{{"tangent", 4, 0}};
  for (unsigned set = 0; set < AI_MAX_NUMBER_OF_COLOR_SETS; ++set)
    all.push_back({set == 0 ? "color" : fmt::format("color{}", set), 4, set});
  for (unsigned set = 1; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set)
    all.push_back({fmt::format("uv{}", set), 2, set});
  std::vector<Source> wanted;
  for (Source &source : all) {
    const bool isThere = std::any_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes,
                                     [&](const aiMesh *mesh) { return source.isIn(*mesh); });
    if (isThere && request.wants(source.name))
      wanted.push_back(std::move(source));
    else if (isThere)
      others.push_back(source.name);
  }
  return wanted;
}

void addAttributes(Mesh &mesh, const aiMesh &part, const std::vector<Source> &sources) {
  for (const Source &source : sources) {
    std::vector<float> numbers(source.components * std::size_t(part.mNumVertices), 0.0f);
    for (std::size_t i = 0; source.isIn(part) && i < part.mNumVertices; ++i)
      std::copy_n(source.at(part, i).begin(), source.components, &numbers[source.components * i]);
    NamedAttribute attribute = floatAttribute(source.name, source.components, numbers);
    attribute.isRgb = source.name[0] == 'c';
    if (source.name == "tangent")
      attribute.space = NamedAttribute::Space::Tangent;
    mesh.attributes.push_back(std::move(attribute));
  }
}

/// Appends one of the file's meshes, transformed by its node.
void append(Mesh &whole, const aiMesh &part, const Transform &transform, bool normals, bool uvs,
            const std::vector<Source> &sources, const std::string &path) {
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
  addAttributes(mesh, part, sources);
  validateMesh(mesh, path); // before indices are offset and coordinates transformed
  mesh.apply(transform);
  std::size_t offset = whole.vertexCount();
  if (offset + vertices > 0xffffffffu)
    throw Error(message::meshTooLarge(path), Place{path});
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
  if (whole.attributes.empty())
    whole.attributes = std::move(mesh.attributes);
  else
    for (std::size_t i = 0; i < whole.attributes.size(); ++i)
      join(whole.attributes[i].words, mesh.attributes[i].words);
}

Transform transformOf(const aiMatrix4x4 &m) {
  Transform transform;
  transform.columns = {
      {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}}};
  return transform;
}

const ImporterLibrary &openLibrary() {
  std::string why;
  const void *const found = findInOwnLibrary("rtsl-meshes.so", importerLibrarySymbol, why);
  if (!found)
    throw Error(message::noMeshLibrary(why));
  return *static_cast<const ImporterLibrary *>(found);
}

const ImporterLibrary &library() {
  static const ImporterLibrary &opened = openLibrary();
  return opened;
}

const aiScene &readFile(Importer &importer, const std::string &path) {
  const aiScene *scene = importer.read(path.c_str());
  if (scene && scene->mRootNode)
    return *scene;
  std::string reason = importer.error();
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' '))
    reason.pop_back();
  if (reason.find("bad_alloc") != std::string::npos) // assimp catches the reader's exceptions
    throw Error(message::noMemoryForMesh(path), Place{path});
  throw Error(message::meshDamaged(path, reason.empty() ? "the file is damaged" : reason),
              Place{path});
}

/// Appends all meshes of a file to those that `wholeOf` gives for them.
template <typename WholeOf>
void appendAll(const aiScene &scene, const std::vector<Source> &sources, const std::string &path,
               WholeOf wholeOf) {
  bool normals = false, uvs = false;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    normals |= scene.mMeshes[i]->HasNormals();
    uvs |= scene.mMeshes[i]->HasTextureCoords(0);
  }
  std::vector<std::pair<const aiNode *, Transform>> open{{scene.mRootNode, Transform()}};
  while (!open.empty()) {
    auto [node, above] = open.back();
    open.pop_back();
    Transform transform = transformOf(node->mTransformation).then(above);
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const aiMesh &part = *scene.mMeshes[node->mMeshes[i]];
      append(wholeOf(part), part, transform, normals, uvs, sources, path);
    }
    for (unsigned i = node->mNumChildren; i-- > 0;)
      open.emplace_back(node->mChildren[i], transform);
  }
}

} // namespace

bool isReadByAssimp(const std::string &extension) {
  return library().reads(extension.c_str());
}

Mesh readByAssimp(const std::string &path, const MeshRequest &request) {
  const std::unique_ptr<Importer> importer = library().open();
  const aiScene &scene = readFile(*importer, path);
  Mesh whole;
  const std::vector<Source> sources = sourcesOf(scene, request, whole.otherAttributes);
  appendAll(scene, sources, path, [&](const aiMesh &) -> Mesh & { return whole; });
  validateMesh(whole, path);
  return whole;
}

std::vector<MeshGroup> readGroupsByAssimp(const std::string &path) {
  const std::unique_ptr<Importer> importer = library().open();
  const aiScene &scene = readFile(*importer, path);
  const bool areColored = std::all_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes,
                                      [](const aiMesh *mesh) { return mesh->HasVertexColors(0); });
  std::vector<std::string> others;
  const std::vector<Source> sources =
      areColored ? sourcesOf(scene, {{"color"}, false}, others) : std::vector<Source>();
  std::map<std::string, Mesh> byName;
  appendAll(scene, sources, path, [&](const aiMesh &part) -> Mesh & {
    std::string name;
    if (part.mMaterialIndex < scene.mNumMaterials)
      name = importer->materialName(part.mMaterialIndex);
    // What assimp calls the material of triangles without one.
    return byName[name == AI_DEFAULT_MATERIAL_NAME ? "" : name];
  });
  std::vector<MeshGroup> groups;
  for (auto &[name, mesh] : byName)
    if (!mesh.indices.empty())
      groups.push_back({name, std::move(mesh)});
  return groups;
}

} // namespace rtsl::runtime
