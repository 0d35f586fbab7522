#include "ErrorText.h"
#include "tests/unit/runtime/FakeProgram.h"

#include "scenefile/SceneFile.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <fstream>

using namespace rtsl::scene;
using rtsl::scene::test::errorOf;
namespace fake = rtsl::runtime::test;
using rtsl::runtime::Scene;

namespace {

std::string withCamera(const std::string &more) {
  return "{\"rtsl\": 1, \"camera\": {\"class\": \"Camera\", \"eye\": [0, 0, 5], \"gaze\": [0, 0, "
         "-1], \"up\": [0, 1, 0]},\n" +
         more + "}";
}

Scene build(const std::string &more) {
  return buildScene(parseScene(withCamera(more), "s.json"), fake::fakeProgram());
}

std::string buildError(const std::string &more) {
  return errorOf([&] { build(more); });
}

/// A scene with one object of class Everything with these members.
std::string everything(const std::string &members) {
  return "\"materials\": {\"e\": {\"class\": \"Everything\",\n" + members + "}}";
}

} // namespace

TEST(BuildScene, PutsValuesAtTheProgramsOffsets) {
  Scene scene =
      build("\"materials\": {\"red\": {\"class\": \"Lambert\", \"albedo\": [1, 0.5, 0.25]}, "
            "\"dull\": {\"class\": \"Lambert\"}},"
            "\"objects\": [{\"primitive\": {\"class\": \"Sphere\", \"constructor\": {\"radius\": "
            "2, \"center\": [1, 2, 3]}}, \"material\": \"red\"},"
            "{\"primitive\": {\"class\": \"Sphere\", \"constructor\": [[0, 0, 0], 1]}, "
            "\"material\": \"dull\"}],"
            "\"lights\": [{\"class\": \"Light\", \"position\": [0, 9, 0], \"intensity\": 4}],"
            "\"background\": [0.1, 0.2, 0.3], \"ambient\": 0.5");
  RtslLaunch launch = scene.launch();
  ASSERT_EQ(launch.instanceCount, 2u);
  const auto &sphere =
      *reinterpret_cast<const fake::SphereRecord *>(launch.records + launch.instances[0].primitive);
  EXPECT_EQ(sphere.id, unsigned(fake::sphereId));
  EXPECT_EQ(sphere.center[1], 2);
  EXPECT_EQ(sphere.radius, 2);
  const auto &red =
      *reinterpret_cast<const fake::LambertRecord *>(launch.records + launch.instances[0].material);
  EXPECT_EQ(red.albedo[2], 0.25f);
  const auto &dull =
      *reinterpret_cast<const fake::LambertRecord *>(launch.records + launch.instances[1].material);
  EXPECT_EQ(dull.albedo[2], 0.5f); // its default
  const auto &light =
      *reinterpret_cast<const fake::LightRecord *>(launch.records + launch.lights[0]);
  EXPECT_EQ(light.intensity[1], 4); // one number for all components
  EXPECT_EQ(launch.backgroundColor[2], 0.3f);
  EXPECT_EQ(launch.ambient[0], 0.5f);
  EXPECT_TRUE(scene.warnings().empty());
}

