//===- GltfAnimationTest.cpp - key frames of glTF files -------------------===//
#include "ErrorText.h"
#include "GltfFiles.h"

#include "scenefile/SceneFile.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::scene;
using namespace rtsl::scene::test;

namespace {

/// The square with one animated node. `sampler` is what its sampler has beside the accessors: 2 are
/// the times, 3 the values.
std::string animated(const std::string &path, const std::vector<float> &times,
                     const std::vector<float> &values, const std::string &sampler = "",
                     const std::string &node = R"({"mesh": 0})") {
  const std::size_t width = path == "rotation" ? 4 : path == "weights" ? 1 : 3;
  const std::size_t timeBytes = 4 * times.size();
  std::string file = squareFile(
      node,
      R"(, "animations": [{"name": "Walk", "samplers": [{"input": 2, "output": 3)" + sampler +
          R"(}], "channels": [{"sampler": 0, "target": {"node": 0, "path": ")" + path + "\"}}]}]",
      square() + bytesOf(times) + bytesOf(values));
  const auto replace = [&](const std::string &from, const std::string &to) {
    file.replace(file.find(from), from.size(), to);
  };
  replace(R"("max": [1, 1, 0]})", fmt::format(R"("max": [1, 1, 0]}},
{{"bufferView": 2, "componentType": 5126, "count": {}, "type": "SCALAR"}},
{{"bufferView": 3, "componentType": 5126, "count": {}, "type": "{}"}})",
                                              times.size(), values.size() / width,
                                              width == 4   ? "VEC4"
                                              : width == 1 ? "SCALAR"
                                                           : "VEC3"));
  replace(R"("byteLength": 48})",
          fmt::format(R"("byteLength": 48}}, {{"buffer": 0, "byteOffset": 60, "byteLength": {}}},
{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})",
                      timeBytes, 60 + timeBytes, 4 * values.size()));
  replace(R"("byteLength": 60)",
          fmt::format(R"("byteLength": {})", 60 + timeBytes + 4 * values.size()));
  return file;
}

class GltfAnimation : public testing::Test {
protected:
  SceneDescription scene(const std::string &model, const std::string &more,
                         const std::string &mention = "") {
    folder.write("m.gltf", model);
    return parseScene(R"({"rtsl": 1, "camera": {"class": "C"}, "objects": [{"model": "m.gltf")" +
                          mention + "}], " + more + "}",
                      folder.path + "/s.json");
  }

  runtime::MovingTransform transform(const std::string &model, const std::string &more,
                                     const std::string &mention = "") {
    return scene(model, more, mention).objects.at(0).placements.at(0).transform;
  }

  /// Where the node is at a frame.
  double x(const std::string &model, double frame, const std::string &mention = "") {
    return transform(model, fmt::format("\"frame\": {}", frame), mention).still().columns[3][0];
  }

  std::string error(const std::string &model, const std::string &mention = "") {
    return folder.without(errorOf([&] { scene(model, "\"frame\": 0", mention); }));
  }

  Folder folder;
};

const std::string shutter = R"(, "render": {"shutter": [0, 1]})";
const std::vector<float> there = {0, 0, 0, 6, 0, 0, 6, 3, 0};

} // namespace

TEST_F(GltfAnimation, KeyFramesAreInSeconds) {
  const std::string model = animated("translation", {0.5f, 1, 2}, there);
  EXPECT_EQ(x(model, 0), 0); // before the first
  EXPECT_NEAR(x(model, 18), 3, 1e-6);
  EXPECT_NEAR(x(model, 24), 6, 1e-6);
  EXPECT_EQ(x(model, 1000), 6);
  EXPECT_NEAR(x(model, 7.5, R"(, "fps": 10)"), 3, 1e-6);
}

TEST_F(GltfAnimation, StepsKeepTheLastKeyFrame) {
  const std::string model =
      animated("translation", {0.5f, 1, 2}, there, R"(, "interpolation": "STEP")");
  EXPECT_EQ(x(model, 23.9), 0);
  EXPECT_EQ(x(model, 24), 6);
}

