#include "ErrorText.h"

#include "scenefile/SceneFile.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace rtsl::scene;
using rtsl::scene::test::errorOf;

namespace {

const char *camera = "\"rtsl\": 1, \"camera\": {\"class\": \"Camera\"}";

/// A scene with a camera and `more`, which begins on line 2.
std::string withCamera(const std::string &more) {
  return std::string("{") + camera + ",\n" + more + "}";
}

std::string parseError(const std::string &text, const std::vector<std::string> &overrides = {}) {
  return errorOf([&] { parseScene(text, "dir/s.json", overrides); });
}

} // namespace

TEST(SceneFile, ReadsEverySection) {
  SceneDescription scene = parseScene(R"({
  "$schema": "scene-schema.json",
  "rtsl": 1,
  "import": ["std.cameras", "glass.rtsl", "/abs/other.rtsl"],
  "camera": {"class": "PinholeCamera", "constructor": {"d": 2}},
  "textures": {"checks": {"class": "Checker", "scale": 4}},
  "materials": {"glass": {"class": "Glass", "constructor": [1.5]}, "clay": {"class": "Lambert", "albedo": "checks"}},
  "objects": [
    {"name": "ball", "primitive": {"class": "Sphere", "radius": 1}, "material": "glass"},
    {"mesh": "meshes/../teapot.ply", "material": {"class": "Phong"}, "transform": {"translate": [2, 0, 0]}}
  ],
  "lights": [{"class": "PointLight"}],
  "background": {"class": "Sky", "sun": {"class": "Sun"}},
  "ambient": 0.5,
  "render": {"engine": "classic", "size": [100, 50], "spp": 3, "depth": 2, "seed": 7}
})",
                                      "dir/s.json");
  ASSERT_EQ(scene.imports.size(), 3u);
  EXPECT_EQ(scene.imports[0].path, "");
  EXPECT_EQ(scene.imports[1].path, "dir/glass.rtsl");
  EXPECT_EQ(scene.imports[2].path, "/abs/other.rtsl");
  EXPECT_EQ(scene.camera.value().className.text, "PinholeCamera");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name.text, "ball");
  EXPECT_EQ(scene.objects[0].material.name.text, "glass");
  EXPECT_EQ(scene.objects[0].primitive->members[0].first.text, "radius");
  EXPECT_EQ(scene.objects[1].mesh.at(0).path, "dir/teapot.ply");
  EXPECT_EQ(scene.objects[1].transform.columns[3][0], 2);
  EXPECT_EQ(scene.render.width, 100u);
  EXPECT_EQ(scene.render.height, 50u);
  EXPECT_EQ(scene.render.samplesPerPixel, 3u);
  EXPECT_EQ(scene.render.depth, 2u);
  EXPECT_EQ(scene.render.seed, 7u);
  EXPECT_EQ(classesUsed(scene),
            (std::vector<std::string>{"Checker", "Glass", "Lambert", "Phong", "PinholeCamera",
                                      "PointLight", "Sky", "Sphere", "Sun"}));
}

TEST(SceneFile, DefaultsWhereTheFileIsSilent) {
  SceneDescription scene = parseScene(std::string("{") + camera + "}", "s.json");
  EXPECT_EQ(scene.render.width, 960u);
  EXPECT_EQ(scene.render.samplesPerPixel, 16u);
  EXPECT_EQ(scene.render.engine, rtsl::runtime::Engine::Classic);
}

TEST(SceneFile, MissingAndUnknownKeys) {
  EXPECT_EQ(
      parseError("{}"),
      "dir/s.json:1:1+1: missingKey: a scene begins with `\"rtsl\": 1`, the version of the format");
  EXPECT_EQ(
      parseError("{\"rtsl\": 2}"),
      "dir/s.json:1:10+1: notSupported: version 2 of the scene format is not supported, only 1 is");
  EXPECT_EQ(parseError("{\"rtsl\": 1}"), "dir/s.json:1:1+1: missingKey: a scene needs a `camera`");
  EXPECT_EQ(parseError(withCamera("  \"materails\": {}")),
            "dir/s.json:2:4+9: unknownKey: a scene has no key `materails` (fix `materials`)");
  EXPECT_EQ(parseError(withCamera("\"render\": {\"ssp\": 4}")),
            "dir/s.json:2:13+3: unknownKey: `render` has no key `ssp` (fix `spp`)");
  EXPECT_EQ(parseError(withCamera("\"objects\": [{\"material\": \"m\"}]")),
            "dir/s.json:2:13+1: missingKey: an object needs a `primitive` or a `mesh`");
  EXPECT_EQ(parseError(withCamera("\"objects\": [{\"mesh\": \"a.ply\"}]")),
            "dir/s.json:2:13+1: missingKey: an object needs a `material`");
  EXPECT_EQ(parseError(withCamera("\"lights\": [{\"clas\": \"L\"}]")),
            "dir/s.json:2:12+1: missingKey: a light needs a `class`");
}