TEST(BuildScene, StoresEveryType) {
  Scene scene = build("\"materials\": {\"z\": {\"class\": \"Mirror\"}, \"e\": {\"class\": "
                      "\"Everything\", \"f\": 1.5, \"i\": -3, \"u\": 4000000000, \"b\": true,"
                      "\"v\": [1, 2, 3], \"m\": [[1, 2, 3], [4, 5, 6]], \"c\": [7, 8, 9], \"a\": "
                      "[[1, 2, 3], [4, 5, 6]],"
                      "\"buffer\": [[1, 2, 3], [4, 5, 6]], \"grid\": [[[1, 0, 0], [2, 0, 0], [3, "
                      "0, 0]], [[4, 0, 0], [5, 0, 0], [6, 0, 0]]],"
                      "\"other\": \"z\"}}, \"objects\": [{\"primitive\": {\"class\": \"Sphere\", "
                      "\"constructor\": [[0, 0, 0], 1]}, \"material\": \"e\"}]");
  RtslLaunch launch = scene.launch();
  const std::uint8_t *record = launch.records + launch.instances[0].material;
  auto floatAt = [&](int offset) {
    float value;
    std::memcpy(&value, record + offset, 4);
    return value;
  };
  auto wordAt = [&](int offset) {
    std::uint32_t value;
    std::memcpy(&value, record + offset, 4);
    return value;
  };
  EXPECT_EQ(floatAt(4), 1.5f);
  EXPECT_EQ(std::int32_t(wordAt(8)), -3);
  EXPECT_EQ(wordAt(12), 4000000000u);
  EXPECT_EQ(wordAt(16), 1u);
  EXPECT_EQ(floatAt(28), 3);
  EXPECT_EQ(floatAt(32 + 12), 4); // the second column of the matrix
  EXPECT_EQ(floatAt(64), 9);
  EXPECT_EQ(floatAt(68 + 20), 6);
  RtslBuffer buffer, grid;
  std::memcpy(&buffer, record + 92, sizeof buffer);
  std::memcpy(&grid, record + 112, sizeof grid);
  EXPECT_EQ(buffer.size[0], 2u);
  EXPECT_EQ(grid.size[0], 2u); // the first index is the slowest
  EXPECT_EQ(grid.size[1], 3u);
  const float *elements =
      reinterpret_cast<const float *>(std::uint64_t(grid.addressHigh) << 32 | grid.addressLow);
  EXPECT_EQ(elements[3 * (1 * 3 + 2)], 6);
  EXPECT_EQ(scene.classOf(wordAt(132)).name, "Mirror");
}

TEST(BuildScene, WrongValuesAreShownWhereTheyStand) {
  EXPECT_EQ(buildError(everything("\"f\": [1]")),
            "s.json:3:6+1: wrongType: member `f` of `e` is a `float`, not a list");
  EXPECT_EQ(buildError(everything("\"f\": \"red\"")),
            "s.json:3:7+3: wrongType: member `f` of `e` is a `float`, not a string");
  EXPECT_EQ(
      buildError(everything("\"f\": 1e40")),
      "s.json:3:6+4: outOfRange: member `f` of `e` cannot be 1e+40: the largest float is 3.4e38");
  EXPECT_EQ(buildError(everything("\"i\": 1.5")),
            "s.json:3:6+3: wrongType: member `i` of `e` takes whole numbers, not 1.5");
  EXPECT_EQ(buildError(everything("\"u\": -1")),
            "s.json:3:6+2: outOfRange: member `u` of `e` cannot be -1: it must be between 0 and "
            "4294967295");
  EXPECT_EQ(buildError(everything("\"b\": 1")),
            "s.json:3:6+1: wrongType: member `b` of `e` is a `bool`, not a number");
  EXPECT_EQ(buildError(everything("\"v\": [1, 2]")),
            "s.json:3:6+1: wrongType: member `v` of `e` is a `vec3` and takes 3 numbers, not 2");
  EXPECT_EQ(buildError(everything("\"v\": [1, 2, true]")),
            "s.json:3:13+4: wrongType: member `v` of `e` is a `vec3`, not a truth value");
  EXPECT_EQ(buildError(everything("\"c\": [1, 2]")),
            "s.json:3:6+1: wrongType: member `c` of `e` is a color: it takes 3 numbers or one for "
            "all, not 2 numbers");
  EXPECT_EQ(buildError(everything("\"a\": [[1, 2, 3], [4, 5]]")),
            "s.json:3:18+1: wrongType: member `a` of `e` takes 3 elements, not 2");
  EXPECT_EQ(
      buildError(everything("\"grid\": [[[1, 2, 3]], []]")),
      "s.json:3:23+1: wrongType: member `grid` of `e` has rows of different lengths: 1 and 0");
  EXPECT_EQ(buildError(everything("\"f\": null")),
            "s.json:3:6+4: wrongType: member `f` of `e` cannot be null");
}

TEST(BuildScene, NamesThatAreNotThere) {
  EXPECT_EQ(buildError(everything("\"grd\": 1")),
            "s.json:3:2+3: unknownMember: class `Everything` has no member `grd` (fix `grid`)");
  EXPECT_EQ(buildError(everything("\"hidden\": 1")),
            "s.json:3:2+6: notSettable: member `hidden` of `Everything` is not public");
  EXPECT_EQ(buildError("\"materials\": {\"m\": {\"class\": \"Lamber\"}}"),
            "s.json:2:31+6: unknownClass: no class is named `Lamber` (fix `Lambert`)");
  EXPECT_EQ(
      buildError(
          "\"materials\": {\"mirror\": {\"class\": \"Mirror\"}}, \"objects\": [\n{\"primitive\": "
          "{\"class\": \"Sphere\", \"constructor\": [[0,0,0],1]}, \"material\": \"miror\"}]"),
      "s.json:3:77+5: unknownName: no texture or material is named `miror` (fix `mirror`)");
}