TEST_F(GltfAnimation, SplinesHaveTangents) {
  // From 0 with slope 2 to 1 with slope -1, in two seconds.
  const std::string model =
      animated("translation", {0, 2}, {9, 9, 9, 0, 0, 0, 2, 0, 0, -1, 0, 0, 1, 0, 0, 9, 9, 9},
               R"(, "interpolation": "CUBICSPLINE")");
  const double s = 0.25;
  EXPECT_NEAR(x(model, 12),
              (s * s * s - 2 * s * s + s) * 4 + (3 - 2 * s) * s * s + (s * s * s - s * s) * -2,
              1e-6);
  EXPECT_NEAR(x(model, 48), 1, 1e-6);
}

TEST_F(GltfAnimation, RotationsTurnSteadily) {
  const float root = 0.70710678f;
  const std::string model = animated("rotation", {0, 3}, {0, 0, 0, 1, 0, 0, -root, -root});
  const auto columns = transform(model, "\"frame\": 24").still().columns;
  const double angle = 30 * 3.14159265358979 / 180; // a third of a quarter turn: the shorter way
  EXPECT_NEAR(columns[0][0], std::cos(angle), 1e-6);
  EXPECT_NEAR(columns[0][1], std::sin(angle), 1e-6);
}

TEST_F(GltfAnimation, NodesMoveWhileTheShutterIsOpen) {
  const std::string model =
      animated("translation", {0, 1, 2}, there, "", R"({"mesh": 0, "scale": [2, 2, 2]})");
  EXPECT_FALSE(transform(model, "\"frame\": 23.5").moves());
  const runtime::MovingTransform moving = transform(model, "\"frame\": 23.5" + shutter);
  ASSERT_TRUE(moving.moves());
  const auto at = [&](float time) { return moving.at(time).columns[3]; };
  EXPECT_NEAR(at(0)[0], 6 * 23.5 / 24, 1e-6);
  EXPECT_NEAR(at(0.5f)[0], 6, 1e-5); // the key frame between
  EXPECT_NEAR(at(0.5f)[1], 0, 1e-5);
  EXPECT_NEAR(at(1)[1], 3 * 0.5 / 24, 1e-6);
  EXPECT_NEAR(moving.at(0.7f).columns[0][0], 2, 1e-6);
  EXPECT_FALSE(transform(model, "\"frame\": 100" + shutter).moves()); // at rest
}

TEST_F(GltfAnimation, WeightsOfMorphTargetsChange) {
  std::string model = animated("weights", {0, 1, 2}, {0, 4, 2, 2, 2, 0});
  const std::string indices = "\"indices\": 0";
  model.replace(model.find(indices), indices.size(),
                indices + R"(, "targets": [{"POSITION": 1}, {"POSITION": 1}])");
  using Weights = std::vector<std::vector<double>>;
  const auto at = [&](double frame) {
    return scene(model, fmt::format("\"frame\": {}", frame)).objects.at(0).weights;
  };
  EXPECT_EQ(at(0), (Weights{{0, 4}}));
  EXPECT_EQ(at(12), (Weights{{1, 3}}));
  EXPECT_EQ(at(100), (Weights{{2, 0}}));
  // While the shutter is open, with the key frame between; at rest there is one list.
  const SceneDescription moving = scene(model, "\"frame\": 23.5" + shutter);
  ASSERT_EQ(moving.objects.at(0).weights.size(), 3u);
  EXPECT_NEAR(moving.objects[0].weights[0][0], 2 * 23.5 / 24, 1e-6);
  EXPECT_NEAR(moving.objects[0].weights[1][1], 2, 1e-5);
  EXPECT_NEAR(moving.objects[0].weights[2][1], 2 - 2 * 0.5 / 24, 1e-6);
  ASSERT_EQ(moving.objects[0].meshTimes.size(), 3u);
  EXPECT_NEAR(moving.objects[0].meshTimes[1], 0.5, 1e-6);
  EXPECT_EQ(scene(model, "\"frame\": 60" + shutter).objects.at(0).weights.size(), 1u);
}

