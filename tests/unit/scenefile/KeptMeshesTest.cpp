//===- KeptMeshesTest.cpp -------------------------------------------------===//
#include "tests/unit/scenefile/Folder.h"

#include "scenefile/files/KeptMeshes.h"
#include "scenefile/files/MeshFiles.h"

#include <gtest/gtest.h>

namespace rtsl::scene {
namespace {

namespace fs = std::filesystem;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string other = "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n"; // as long

const auto start = fs::file_time_type::clock::now() - std::chrono::hours(1);

/// The x of the second vertex of an object's mesh.
float readThrough(const std::shared_ptr<KeptMeshes> &kept, const std::string &path,
                  const runtime::MeshRequest &request = {}) {
  SceneDescription description;
  description.keptMeshes = kept;
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
TEST(KeptMeshes, FilesThatChangedAreReadAgain) {
  const test::Folder folder;
  const std::string path = folder.path + "/mesh.obj";
  const auto kept = std::make_shared<KeptMeshes>();
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

TEST(KeptMeshes, FilesThatMayHaveOthersBesideThemAreReadEachTime) {
  const test::Folder folder;
  const std::string path = folder.path + "/mesh.stl";
  const auto write = [&](const char *x) {
    folder.write("mesh.stl", std::string("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                         "vertex ") +
                                 x + " 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
    fs::last_write_time(path, start);
  };
  const auto kept = std::make_shared<KeptMeshes>();
  write("1");
  EXPECT_EQ(readThrough(kept, path), 1);
  write("2");
  EXPECT_EQ(readThrough(kept, path), 2);
}

} // namespace
} // namespace rtsl::scene