TEST(BuildScene, ConstructorArguments) {
  auto sphere = [](const std::string &arguments) {
    return buildError(
        "\"materials\": {\"m\": {\"class\": \"Mirror\"}}, \"objects\": [\n{\"material\": \"m\", "
        "\"primitive\": {\"class\": \"Sphere\", \"constructor\": " +
        arguments + "}}]");
  };
  const std::string declared = " (note it is declared as `Sphere(vec3 center, float radius)`)";
  EXPECT_EQ(sphere("[[0, 0, 0]]"),
            "s.json:3:43+6: badArguments: the constructor of `Sphere` takes 2 arguments, not 1" +
                declared);
  EXPECT_EQ(
      sphere("{\"center\": [0, 0, 0]}"),
      "s.json:3:43+6: badArguments: the constructor of `Sphere` requires an argument for `radius`" +
          declared);
  const std::string beside = " (note arguments are in `constructor`, not beside it: "
                             "`\"constructor\": {\"PARAMETER\": VALUE, ...}`)";
  EXPECT_EQ(
      sphere("{\"center\": [0, 0, 0]}, \"radius\": 1"),
      "s.json:3:43+6: badArguments: the constructor of `Sphere` requires an argument for `radius`" +
          declared + beside);
  EXPECT_EQ(sphere("{\"center\": [0, 0, 0], \"radus\": 1}"),
            "s.json:3:90+5: badArguments: the constructor of `Sphere` has no parameter `radus` "
            "(fix `radius`)" +
                declared);
  EXPECT_EQ(sphere("[[0, 0, 0], \"big\"]"),
            "s.json:3:80+3: wrongType: argument 2 of `Sphere` is a `float`, not a string");
  EXPECT_EQ(buildError("\"materials\": {\"m\": {\"class\": \"Lambert\", \"constructor\": [1]}}"),
            "s.json:2:31+7: badArguments: class `Lambert` has no constructor; set its public "
            "members by name");
}

TEST(BuildScene, ClassesInTheWrongPlace) {
  EXPECT_EQ(buildError("\"lights\": [{\"class\": \"Mirror\"}]"),
            "s.json:2:23+6: wrongClass: `Mirror (lights.0)` is a `Mirror`, where an `rt_Light` is "
            "needed");
  EXPECT_EQ(
      buildError("\"textures\": {\"sky\": {\"class\": \"Sky\", \"low\": 1, \"high\": 1}}, "
                 "\"objects\": [\n{\"primitive\": {\"class\": \"Sphere\", \"constructor\": "
                 "[[0,0,0],1]}, \"material\": \"sky\"}]"),
      "s.json:3:77+3: wrongClass: `sky` is a `Sky`, an `rt_Miss`, where a material is needed");
  EXPECT_EQ(buildError("\"textures\": {\"sky\": {\"class\": \"Sky\", \"low\": 1, \"high\": 1}},\n" +
                       everything("\"other\": \"sky\"")),
            "s.json:4:11+3: wrongClass: member `other` of `e` takes an `rt_Material`, not a `Sky`");
  EXPECT_EQ(buildError("\"background\": [1, 2]"),
            "s.json:2:15+1: wrongType: the background is a color: it takes 3 numbers or one for "
            "all, not 2 numbers");
}

TEST(BuildScene, CyclesAreFound) {
  EXPECT_EQ(buildError("\"materials\": {\"a\": {\"class\": \"Everything\", \"other\": "
                       "\"b\"},\n\"b\": {\"class\": \"Everything\", \"other\": \"a\"}}"),
            "s.json:3:40+1: referenceCycle: `a` refers to itself indirectly");
}

TEST(BuildScene, ObjectsMayBeWrittenInPlace) {
  Scene scene = build("\"objects\": [{\"primitive\": {\"class\": \"Sphere\", \"constructor\": "
                      "[[0,0,0],1]}, \"material\": {\"class\": \"Everything\", \"other\": "
                      "{\"class\": \"Lambert\", \"albedo\": 0.75}}}]");
  RtslLaunch launch = scene.launch();
  std::uint32_t other;
  std::memcpy(&other, launch.records + launch.instances[0].material + 132, 4);
  EXPECT_EQ(reinterpret_cast<const fake::LambertRecord *>(launch.records + other)->albedo[0],
            0.75f);
}