TEST_F(GltfAnimation, CamerasMoveFromFrameToFrame) {
  folder.write("m.gltf", animated("translation", {0, 1}, {0, 0, 0, 6, 0, 0}, "",
                                  R"({"mesh": 0, "camera": 0})")
                             .insert(1, R"("cameras": [{"type": "perspective",
"perspective": {"yfov": 1, "znear": 0.1}}],)"));
  const auto eye = [&](int frame) {
    const SceneDescription described =
        parseScene(fmt::format(R"({{"rtsl": 1, "camera": {{"model": "m.gltf", "fps": 12}},
"objects": [{{"model": "m.gltf"}}], "frame": {}}})",
                               frame),
                   folder.path + "/s.json");
    return described.camera->constructor->find("eye")->elements[0].number;
  };
  EXPECT_NEAR(eye(0), 0, 1e-6);
  EXPECT_NEAR(eye(6), 3, 1e-6);
}

TEST_F(GltfAnimation, TheFirstIsShownUnlessOneIsNamed) {
  std::string model = animated("translation", {0, 1}, {0, 0, 0, 6, 0, 0});
  const std::string first = "\"animations\": [";
  model.insert(model.find(first) + first.size(),
               R"({"name": "Rest", "samplers": [], "channels": []}, )");
  const SceneDescription described = scene(model, "\"frame\": 24");
  EXPECT_EQ(described.objects[0].placements[0].transform.still().columns[3][0], 0);
  ASSERT_EQ(described.warnings.size(), 1u);
  EXPECT_NE(described.warnings[0].message.find("`animations.1` is not shown"), std::string::npos);
  EXPECT_NEAR(x(model, 24, R"(, "animation": "Walk")"), 6, 1e-6);
  EXPECT_NE(error(model, R"(, "animation": "Run")").find("has no animation `Run`"),
            std::string::npos);
}

TEST_F(GltfAnimation, WhatIsLeftOutIsNamed) {
  const auto warning = [&](const std::string &model) {
    const SceneDescription described = scene(model, "\"frame\": 24");
    EXPECT_EQ(described.warnings.size(), 1u);
    return described.warnings.empty() ? "" : described.warnings[0].message;
  };
  EXPECT_EQ(warning(animated("weights", {0, 1}, there)),
            "`animations.0.channels.0` is left out: `weights` of a node is not animated");
  EXPECT_EQ(warning(animated("scale", {0, 1, 2}, there, "",
                             R"({"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})")),
            "`animations.0.channels.0` is left out: `nodes.0` has a `matrix`");
}

TEST_F(GltfAnimation, LightsRestDuringAFrame) {
  std::string model =
      animated("translation", {0, 2}, {0, 0, 0, 6, 0, 0}, "",
               R"({"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}})");
  model.insert(1, R"("extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},)");
  const SceneDescription described = scene(model, "\"frame\": 24" + shutter);
  EXPECT_NEAR(described.objects[0].placements[0].transform.still().columns[3][0], 3, 1e-6);
  ASSERT_EQ(described.warnings.size(), 1u);
  EXPECT_EQ(described.warnings[0].message,
            "`nodes.0` does not move during the frame: there is a light in it");
}

TEST_F(GltfAnimation, MistakesAreAtTheirPlace) {
  const auto expect = [&](const std::string &model, const std::string &text,
                          const std::string &mention = "") {
    EXPECT_NE(error(model, mention).find(text), std::string::npos) << error(model, mention);
  };
  expect(animated("translation", {0, 1, 2}, {0, 0, 0, 1, 1, 1}),
         "has 2 values for 3 key frames, not 3");
  expect(animated("translation", {0, 1, 1}, there), "do not ascend");
  expect(animated("translation", {0, 1, 2}, there, R"(, "interpolation": "SPLINE")"),
         "`LINEAR`, `STEP` or `CUBICSPLINE`, not `SPLINE`");
  expect(animated("rotation", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1}),
         "the rotation of `nodes.0` is 0 at frame 0");
  expect(animated("translation", {0, 1, 2}, there), "`fps`", R"(, "fps": 0)");
  std::string file = animated("translation", {0, 1, 2}, there);
  file.replace(file.find("\"sampler\": 0"), 12, "\"sampler\": 3");
  expect(file, "`sampler` of `animations.0.channels.0` is 3, and there are 1");
}
