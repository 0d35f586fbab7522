#include "tests/unit/runtime/FakeProgram.h"

#include "report/measures/ErrorMetrics.h"
#include "runtime/device/organisations/SampleSums.h"
#include "runtime/render/Renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <thread>

namespace report = rtsl::report;
using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;

namespace {

RtslRef addCamera(Scene &scene, double distance = 5) {
  return scene.addObject("Camera", members({{"eye", vector(0, 1, distance)},
                                            {"gaze", vector(0, -0.2, -2)},
                                            {"up", vector(0, 1, 0)}}));
}

Mesh quad(float half, float y) {
  Mesh mesh;
  mesh.positions = {-half, y, -half, half, y, -half, half, y, half, -half, y, half};
  mesh.indices = {0, 2, 1, 0, 3, 2};
  return mesh;
}

/// A mirrored ball, matt balls and a floor under a light and a sky.
Scene room() {
  Scene scene(fakeProgram());
  scene.setCamera(addCamera(scene));
  RtslRef red = scene.addObject("Lambert", members({{"albedo", Value{0.8, 0.2, 0.1}}}), "red");
  RtslRef grey = scene.addObject("Lambert", members({}), "grey");
  RtslRef mirror = scene.addObject("Mirror", members({}), "mirror");
  scene.addPrimitive(scene.addObject("Sphere", {vector(-1, 1, 0), 1.0}), mirror);
  scene.addPrimitive(scene.addObject("Sphere", {vector(1.2, 0.7, 0.5), 0.7}), red);
  scene.addMeshInstance(scene.addMesh(quad(10, 0), "floor"), grey);
  scene.addLight(scene.addObject(
      "Light", members({{"position", vector(4, 6, 4)}, {"intensity", Value{60, 60, 60}}})));
  scene.setBackground(scene.addObject(
      "Sky", members({{"low", Value{0.7, 0.7, 0.7}}, {"high", Value{0.2, 0.4, 0.9}}})));
  return scene;
}

RenderOptions smallPicture() {
  RenderOptions options;
  options.width = 96;
  options.height = 64;
  options.samplesPerPixel = 4;
  return options;
}

} // namespace

TEST(Scene, AnInstanceNeedsWhatTheObjectsBehindItsMaterialNeed) {
  std::shared_ptr<Program> program = fakeProgram();
  for (ClassInfo &info : program->classes)
    info.needs = info.name == "Mirror"  ? RTSL_NEEDS_TEXTURE_COORDINATES
                 : info.name == "Noise" ? RTSL_NEEDS_DERIVATIVES
                                        : 0;
  Scene scene(program);
  const RtslRef mirror = scene.addObject("Mirror", members({})),
                noise = scene.addObject("Noise", members({}));
  const RtslRef ball = scene.addObject("Sphere", {vector(0, 0, 0), 1.0});
  const RtslRef first =
      scene.addObject("Everything", members({{"other", Value::reference(mirror)}}));
  const RtslRef second =
      scene.addObject("Everything", members({{"other", Value::reference(first)}}));
  const RtslRef third =
      scene.addObject("Everything", members({{"other", Value::reference(noise)}}));
  for (RtslRef material : {mirror, first, second, third})
    scene.addPrimitive(ball, material);
  scene.setCamera(addCamera(scene));
  const RtslInstance *instances = scene.launch().instances;
  EXPECT_EQ(instances[0].needs, RTSL_NEEDS_TEXTURE_COORDINATES);
  EXPECT_EQ(instances[1].needs, RTSL_NEEDS_TEXTURE_COORDINATES);
  EXPECT_EQ(instances[2].needs, RTSL_NEEDS_TEXTURE_COORDINATES); // two steps away
  EXPECT_EQ(instances[3].needs, RTSL_NEEDS_DERIVATIVES);
}

TEST(Renderer, EmbreeAndDeviceTraversalSeeTheSame) {
  Scene scene = room();
  RenderOptions options = smallPicture();
  RenderStatistics statistics;
  Image embree = render(scene, options, &statistics);
  EXPECT_EQ(statistics.samples, 96u * 64 * 4);
  EXPECT_EQ(statistics.badRays, 0u);
  EXPECT_EQ(statistics.samplesNotFinite, 0u);
  options.traversal = Traversal::Device;
  Image device = render(scene, options);
  report::ErrorMetrics difference = report::measureError(embree, device);
  EXPECT_LE(difference.pixelsThatDiffer, 2u);
  EXPECT_LT(difference.rmse, 1e-3);
  if (const char *path = std::getenv("RTSL_TEST_PICTURE"))
    writeImage(path, embree);
}

TEST(Renderer, PictureDoesNotDependOnThreads) {
  Scene scene = room();
  for (Traversal traversal : {Traversal::Embree, Traversal::Device}) {
    RenderOptions options = smallPicture();
    options.traversal = traversal;
    options.threads = 1;
    Image one = render(scene, options);
    options.threads = 7;
    Image seven = render(scene, options);
    EXPECT_EQ(report::measureError(one, seven).pixelsThatDiffer, 0u);
  }
}