TEST(BuildScene, DegeneratePrimitives) {
  auto boxed = [](const std::string &lower, const std::string &upper) {
    return "\"materials\": {\"m\": {\"class\": \"Mirror\"}}, \"objects\": [\n{\"name\": \"thing\", "
           "\"material\": \"m\", \"primitive\": {\"class\": \"Boxed\", \"lower\": " +
           lower + ", \"upper\": " + upper + "}}]";
  };
  EXPECT_EQ(buildError(boxed("[0, 1, 0]", "[1, 0, 1]")),
            "s.json:3:60+5: degenerateGeometry: the bounds of primitive `thing` are inverted: y "
            "runs from 1 to 0");
  Scene flat = build(boxed("[0, 0, 0]", "[1, 0, 1]")); // an upright or lying rectangle is fine
  EXPECT_TRUE(flat.warnings().empty());
  Scene point =
      build("\"materials\": {\"m\": {\"class\": \"Mirror\"}}, \"objects\": [\n{\"material\": "
            "\"m\", \"primitive\": {\"class\": \"Sphere\", \"constructor\": [[1, 2, 3], 0]}}]");
  ASSERT_EQ(point.warnings().size(), 1u);
  EXPECT_EQ(point.warnings()[0].message,
            "primitive `Sphere (objects.0)` is a single point: no ray can hit it");
  EXPECT_EQ(point.warnings()[0].place->line, 3u);
}

TEST(BuildScene, MembersThatAreReadMustBeSet) {
  EXPECT_EQ(buildError("\"background\": {\"class\": \"Sky\", \"low\": 1}"),
            "s.json:2:26+3: missingMember: member `high` of `background` is read, but not set and "
            "without a default: set it, or a variable of this name in the scene");
}

TEST(BuildScene, MeshErrorsPointIntoTheScene) {
  EXPECT_EQ(
      buildError("\"materials\": {\"m\": {\"class\": \"Mirror\"}}, \"objects\": [\n{\"mesh\": "
                 "\"nowhere.ply\", \"material\": \"m\"}]"),
      "s.json:3:11+11: fileNotFound: cannot read mesh `nowhere.ply`: No such file or directory");
}

TEST(BuildScene, AMeshThatStandsTwiceIsHeldOnce) {
  std::string path = ::testing::TempDir() + "buildSceneTest.obj";
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::string object = "{\"mesh\": \"" + path + "\", \"material\": \"m\"";
  Scene scene =
      build("\"materials\": {\"m\": {\"class\": \"Mirror\"}}, \"objects\": [" + object + "}," +
            object + "}," + object + ", \"transform\": {\"translate\": [5, 0, 0]}}]");
  RtslLaunch launch = scene.launch();
  EXPECT_EQ(launch.instanceCount, 3u);
  EXPECT_EQ(launch.meshCount, 2u);
  EXPECT_EQ(launch.meshes[launch.instances[2].mesh].positions[0], 5);
  std::remove(path.c_str());
}

TEST(BuildScene, TellsAllThatIsWrongInOneRun) {
  // References to a rejected object cause no further errors.
  EXPECT_EQ(
      buildError(
          "\"materials\": {\"bad\": {\"class\": \"Lambert\",\n\"albeda\": 1, \"colour\": 2},\n"
          "\"m\": {\"class\": \"Mirror\"}},\n\"objects\": [\n"
          "{\"material\": \"bad\", \"primitive\": {\"class\": \"Sphere\", \"constructor\": [[1, 2, "
          "3], 1]}},\n"
          "{\"material\": \"n\", \"mesh\": \"nowhere.ply\"},\n"
          "{\"material\": \"m\", \"mesh\": \"nowhere.ply\"}],\n"
          "\"background\": {\"class\": \"Skye\"}"),
      "s.json:3:2+6: unknownMember: class `Lambert` has no member `albeda` (fix `albedo`)\n"
      "s.json:3:15+6: unknownMember: class `Lambert` has no member `colour`\n"
      "s.json:7:15+1: unknownName: no texture or material is named `n`\n"
      "s.json:7:28+11: fileNotFound: cannot read mesh `nowhere.ply`: No such file or directory\n"
      "s.json:9:26+4: unknownClass: no class is named `Skye` (fix `Sky`)");
}
