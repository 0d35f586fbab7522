// What every backend does alike, shown by the host's megakernel with a program of this file, and
// that a renderer can be used again.
#include "FakeProgram.h"

#include "runtime/render/HostMegakernel.h"
#include "runtime/render/Renderer.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

using namespace rtsl::runtime;
using rtsl::Error;
using rtsl::ErrorCode;

namespace {

std::atomic<unsigned> lanesBegun{0};

/// A lane of a program that paints (x, y, seed), and takes its time for a pixel if it has a depth,
/// in milliseconds.
void paint(const RtslJob *job, std::uint32_t) {
  ++lanesBegun;
  const RtslLaunch &launch = *job->launch;
  const std::uint64_t pixels = std::uint64_t(launch.width) * launch.height;
  while (!__atomic_load_n(&job->status->stop, __ATOMIC_RELAXED)) {
    const std::uint64_t pixel = __atomic_fetch_add(&job->status->nextPixel, 1, __ATOMIC_RELAXED);
    if (pixel >= pixels)
      return;
    float *const to = job->pixels + 3 * pixel;
    to[0] = float(pixel % launch.width);
    to[1] = float(pixel / launch.width);
    to[2] = float(launch.seed);
    std::this_thread::sleep_for(std::chrono::milliseconds(launch.maxDepth));
  }
}

void overflow(const RtslJob *job, std::uint32_t) {
  __atomic_store_n(&job->status->problem, RTSL_PROBLEM_STACK, __ATOMIC_RELAXED);
}

MegakernelCode codeOf(void (*runLane)(const RtslJob *, std::uint32_t)) {
  MegakernelCode code;
  code.laneBytes = [](std::uint32_t, std::uint32_t) { return std::uint64_t(100); };
  code.runLane = runLane;
  return code;
}

FlatScene emptyScene() {
  RtslLaunch launch{};
  launch.colorComponents = 3;
  FlatScene scene;
  scene.bytes.resize(sizeof launch);
  scene.setLaunch(launch);
  return scene;
}

RenderOptions small() {
  RenderOptions options;
  options.width = 20;
  options.height = 10;
  options.samplesPerPixel = 3;
  options.maxDepth = 0;
  options.seed = 7;
  return options;
}

ErrorCode codeThrownBy(Backend &backend) {
  try {
    backend.render();
  } catch (const Error &error) {
    return error.code;
  }
  ADD_FAILURE() << "it did not throw";
  return ErrorCode::Internal;
}

} // namespace

TEST(Backend, GivesThePictureAndWhatWasCountedAgainAndAgain) {
  HostMegakernel renderer(codeOf(paint), emptyScene(), small());
  for (int time = 0; time < 3; ++time) {
    RenderStatistics statistics;
    const Image image = renderer.render(&statistics);
    ASSERT_EQ(image.pixels.size(), 20u * 10 * 3);
    EXPECT_EQ(image.at(19, 9)[0], 19.0f);
    EXPECT_EQ(image.at(19, 9)[1], 9.0f);
    EXPECT_EQ(image.at(19, 9)[2], 7.0f);
    EXPECT_EQ(statistics.pixels, 200u);
    EXPECT_EQ(statistics.samples, 600u);
    EXPECT_FALSE(statistics.isUnfinished);
    EXPECT_GE(statistics.renderSeconds, 0);
  }
}

TEST(Backend, TakesTheThreadsItIsToldAndNoMoreThanThereIsWork) {
  RenderOptions options = small();
  options.threads = 3;
  lanesBegun = 0;
  HostMegakernel(codeOf(paint), emptyScene(), options).render();
  EXPECT_EQ(lanesBegun, 3u);
  options.width = 2;
  options.height = 1;
  options.threads = 40;
  lanesBegun = 0;
  HostMegakernel(codeOf(paint), emptyScene(), options).render();
  EXPECT_EQ(lanesBegun, 2u);
}

TEST(Backend, TellsHowFarItIs) {
  RenderOptions options = small();
  options.maxDepth = 1;
  options.threads = 2;
  double last = 0;
  unsigned calls = 0;
  bool isAscending = true;
  options.progress = [&](double share) {
    isAscending &= share >= last && share <= 1;
    last = share;
    ++calls;
  };
  HostMegakernel(codeOf(paint), emptyScene(), options).render();
  EXPECT_TRUE(isAscending);
  EXPECT_GT(calls, 2u); // of 100 ms and more
  EXPECT_GT(last, 0.1);
}

TEST(Backend, StopsWhenItIsCancelled) {
  RenderOptions options = small();
  options.width = 1000;
  options.height = 1000;
  options.maxDepth = 1;
  options.threads = 2;
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  options.progress = [&](double share) { cancel = share > 0; };
  HostMegakernel throwing(codeOf(paint), emptyScene(), options);
  EXPECT_EQ(codeThrownBy(throwing), ErrorCode::Cancelled);

  options.keepsUnfinished = true;
  cancel = false;
  RenderStatistics statistics;
  const Image part = HostMegakernel(codeOf(paint), emptyScene(), options).render(&statistics);
  EXPECT_TRUE(statistics.isUnfinished);
  EXPECT_GT(statistics.pixels, 0u);
  EXPECT_LT(statistics.pixels, 1000000u);
  EXPECT_EQ(part.at(0, 0)[2], 7.0f);
  EXPECT_EQ(part.at(999, 999)[2], 0.0f); // black where nothing is
}

TEST(Backend, AFaultOfTheProgramComesOutAndLeavesNoPicture) {
  HostMegakernel renderer(codeOf(overflow), emptyScene(), small());
  EXPECT_EQ(codeThrownBy(renderer), ErrorCode::Internal);
  EXPECT_EQ(codeThrownBy(renderer), ErrorCode::Internal);
}

TEST(Backend, RefusesOptionsOutOfRangeBeforeAnythingElse) {
  RenderOptions options = small();
  options.maxDepth = maxRayDepth + 1;
  try {
    HostMegakernel(codeOf(paint), emptyScene(), options);
    FAIL();
  } catch (const Error &error) {
    EXPECT_EQ(error.code, ErrorCode::OutOfRange);
  }
}

TEST(Backend, TheRendererGivesTheSameBitsAgain) {
  Scene scene(test::fakeProgram());
  scene.setCamera(scene.addObject("Camera", test::members({{"eye", test::vector(0, 1, 5)},
                                                           {"gaze", test::vector(0, 0, -2)},
                                                           {"up", test::vector(0, 1, 0)}})));
  scene.setBackgroundColor({0.5f, 0.25f, 1});
  Renderer renderer(scene, small());
  Backend &backend = renderer;
  RenderStatistics first, second;
  const Image a = backend.render(&first), b = backend.render(&second);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(first.samples, second.samples);
  EXPECT_EQ(a.at(3, 3)[2], 1.0f);
  bool hasRun = false;
  renderer.onThread([&] { hasRun = true; });
  EXPECT_TRUE(hasRun);
}