TEST(Renderer, PictureDoesNotDependOnPixelsInTurns) {
  Scene scene = room();
  RenderOptions options = smallPicture();
  options.pixelsInTurns = 1;
  RenderStatistics statistics;
  const Image one = render(scene, options, &statistics);
  for (const std::uint32_t pixels : {2u, 3u, 8u}) {
    options.pixelsInTurns = pixels;
    for (const std::uint32_t threads : {1u, 5u}) {
      options.threads = threads;
      RenderStatistics inTurns;
      EXPECT_EQ(report::measureError(one, render(scene, options, &inTurns)).pixelsThatDiffer, 0u);
      EXPECT_EQ(inTurns.samples, statistics.samples);
      EXPECT_EQ(inTurns.pixels, statistics.pixels);
    }
  }
}

TEST(Renderer, SeedChangesTheNoiseAndNothingElse) {
  Scene scene = room();
  RenderOptions options = smallPicture();
  Image a = render(scene, options), b = render(scene, options);
  EXPECT_EQ(report::measureError(a, b).pixelsThatDiffer, 0u);
  options.seed = 2;
  Image c = render(scene, options);
  EXPECT_GT(report::measureError(a, c).pixelsThatDiffer, 100u);
  EXPECT_LT(report::measureError(a, c).rmse, 0.2);
}

TEST(Renderer, RowZeroIsTheTop) {
  Scene scene(fakeProgram());
  scene.setCamera(addCamera(scene));
  scene.setBackground(
      scene.addObject("Sky", members({{"low", Value{0, 0, 0}}, {"high", Value{1, 1, 1}}})));
  Image image = render(scene, smallPicture());
  EXPECT_GT(image.at(48, 0)[0], image.at(48, 63)[0] + 0.2f);
}

TEST(Renderer, ANoiseMaterialAveragesToOneHalf) {
  Scene scene(fakeProgram());
  scene.setCamera(addCamera(scene, 0));
  scene.addPrimitive(scene.addObject("Sphere", {vector(0, 0, 0), 100.0}),
                     scene.addObject("Noise", members({})));
  RenderOptions options = smallPicture();
  options.samplesPerPixel = 16;
  Image image = render(scene, options);
  double sum = 0;
  for (float value : image.pixels)
    sum += value;
  // The mean of n uniform numbers has deviation sqrt(1/12n).
  double n = double(image.pixels.size()) * options.samplesPerPixel;
  EXPECT_NEAR(sum / double(image.pixels.size()), 0.5, 5 * std::sqrt(1 / (12 * n)));
}

TEST(Renderer, DepthZeroSeesCameraRaysOnly) {
  Scene scene(fakeProgram());
  scene.setCamera(addCamera(scene));
  scene.addPrimitive(scene.addObject("Sphere", {vector(0, 1, 0), 2.0}),
                     scene.addObject("Mirror", members({})));
  scene.setBackgroundColor({0.25f});
  RenderOptions options = smallPicture();
  options.maxDepth = 0;
  Image none = render(scene, options);
  EXPECT_EQ(none.at(48, 32)[0], 0.0f); // no background after the last bounce
  EXPECT_EQ(none.at(0, 0)[0], 0.25f);
  options.maxDepth = 1;
  Image one = render(scene, options);
  EXPECT_EQ(one.at(48, 32)[0], 0.25f);
}

TEST(Renderer, ProgressReachesOneAndCancellingStops) {
  Scene scene = room();
  RenderOptions options = smallPicture();
  double last = 0;
  bool ascending = true;
  options.progress = [&](double share) {
    ascending &= share >= last;
    last = share;
  };
  render(scene, options);
  EXPECT_TRUE(ascending);
  EXPECT_EQ(last, 1.0);

  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  options.progress = [&](double) { cancel = true; };
  try {
    render(scene, options);
    FAIL() << "it went on";
  } catch (const Error &error) {
    EXPECT_EQ(error.code, ErrorCode::Cancelled);
  }
}

TEST(Renderer, WhatIsCancelledCanBeKept) {
  Scene scene = room();
  RenderOptions options = smallPicture();
  const Image whole = render(scene, options);
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  options.keepsUnfinished = true;
  options.progress = [&](double share) { cancel = share > 0.3; };
  RenderStatistics statistics;
  const Image part = render(scene, options, &statistics);
  EXPECT_TRUE(statistics.isUnfinished);
  EXPECT_GT(statistics.pixels, 96u * 64 / 4);
  EXPECT_LT(statistics.pixels, 96u * 64);
  EXPECT_GE(statistics.samples, 4 * statistics.pixels);
  // What is done is done; where nothing is, the picture is black.
  std::size_t same = 0;
  for (std::size_t i = 0; i < whole.pixels.size(); i += 3)
    same += std::equal(&whole.pixels[i], &whole.pixels[i] + 3, &part.pixels[i]);
  EXPECT_GE(same, statistics.pixels);
}

