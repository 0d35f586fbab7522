#include "scenefile/files/PlacedMesh.h"
#include "runtime/geometry/Transform.h"

#include <gtest/gtest.h>

#include <random>

using namespace rtsl::scene;
using rtsl::runtime::Mesh;
using rtsl::runtime::Transform;

namespace {

/// Vertices in [-1, 1].
Mesh scattered() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  Mesh mesh;
  for (int i = 0; i < 300; ++i)
    mesh.positions.push_back(coordinate(random));
  return mesh;
}

const Transform turn = Transform::rotate({1, 2, 3}, 40);

} // namespace

TEST(PlacedMesh, StaysAccurateNearTheOrigin) {
  EXPECT_TRUE(staysAccurate(scattered(), turn));
  EXPECT_TRUE(staysAccurate(scattered(), turn.then(Transform::translate(5, -5, 5))));
  EXPECT_TRUE(staysAccurate(scattered(), Transform::scale(1e-3, 1e3, 1).then(turn)));
}

TEST(PlacedMesh, IsTooCoarseFarAway) {
  for (const double way : {30.0, 1e3, 1e8, 1e30})
    for (const Transform &there :
         {Transform::translate(way, 0, 0), Transform::translate(0, -way, 0),
          Transform::translate(0, 0, way)})
      EXPECT_FALSE(staysAccurate(scattered(), turn.then(there))) << way;
}

TEST(PlacedMesh, FarAwayIsFineForNumbersThatFloatsHold) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 4, 0, 0, 0, 3, 0};
  EXPECT_TRUE(staysAccurate(mesh, Transform::translate(1e6, 7, -3e5)));
  EXPECT_FALSE(staysAccurate(mesh, Transform::translate(1e6 + 0.01, 7, -3e5)));
}

TEST(PlacedMesh, MustBeOfModerateSize) {
  for (const double scale : {1e-30, 1e-15, 1e15, 1e39, 1e300, std::nan("")})
    EXPECT_FALSE(staysAccurate(scattered(), Transform::scale(scale, scale, scale))) << scale;
  EXPECT_FALSE(staysAccurate(scattered(), Transform::scale(1, 1, 1e-9))); // an error of its own
  EXPECT_FALSE(staysAccurate(scattered(), Transform::scale(1, 0, 1)));
}

TEST(PlacedMesh, NormalsBetweenVerticesKeepTheirDirections) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 4, 0, 0, 0, 3, 0};
  mesh.normals = {0.6f, 0, 0.8f, 0, 0.6f, 0.8f, 0, 0, 1};
  const Transform stretch = Transform::scale(2, 0.5, 1);
  ASSERT_TRUE(place(mesh, stretch));
  const float sum[3] = {0.6f, 0.6f, 0.8f + 0.8f + 1.0f}; // of the normals in the file
  const float ratio = (mesh.normals[0] + mesh.normals[3] + mesh.normals[6]) / (sum[0] / 2);
  EXPECT_NEAR((mesh.normals[1] + mesh.normals[4] + mesh.normals[7]) / (sum[1] / 0.5f), ratio, 1e-6);
  EXPECT_NEAR((mesh.normals[2] + mesh.normals[5] + mesh.normals[8]) / sum[2], ratio, 1e-6);
}

TEST(PlacedMesh, AttributesThatAreNormalsKeepItInItsSpace) {
  Mesh mesh = scattered();
  mesh.attributes.emplace_back();
  mesh.attributes.back().components = 3;
  mesh.attributes.back().space = rtsl::runtime::NamedAttribute::Space::Normal;
  EXPECT_FALSE(place(mesh, turn));
}
