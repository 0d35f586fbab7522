//===- MeshValuesTest.cpp - named attributes of meshes in scenes ----------===//
#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/support/Files.h"

#include <gtest/gtest.h>

#include <cstring>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using rtsl::test::errorOf;

namespace {

/// Materials of the class Normal read `wear`, a float, and `paint`, a color, of meshes.
std::shared_ptr<const Program> readingProgram() {
  auto program = std::make_shared<Program>(*fakeProgram());
  ValueType number, color;
  number.name = "float";
  color.name = "color";
  color.kind = ValueType::Kind::Color;
  program->meshAttributes = {{"wear", number, 2}, {"paint", color, 5}};
  for (ClassInfo &info : program->classes)
    if (info.name == "Normal")
      info.attributes = 3;
  return program;
}

Mesh triangle(std::vector<NamedAttribute> attributes) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2};
  mesh.attributes = std::move(attributes);
  return mesh;
}

struct Attributes : testing::Test {
  std::string errorWith(std::vector<NamedAttribute> attributes) {
    return errorOf([&] {
      scene.addMeshInstance(scene.addMesh(triangle(std::move(attributes)), "tile"), material);
    });
  }

  const NamedAttribute wear = floatAttribute("wear", 1, {0.5f, 1, 2}),
                       paint = floatAttribute("paint", 3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  Scene scene{readingProgram()};
  RtslRef material = scene.addObject("Normal", members({}), "worn");
};

TEST_F(Attributes, AreInTheLaunch) {
  ASSERT_EQ(errorWith({paint, floatAttribute("rest", 1, {0, 0, 0}), wear}), "no error");
  scene.setCamera(scene.addObject(
      "Camera",
      members({{"eye", vector(0, 0, 1)}, {"gaze", vector(0, 0, -1)}, {"up", vector(0, 1, 0)}})));
  const RtslLaunch launch = scene.launch();
  ASSERT_EQ(launch.meshAttributeCount, 2u);
  EXPECT_EQ(launch.meshAttributes[0].offset, 2u);
  EXPECT_EQ(launch.meshAttributes[1].words, launch.colorComponents);
  const RtslMeshValues *values = launch.meshes[0].attributes;
  ASSERT_NE(values, nullptr);
  float numbers[3];
  std::memcpy(numbers, values[0].values, sizeof numbers);
  EXPECT_EQ(numbers[2], 2);
  EXPECT_EQ(values[0].ofTriangles, 0u);
}

TEST_F(Attributes, ThatAreNotReadTakeNoMemory) {
  ASSERT_EQ(errorWith({paint, floatAttribute("rest", 1, {0, 0, 0}), wear}), "no error");
  auto program = std::make_shared<Program>(*readingProgram());
  program->keepsMeshes = program->keepsMeshAttributes = false;
  scene.useProgram(program);
  for (const MeshAttribute &attribute : scene.meshAttributes())
    EXPECT_EQ(attribute.isNeeded, attribute.name != "attribute `rest`") << attribute.name;
}

TEST_F(Attributes, MistakesAreErrors) {
  EXPECT_EQ(errorWith({wear}), "missingMember: `tile` has no attribute `paint`, which the material "
                               "`worn` reads as a `color`");
  EXPECT_EQ(errorWith({floatAttribute("wear", 2, {0, 0, 0, 0, 0, 0}), paint}),
            "wrongType: the attribute `wear` of `tile` is 2 floats for each vertex, and the "
            "material `worn` reads it as a `float`");
  EXPECT_EQ(
      errorWith({floatAttribute("wear", 1, {1, 2}), paint}),
      "badMesh: mesh `tile` has 2 numbers of the attribute `wear` for 3 vertices with 1 each");
  NamedAttribute normal = wear;
  normal.space = NamedAttribute::Space::Normal;
  EXPECT_EQ(errorWith({normal, paint}),
            "badMesh: mesh `tile` has an attribute `wear` of 1 numbers: a normal has 3 floats");
  NamedAttribute integers = wear;
  integers.kind = NamedAttribute::Kind::Int;
  EXPECT_EQ(errorWith({integers, paint}).substr(0, 66),
            "badMesh: mesh `tile` has an attribute `wear` of integers for each ");
  EXPECT_EQ(errorWith({floatAttribute("wear", 0, {}), paint}),
            "badMesh: mesh `tile` has an attribute `wear` of 0 numbers; at most 16 are possible");
}

} // namespace
