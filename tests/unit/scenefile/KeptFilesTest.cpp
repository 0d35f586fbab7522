//===- KeptFilesTest.cpp -------------------------------------------------===//
#include "tests/unit/scenefile/GltfFiles.h"

#include "scenefile/files/KeptFiles.h"
#include "scenefile/files/MeshFiles.h"

#include <gtest/gtest.h>

namespace rtsl::scene {
namespace {

namespace fs = std::filesystem;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string other = "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n"; // as long

const auto start = fs::file_time_type::clock::now() - std::chrono::hours(1);

/// The x of the second vertex of an object's mesh.
float readThrough(const std::shared_ptr<KeptFiles> &kept, const std::string &path,
                  const runtime::MeshRequest &request = {}) {
  SceneDescription description;
  description.keptFiles = kept;
  GeometryDescription geometry;
  geometry.mesh.push_back({});
  geometry.mesh.back().path = path;
  geometry.transform = runtime::Transform::translate(0, 5, 0);
  description.objects.push_back(geometry);
  MeshFiles files(description, request);
  const runtime::Mesh mesh = files.take(files.numberOf(geometry));
  EXPECT_EQ(mesh.positions[1], 5);
  return mesh.positions[3];
}

// A file that only looks unchanged shows that it is not read.
TEST(KeptFiles, FilesThatChangedAreReadAgain) {
  const test::Folder folder;
  const std::string path = folder.path + "/mesh.obj";
  const auto kept = std::make_shared<KeptFiles>();
  const auto write = [&](const std::string &text, int seconds) {
    folder.write("mesh.obj", text);
    fs::last_write_time(path, start + std::chrono::seconds(seconds));
  };
  write(triangle, 0);
  EXPECT_EQ(readThrough(kept, path), 1);
  write(other, 0);
  EXPECT_EQ(readThrough(kept, path), 1) << "it was kept";
  EXPECT_EQ(readThrough(nullptr, path), 2);
  EXPECT_EQ(readThrough(kept, path, {{"color"}, false}), 2) << "another request";
  EXPECT_EQ(readThrough(kept, path), 2) << "it was not used by the last scene";
  write(triangle, 1);
  EXPECT_EQ(readThrough(kept, path), 1) << "another time";
  write(other + "# longer\n", 1);
  EXPECT_EQ(readThrough(kept, path), 2) << "another size";
  fs::remove(path);
  EXPECT_THROW(readThrough(kept, path), Error);
  write(triangle, 1);
  EXPECT_EQ(readThrough(kept, path), 1);
}

TEST(KeptFiles, FilesThatMayHaveOthersBesideThemAreReadEachTime) {
  const test::Folder folder;
  const std::string path = folder.path + "/mesh.stl";
  const auto write = [&](const char *x) {
    folder.write("mesh.stl", std::string("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                         "vertex ") +
                                 x + " 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
    fs::last_write_time(path, start);
  };
  const auto kept = std::make_shared<KeptFiles>();
  write("1");
  EXPECT_EQ(readThrough(kept, path), 1);
  write("2");
  EXPECT_EQ(readThrough(kept, path), 2);
}

/// What a scene shows of a model: the x of the second vertex, and its material.
struct Shown {
  float x;
  std::string material;
};

Shown show(const std::string &path, const std::shared_ptr<KeptFiles> &kept) {
  const SceneDescription scene = parseScene(
      R"({"rtsl": 1, "camera": {"class": "C"}, "objects": [{"model": ")" + path + "\"}]}", "s.json",
      {}, kept);
  const GeometryDescription &geometry = scene.objects.front();
  MeshFiles files(scene, {});
  return {files.take(files.numberOf(geometry)).positions[3],
          scene.materials.empty() ? "" : scene.materials.begin()->second.className.text};
}

/// A folder whose files keep the time of last modification.
class ModelFolder : public test::Folder {
public:
  void writeAgain(const std::string &name, const std::string &bytes, int seconds = 0) const {
    write(name, bytes);
    fs::last_write_time(path + "/" + name, start + std::chrono::seconds(seconds));
  }
};

TEST(KeptFiles, ModelsThatChangedAreReadAgain) {
  const ModelFolder folder;
  const std::string model = folder.path + "/m.gltf";
  const auto withX = [&](float x, int seconds) {
    std::string bytes = test::square();
    bytes.replace(24, 4, test::bytesOf<float>({x}));
    folder.writeAgain("m.bin", bytes, seconds);
  };
  std::string json = test::squareFile();
  const std::size_t uri = json.find("data:");
  json.replace(uri, json.find('"', uri) - uri, "m.bin");
  folder.writeAgain("m.gltf", json);
  withX(1, 0);
  const auto kept = std::make_shared<KeptFiles>();
  EXPECT_EQ(show(model, kept).x, 1);
  withX(2, 0);
  EXPECT_EQ(show(model, kept).x, 1) << "it was kept";
  EXPECT_EQ(show(model, nullptr).x, 2);
  withX(2, 1);
  EXPECT_EQ(show(model, kept).x, 2) << "another time of its buffer";
  withX(3, 1);
  EXPECT_EQ(show(model, kept).x, 2);
  folder.writeAgain("m.gltf", json + " ", 0);
  EXPECT_EQ(show(model, kept).x, 3) << "another size of its JSON";
  fs::remove(folder.path + "/m.bin");
  EXPECT_THROW(show(model, kept), Error);
  withX(4, 1);
  EXPECT_EQ(show(model, kept).x, 4);
}

TEST(KeptFiles, ModelsHaveFilesOfMaterials) {
  const ModelFolder folder;
  const std::string model = folder.path + "/m.obj";
  folder.writeAgain("m.obj", "mtllib m.mtl\nusemtl a\n" + triangle);
  const auto kept = std::make_shared<KeptFiles>();
  EXPECT_EQ(show(model, kept).material, "Lambert") << "there is no such file: gray";
  folder.writeAgain("m.mtl", "newmtl a\nillum 7\nNi 1.500\n", 0);
  EXPECT_EQ(show(model, kept).material, "Dielectric");
  folder.writeAgain("m.mtl", "newmtl a\nillum 2\nKd 1 0 0\n", 0);
  folder.writeAgain("m.obj", "mtllib m.mtl\nusemtl a\n" + other);
  EXPECT_EQ(show(model, kept).x, 1) << "it was kept";
  EXPECT_EQ(show(model, nullptr).x, 2);
  folder.writeAgain("m.mtl", "newmtl a\nillum 2\nKd 1 0 0\n", 1);
  EXPECT_EQ(show(model, kept).material, "Lambert");
  EXPECT_EQ(show(model, kept).x, 2);
}

} // namespace
} // namespace rtsl::scene