TEST(SceneFile, WrongTypesAndRanges) {
  EXPECT_EQ(parseError("[]"), "dir/s.json:1:1+1: wrongType: a scene is an object, not a list");
  EXPECT_EQ(parseError(withCamera("\"objects\": {}")),
            "dir/s.json:2:12+1: wrongType: `objects` is a list, not an object");
  EXPECT_EQ(parseError(withCamera("\"render\": {\"spp\": 0}")),
            "dir/s.json:2:19+1: outOfRange: `spp` must be between 1 and 2147483647, not 0");
  EXPECT_EQ(parseError(withCamera("\"render\": {\"spp\": 1.5}")),
            "dir/s.json:2:19+3: wrongType: `spp` must be an integer, not 1.5");
  EXPECT_EQ(parseError(withCamera("\"render\": {\"size\": [4, 3, 2, 1]}")),
            "dir/s.json:2:20+1: wrongType: `size` takes 2 numbers, not 4");
  EXPECT_EQ(parseError(withCamera("\"render\": {\"engine\": \"bdpt\"}")),
            "dir/s.json:2:23+4: notSupported: there is no engine `bdpt`; there are `classic`, "
            "`programs`, `path`, `volume`, `occlusion`, `normals`, `depth`, `id`, `albedo`");
  EXPECT_EQ(parseError(withCamera("\"ambient\": \"red\"")),
            "dir/s.json:2:13+3: wrongType: `ambient` is a color, not a string");
  EXPECT_EQ(
      parseError(withCamera("\"materials\": {\"m\": {\"class\": \"M\", \"constructor\": 3}}")),
      "dir/s.json:2:50+1: wrongType: `constructor` is a list of arguments or an object of "
      "arguments by name, not a number");
}

TEST(SceneFile, TransformsOfPrimitivesPlaceThem) {
  const SceneDescription scene = parseScene(
      withCamera("\"objects\": [{\"primitive\": {\"class\": \"S\"}, \"material\": \"m\", "
                 "\"transform\": {\"translate\": [1, 2, 3]}}]"),
      "s.json");
  ASSERT_EQ(scene.objects[0].placements.size(), 1u);
  EXPECT_EQ(scene.objects[0].placements[0].transform.still().columns[3][2], 3);
  EXPECT_TRUE(scene.objects[0].transform.isIdentity());
}

TEST(SceneFile, NamesAreUniqueAcrossTexturesAndMaterials) {
  EXPECT_EQ(
      parseError(withCamera("\"textures\": {\"a\": {\"class\": \"T\"}},\n\"materials\": {\"a\": "
                            "{\"class\": \"M\"}}")),
      "dir/s.json:3:16+1: duplicateKey: `a` is already the name of a texture (2:19 the texture)");
}

TEST(SceneFile, TransformsComposeInOrder) {
  auto columns = [](const std::string &transform) {
    SceneDescription scene = parseScene(
        withCamera("\"objects\": [{\"mesh\": \"a.ply\", \"material\": \"m\", \"transform\": " +
                   transform + "}]"),
        "s.json");
    return scene.objects[0].transform.columns;
  };
  using Columns = decltype(columns(""));
  EXPECT_EQ(columns("{\"scale\": 2, \"translate\": [1, 2, 3], \"rotate\": {\"axis\": [0, 0, 2], "
                    "\"angle\": 90}}"),
            (Columns{{{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {1, 2, 3}}}));
  EXPECT_EQ(columns("[{\"translate\": [1, 0, 0]}, {\"scale\": [2, 3, 4]}]"),
            (Columns{{{2, 0, 0}, {0, 3, 0}, {0, 0, 4}, {2, 0, 0}}}));
  EXPECT_EQ(columns("{\"matrix\": [1,2,3,0, 4,5,6,0, 7,8,10,0, 11,12,13,1]}"),
            (Columns{{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}, {11, 12, 13}}}));
  EXPECT_EQ(columns("{\"rotate\": [90, 0, 0]}"),
            (Columns{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, 0}}}));

  auto error = [](const std::string &transform) {
    return parseError(withCamera(
        "\"objects\": [{\"mesh\": \"a\", \"material\": \"m\",\n\"transform\": " + transform +
        "}]"));
  };
  EXPECT_EQ(error("{\"scale\": [1, 0, 1]}"),
            "dir/s.json:3:14+1: outOfRange: this transform flattens its objects");
  EXPECT_EQ(error("{\"rotate\": {\"axis\": [0, 0, 0], \"angle\": 3}}"),
            "dir/s.json:3:34+1: outOfRange: the axis of a rotation has length 0");
  EXPECT_EQ(error("{\"move\": [0, 0, 0]}"),
            "dir/s.json:3:16+4: unknownKey: `transform` has no key `move`");
}