/// Samples that are infinite, in column 0 all of them, in the others each fourth.
void spoilt(const RtslLaunch *, std::uint32_t x, std::uint32_t, std::uint32_t sample,
            float *color) {
  const bool isBad = x == 0 || sample % 4 == 2;
  color[0] = color[2] = 0.25f * float(sample % 4);
  color[1] = isBad ? std::numeric_limits<float>::infinity() : 1.0f;
}

TEST(Renderer, SamplesThatAreNotFiniteAreLeftOut) {
  const std::shared_ptr<Program> program = fakeProgram();
  program->sample = spoilt;
  Scene scene(program);
  scene.setCamera(addCamera(scene));
  RenderOptions options = smallPicture();
  options.samplesPerPixel = 8;
  options.withoutSample = 7;
  for (unsigned threads : {1u, 5u}) {
    options.threads = threads;
    RenderStatistics statistics;
    const Image image = render(scene, options, &statistics);
    EXPECT_EQ(statistics.samplesNotFinite, 64u * 8 + 95u * 64 * 2);
    EXPECT_EQ(statistics.pixelsWithoutSample, 64u);
    EXPECT_EQ(image.at(0, 5)[1], 7.0f);
    EXPECT_EQ(image.at(5, 5)[0], float(0.25 * (0 + 1 + 3) / 3));
    EXPECT_EQ(image.at(5, 5)[1], 1.0f);
    ASSERT_EQ(statistics.notFinite.size(), std::size_t(RTSL_FIRST_NOT_FINITE));
    for (std::uint32_t i = 0; i < RTSL_FIRST_NOT_FINITE; ++i) {
      EXPECT_EQ(statistics.notFinite[i].x, 0u);
      EXPECT_EQ(statistics.notFinite[i].y, 0u);
      EXPECT_EQ(statistics.notFinite[i].sample, i);
    }
  }
  options.mostNotFinite = 100000;
  RenderStatistics statistics;
  render(scene, options, &statistics);
  EXPECT_EQ(statistics.notFinite.size(), statistics.samplesNotFinite);
  EXPECT_TRUE(std::is_sorted(statistics.notFinite.begin(), statistics.notFinite.end()));
}

TEST(Renderer, LanesKeepTheFirstSamplesThatAreNotFinite) {
  constexpr unsigned threads = 4, each = 5000;
  RtslStatus status{};
  std::vector<std::thread> lanes;
  for (unsigned lane = 0; lane < threads; ++lane)
    lanes.emplace_back([&, lane] {
      std::vector<std::uint64_t> samples(each);
      for (unsigned i = 0; i < each; ++i)
        samples[i] = 10 + threads * i + lane;
      std::shuffle(samples.begin(), samples.end(), std::mt19937(lane));
      for (std::uint64_t sample : samples)
        rtsl::device::noteNotFinite(status, sample);
    });
  for (std::thread &lane : lanes)
    lane.join();
  for (unsigned i = 0; i < RTSL_FIRST_NOT_FINITE; ++i)
    EXPECT_EQ(status.firstNotFinite[i], ~std::uint64_t(10 + i));
}

TEST(Renderer, RefusesOptionsOutOfRange) {
  Scene scene = room();
  auto codeOf = [&](auto change) {
    RenderOptions options = smallPicture();
    change(options);
    try {
      render(scene, options);
    } catch (const Error &error) {
      return std::string(name(error.code)) + ": " + error.what();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(codeOf([](RenderOptions &o) { o.samplesPerPixel = 0; }),
            "outOfRange: the number of samples per pixel must be between 1 and 2147483647, not 0");
  EXPECT_EQ(codeOf([](RenderOptions &o) { o.width = 0; }),
            "outOfRange: the width must be between 1 and 65536, not 0");
  EXPECT_EQ(codeOf([](RenderOptions &o) { o.maxDepth = 1000; }),
            "outOfRange: the depth must be between 0 and 256, not 1000");
  EXPECT_EQ(codeOf([](RenderOptions &o) { o.height = 7, o.slices = 2; }),
            "outOfRange: 7 rows do not divide into 2 slices");
  EXPECT_EQ(codeOf([](RenderOptions &o) { o.slices = 0; }),
            "outOfRange: the number of slices must be between 1 and 65536, not 0");
}

TEST(Renderer, BadRaysAreCountedAndBlack) {
  Scene scene(fakeProgram());
  scene.setCamera(scene.addObject(
      "Camera",
      members({{"eye", vector(NAN, 0, 0)}, {"gaze", vector(0, 0, -1)}, {"up", vector(0, 1, 0)}})));
  scene.setBackgroundColor({1, 1, 1});
  for (Traversal traversal : {Traversal::Embree, Traversal::Device}) {
    RenderOptions options = smallPicture();
    options.traversal = traversal;
    RenderStatistics statistics;
    Image image = render(scene, options, &statistics);
    EXPECT_EQ(statistics.badRays, statistics.samples);
    EXPECT_EQ(image.at(3, 3)[0], 0.0f);
  }
}

TEST(Renderer, ASceneWithoutACameraIsRefused) {
  Scene scene(fakeProgram());
  try {
    render(scene, smallPicture());
    FAIL();
  } catch (const Error &error) {
    EXPECT_EQ(error.code, ErrorCode::IncompleteScene);
  }
}
