// What every backend does alike, shown by the host's megakernel with a program of this file, and
// that a renderer can be used again.
#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/render/PaintingProgram.h"

#include "runtime/render/HostMegakernel.h"
#include "runtime/render/Renderer.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

using namespace rtsl::runtime;
using rtsl::Error;
using rtsl::ErrorCode;
using namespace rtsl::test;

namespace {

void overflow(const RtslJob *job, std::uint32_t) {
  __atomic_store_n(&job->status->problem, RTSL_PROBLEM_STACK, __ATOMIC_RELAXED);
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
    EXPECT_EQ(image.at(19, 9)[0], 2 * 19.0f); // the mean of 1, 2 and 3 times the pixel
    EXPECT_EQ(image.at(19, 9)[1], 2 * 9.0f);
    EXPECT_EQ(image.at(19, 9)[2], 2 * 7.0f);
    EXPECT_EQ(statistics.pixels, 200u);
    EXPECT_EQ(statistics.samples, 600u);
    EXPECT_FALSE(statistics.isUnfinished);
    EXPECT_GE(statistics.renderSeconds, 0);
    EXPECT_GT(statistics.processorSeconds, 0);
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
  EXPECT_EQ(part.at(0, 0)[2], 2 * 7.0f);
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
  Scene scene(rtsl::runtime::test::fakeProgram());
  scene.setCamera(scene.addObject(
      "Camera", rtsl::runtime::test::members({{"eye", rtsl::runtime::test::vector(0, 1, 5)},
                                              {"gaze", rtsl::runtime::test::vector(0, 0, -2)},
                                              {"up", rtsl::runtime::test::vector(0, 1, 0)}})));
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

namespace {

RenderOptions withSamples(std::uint32_t samples) {
  RenderOptions options = small();
  options.samplesPerPixel = samples;
  return options;
}

/// Renders in passes, and goes on with `rendering`.
Image inPasses(const RenderOptions &options, PartialRendering &rendering,
               const PassOptions &passes = {}, RenderStatistics *statistics = nullptr) {
  return HostMegakernel(codeOf(paint), emptyScene(), options)
      .renderInPasses(passes, nullptr, rendering, statistics);
}

} // namespace

TEST(Passes, GoOnWhereTheyWereLeft) {
  PartialRendering whole, parts;
  const Image expected = inPasses(withSamples(11), whole);
  EXPECT_EQ(expected.at(19, 9)[0], 19.0f * 6); // the mean of 1 to 11
  for (const std::uint32_t samples : {1, 4, 4, 11}) {
    RenderStatistics statistics;
    const Image image = inPasses(withSamples(samples), parts, {}, &statistics);
    EXPECT_EQ(parts.state.samplesPerPixel, samples);
    EXPECT_EQ(statistics.samples, samples * 200);
    EXPECT_EQ(statistics.pixels, 200u);
    if (samples == 11)
      EXPECT_EQ(image.pixels, expected.pixels);
  }
  EXPECT_EQ(parts.sums.colors, whole.sums.colors);
}

TEST(Passes, EvenOutWhatAnInterruptionHasLeft) {
  PartialRendering whole, parts;
  const Image expected = inPasses(withSamples(9), whole);
  inPasses(withSamples(3), parts);
  PartialRendering further;
  inPasses(withSamples(5), further);
  for (const std::size_t pixel : {0, 100, 199}) { // two samples more
    std::copy_n(&further.sums.colors[3 * pixel], 3, &parts.sums.colors[3 * pixel]);
    parts.sums.taken[pixel] = parts.sums.counted[pixel] = 5;
  }
  EXPECT_EQ(inPasses(withSamples(9), parts).pixels, expected.pixels);
  EXPECT_EQ(parts.sums.taken, whole.sums.taken);
}

TEST(Passes, KeepSquaresOnlyWhereTheErrorIsMeasured) {
  PartialRendering plain, measured;
  PassOptions withError;
  withError.error = 1e-9;
  RenderStatistics statistics;
  EXPECT_EQ(inPasses(withSamples(20), plain, {}, &statistics).pixels,
            inPasses(withSamples(20), measured, withError).pixels);
  EXPECT_EQ(statistics.pixels, 200u);
  EXPECT_TRUE(plain.sums.squares.empty());
  EXPECT_EQ(measured.sums.squares.size(), 200u);
  EXPECT_THROW(inPasses(withSamples(30), plain, withError), Error);
}

TEST(Passes, ShowTheShareOfAllSamples) {
  RenderOptions options = withSamples(300);
  std::vector<double> shares;
  options.progress = [&](double share) { shares.push_back(share); };
  for (int i = 0; shares.empty() && i < 100; ++i) { // a short rendering may show none
    PartialRendering rendering;
    inPasses(options, rendering);
  }
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_LE(shares.back(), 1);
}

TEST(Passes, RefuseSumsThatCannotBeTheirs) {
  PartialRendering more, larger;
  inPasses(withSamples(4), more);
  EXPECT_THROW(inPasses(withSamples(3), more), Error);
  RenderOptions wide = withSamples(4);
  wide.width = 30;
  inPasses(wide, larger);
  EXPECT_THROW(inPasses(withSamples(4), larger), Error);
}

TEST(Passes, WriteCheckpointsAtIntervalsAndAtTheEnd) {
  RenderOptions options = withSamples(2);
  options.maxDepth = 1; // 200 ms for each pass of one thread
  options.threads = 1;
  unsigned intermediate = 0, last = 0;
  PassOptions passes;
  passes.secondsBetweenCheckpoints = 0.03;
  passes.checkpoint = [&](const PartialRendering &rendering, bool isLast) {
    EXPECT_EQ(last, 0u);
    ++(isLast ? last : intermediate);
    EXPECT_EQ(rendering.sums.pixels(), 200u);
  };
  PartialRendering rendering;
  inPasses(options, rendering, passes);
  EXPECT_GE(intermediate, 2u);
  EXPECT_EQ(last, 1u);
}

TEST(Passes, EndAtOnceIfThereAreCheckpoints) {
  RenderOptions options = withSamples(1000);
  options.width = 1000;
  options.maxDepth = 1;
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  PassOptions passes;
  passes.secondsBetweenCheckpoints = 0.02;
  passes.checkpoint = [&](const PartialRendering &, bool) { cancel = true; };
  PartialRendering rendering;
  RenderStatistics statistics;
  inPasses(options, rendering, passes, &statistics);
  EXPECT_TRUE(statistics.isUnfinished);
  EXPECT_GT(statistics.samples, 0u);
  EXPECT_LT(statistics.samples, 10000u);
}

TEST(Passes, OneAloneKeepsNoSums) {
  PartialRendering rendering;
  RenderStatistics statistics;
  const Image image = inPasses(withSamples(1), rendering, {}, &statistics);
  EXPECT_EQ(image.at(19, 9)[0], 19.0f);
  EXPECT_TRUE(rendering.sums.isEmpty());
  EXPECT_EQ(rendering.state.samplesPerPixel, 1u);
  EXPECT_EQ(statistics.samples, 200u);
  EXPECT_FALSE(statistics.isUnfinished);
  inPasses(withSamples(2), rendering);
  EXPECT_FALSE(rendering.sums.isEmpty());
}

TEST(Passes, OfFewSamplesThatAreCancelledLeaveNoPixelBlack) {
  const std::atomic<bool> cancel{true};
  RenderOptions options = withSamples(64);
  options.cancel = &cancel;
  PartialRendering rendering;
  RenderStatistics statistics;
  const Image image = inPasses(options, rendering, {}, &statistics);
  EXPECT_EQ(rendering.state.samplesPerPixel, 1u);
  EXPECT_EQ(statistics.samples, 200u);
  for (unsigned x = 1; x < image.width; ++x)
    EXPECT_GT(image.at(x, 9)[0], 0.0f);
}

TEST(Crop, IsThePartOfThePicture) {
  RenderOptions options = small();
  options.crop = Window{3, 2, 8, 4};
  for (const bool passes : {false, true}) {
    HostMegakernel renderer(codeOf(paint), emptyScene(), options);
    PartialRendering rendering;
    RenderStatistics statistics;
    const Image image = passes ? renderer.renderInPasses({}, nullptr, rendering, &statistics)
                               : renderer.render(&statistics);
    EXPECT_EQ(image.width, 5u);
    EXPECT_EQ(image.height, 2u);
    EXPECT_EQ(image.left, 3u);
    EXPECT_EQ(image.top, 2u);
    EXPECT_EQ(image.wholeWidth, 20u);
    EXPECT_EQ(image.wholeHeight, 10u);
    const float factor = 2; // the mean of 1, 2 and 3
    EXPECT_EQ(image.at(0, 0)[0], 3.0f * factor);
    EXPECT_EQ(image.at(4, 1)[1], 3.0f * factor);
    EXPECT_EQ(statistics.pixels, 10u);
  }
}

TEST(Crop, LiesInThePicture) {
  for (const Window crop : {Window{3, 2, 3, 4}, Window{3, 4, 8, 4}, Window{0, 0, 21, 4},
                            Window{0, 0, 8, 11}, Window{8, 2, 3, 4}}) {
    RenderOptions options = small();
    options.crop = crop;
    EXPECT_THROW(HostMegakernel(codeOf(paint), emptyScene(), options), Error);
  }
}