TEST(SceneFile, OverridesReachTheDescription) {
  SceneDescription scene =
      parseScene(withCamera("\"objects\": [{\"mesh\": \"a.ply\", \"material\": \"m\"}]"),
                 "dir/s.json", {"objects.0.mesh=b.ply", "render.spp=9"});
  EXPECT_EQ(scene.objects[0].mesh.at(0).path, "b.ply"); // as the shell's working directory sees it
  EXPECT_EQ(scene.render.samplesPerPixel, 9u);
  EXPECT_EQ(parseError(withCamera("\"ambient\": 1"), {"render.spp=0"}),
            "--set render.spp=0:1:18+1: outOfRange: `spp` must be between 1 and 2147483647, not 0");
  EXPECT_EQ(parseError(withCamera("\"ambient\": 1"), {"rendr.spp=1"}),
            "--set rendr.spp=1:1:7+5: unknownKey: a scene has no key `rendr` (fix `render`)");
}

TEST(SceneFile, MissingFile) {
  EXPECT_EQ(errorOf([] { readSceneFile("no/such/scene.json"); }),
            "no/such/scene.json: fileNotFound: cannot read `no/such/scene.json`: No such file or "
            "directory");
}

TEST(SceneFile, TellsAllThatIsWrongInOneRun) {
  EXPECT_EQ(
      parseError("{\"rtsl\": 1, \"camra\": {},\n"
                 "\"camera\": {\"klass\": \"C\"},\n"
                 "\"textures\": {\"a\": {\"class\": 1}, \"b\": {\"class\": \"B\"}},\n"
                 "\"materials\": {\"b\": {\"class\": \"B\"}, \"c\": 2},\n"
                 "\"objects\": [{\"mesh\": \"m.obj\", \"colour\": 1},\n"
                 "{\"material\": \"c\", \"mask\": -1}],\n"
                 "\"render\": {\"spp\": 0}}"),
      "dir/s.json:1:14+5: unknownKey: a scene has no key `camra` (fix `camera`)\n"
      "dir/s.json:2:11+1: missingKey: `camera` needs a `class`\n"
      "dir/s.json:3:29+1: wrongType: `class` is a string, not a number\n"
      "dir/s.json:4:16+1: duplicateKey: `b` is already the name of a texture (3:38 the texture)\n"
      "dir/s.json:4:41+1: wrongType: `c` is an object, not a number\n"
      "dir/s.json:5:32+6: unknownKey: an object has no key `colour`\n"
      "dir/s.json:5:13+1: missingKey: an object needs a `material`\n"
      "dir/s.json:6:1+1: missingKey: an object needs a `primitive` or a `mesh`\n"
      "dir/s.json:6:27+2: outOfRange: `mask` must be between 0 and 4294967295, not -1\n"
      "dir/s.json:7:19+1: outOfRange: `spp` must be between 1 and 2147483647, not 0");
}

TEST(SceneFile, TellsAllThatIsWrongWithTheSettings) {
  EXPECT_EQ(parseError(withCamera(
                "\"background\": \"blue\",\n\"render\": {\"engine\": \"paths\", \"size\": [0, 4], "
                "\"spp\": 0,\n\"depth\": 257, \"seed\": -1, \"shutter\": 3, \"lightSampler\": 1}")),
            "dir/s.json:2:16+4: wrongType: `background` is a color or an object of an `rt_Miss` "
            "class, such as {\"class\": \"blue\"}, not a string\n"
            "dir/s.json:4:38+1: wrongType: `shutter` is a list, not a number\n"
            "dir/s.json:4:57+1: wrongType: `lightSampler` is a string, not a number\n"
            "dir/s.json:3:23+5: notSupported: there is no engine `paths`; there are `classic`, "
            "`programs`, `path`, `volume`, `occlusion`, `normals`, `depth`, `id`, `albedo` (fix "
            "`path`)\n"
            "dir/s.json:3:40+1: outOfRange: the width must be between 1 and 65536, not 0\n"
            "dir/s.json:3:54+1: outOfRange: `spp` must be between 1 and 2147483647, not 0\n"
            "dir/s.json:4:10+3: outOfRange: `depth` must be between 0 and 256, not 257\n"
            "dir/s.json:4:23+2: outOfRange: `seed` must be between 0 and 4294967295, not -1");
}

TEST(SceneFile, StopsReadingBehindAHundredErrors) {
  std::string objects;
  for (int i = 0; i < 1000; ++i)
    objects += i ? ", 1" : "1";
  const std::string error = parseError(withCamera("\"objects\": [" + objects + "]"));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 99);
}
