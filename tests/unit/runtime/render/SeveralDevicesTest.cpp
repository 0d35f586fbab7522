// One picture on several devices, which are host megakernels here, has the bits of one.
#include "tests/unit/runtime/render/PaintingProgram.h"

#include "runtime/device/organisations/Slice.h"
#include "runtime/render/SeveralDevices.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

using namespace rtsl::runtime;
using namespace rtsl::test;
using rtsl::Error;

namespace {

/// How many pixels' sums are set to 0 on devices, and copied there and back.
struct Copies {
  std::atomic<std::size_t> cleared{0}, there{0}, back{0};
};

/// A device whose sums are in memory of its own, which has arbitrary content at first.
class WithOwnSums final : public HostMegakernel {
public:
  WithOwnSums(const RenderOptions &options, Copies &copies)
      : HostMegakernel(codeOf(paint), emptyScene(), options), copies(copies) {}

private:
  RtslPixelSums placeSums(PixelSums &sums) override {
    if (own.isEmpty()) {
      own = sums;
      const auto spoil = [](auto &list) { list.assign(list.size(), 77); };
      rtsl::runtime::forEachList(spoil, own);
    }
    return own.pointers();
  }
  void clearSums(const PixelSums &sums, std::size_t first, std::size_t count) override {
    const auto clear = [](const void *, void *there, std::size_t bytes) {
      std::memset(there, 0, bytes);
    };
    rtsl::runtime::forEachPart(clear, sums, own.pointers(), first, count);
    copies.cleared += count;
  }
  void uploadSums(const PixelSums &sums, std::size_t first, std::size_t count) override {
    const auto upload = [](const void *here, void *there, std::size_t bytes) {
      std::memcpy(there, here, bytes);
    };
    rtsl::runtime::forEachPart(upload, sums, own.pointers(), first, count);
    copies.there += count;
  }
  void fetchSums(PixelSums &sums, std::size_t first, std::size_t count) override {
    const auto fetch = [](void *here, const void *there, std::size_t bytes) {
      std::memcpy(here, there, bytes);
    };
    rtsl::runtime::forEachPart(fetch, sums, own.pointers(), first, count);
    copies.back += count;
  }

  PixelSums own;
  Copies &copies;
};

SeveralDevices team(std::size_t devices, const RenderOptions &options,
                    void (*runLane)(const RtslJob *, std::uint32_t) = paint) {
  return SeveralDevices(
      devices,
      [=](std::size_t) {
        return std::make_unique<HostMegakernel>(codeOf(runLane), emptyScene(), options);
      },
      options);
}

SeveralDevices teamWithOwnSums(const RenderOptions &options, Copies &copies) {
  return SeveralDevices(
      3, [&](std::size_t) { return std::make_unique<WithOwnSums>(options, copies); }, options);
}

Image onOne(const RenderOptions &options) {
  return HostMegakernel(codeOf(paint), emptyScene(), options).render();
}

/// Infinite in the samples of column 3 with even numbers.
void paintInfinities(const RtslJob *job, std::uint32_t lane) {
  paint(job, lane);
  for (std::uint32_t place = 0; place < job->width * job->height; ++place)
    if (rtsl::device::pixelAt(*job, place).x == 3)
      for (std::uint32_t i = 0; i < job->sampleCount; i += 2)
        job->samples[3 * (std::uint64_t(place) * job->sampleCount + i)] = 1e30f * 1e30f;
}

} // namespace

TEST(RowsLeft, AreAllTakenOnceAndLessAndLess) {
  for (const std::size_t devices : {2, 3, 8})
    for (const std::uint32_t height : {1u, 3u, 4u, 5u, 64u, 1000u, 65536u}) {
      RowsLeft rows({7, 11, 9, 11 + height}, devices, 2 * height);
      std::uint32_t next = 11, last = height;
      for (Window part = rows.take(); part.pixels() > 0; part = rows.take()) {
        EXPECT_EQ(part.x0, 7u);
        EXPECT_EQ(part.x1, 9u);
        EXPECT_EQ(part.y0, next);
        EXPECT_LE(part.height(), last);
        next = part.y1;
        last = part.height();
      }
      EXPECT_EQ(next, 11 + height);
      if (height >= 64 * devices)
        EXPECT_LE(last, 4u); // so that no device waits for another one
    }
}

TEST(RowsLeft, AreNotMoreThanFitExceptAFew) {
  RowsLeft rows({0, 0, 10, 400}, 2, 165);
  for (int i = 0; i < 21; ++i)
    EXPECT_EQ(rows.take().height(), 16u);
  EXPECT_EQ(rows.take().height(), 16u); // a quarter of 64
  EXPECT_EQ(rows.take().height(), 12u);
  EXPECT_EQ(RowsLeft({0, 0, 10, 100}, 2, 1).take().height(), 4u);
}

TEST(SeveralDevices, GiveTheBitsOfOne) {
  RenderOptions options = small();
  options.height = 61;
  const Image expected = onOne(options);
  for (const std::size_t devices : {1, 2, 3, 5}) {
    SeveralDevices several = team(devices, options);
    for (int time = 0; time < 2; ++time) {
      RenderStatistics statistics;
      EXPECT_EQ(several.render(&statistics).pixels, expected.pixels);
      EXPECT_EQ(statistics.samples, 20u * 61 * 3);
      EXPECT_EQ(statistics.pixels, 20u * 61);
      std::uint64_t samples = 0;
      for (std::size_t i = 0; i < devices; ++i)
        samples += several.samplesOf(i);
      EXPECT_EQ(samples, statistics.samples);
    }
  }
}

TEST(SeveralDevices, RenderAPartOfThePicture) {
  RenderOptions options = small();
  options.crop = Window{3, 2, 8, 9};
  const Image expected = onOne(options), image = team(2, options).render();
  EXPECT_EQ(image.pixels, expected.pixels);
  EXPECT_EQ(image.top, 2u);
  EXPECT_EQ(image.wholeHeight, 10u);
}

TEST(SeveralDevices, GoOnWithSums) {
  RenderOptions options = small();
  options.height = 37;
  for (const bool isAdaptive : {false, true}) {
    options.isAdaptive = isAdaptive;
    options.samplesPerPixel = 33;
    PartialRendering ofOne, ofSeveral;
    PassOptions passes;
    passes.error = isAdaptive ? 0.4 : 0;
    const Image expected =
        HostMegakernel(codeOf(paint), emptyScene(), options).renderInPasses(passes, nullptr, ofOne);
    RenderStatistics statistics;
    const Image image = team(3, options).renderInPasses(passes, nullptr, ofSeveral, &statistics);
    EXPECT_EQ(image.pixels, expected.pixels);
    EXPECT_EQ(ofSeveral.sums.colors, ofOne.sums.colors);
    EXPECT_EQ(ofSeveral.sums.taken, ofOne.sums.taken);
    EXPECT_EQ(ofSeveral.sums.closed, ofOne.sums.closed);
    EXPECT_EQ(statistics.samples, rtsl::runtime::countSamples(ofOne.sums).samples);
  }
}

TEST(SeveralDevices, KeepTheSumsBetweenPasses) {
  RenderOptions options = small();
  options.height = 37;
  options.samplesPerPixel = 33;
  options.threads = 1;
  Copies copies;
  SeveralDevices several = teamWithOwnSums(options, copies);
  PassOptions passes;
  passes.checkpoint = [](const PartialRendering &, bool) {}; // one pass after the other
  unsigned count = 0;
  PartialRendering rendering;
  const auto notePass = [&](const PassState &) { ++count; };
  EXPECT_EQ(several.renderInPasses(passes, notePass, rendering).pixels, onOne(options).pixels);
  EXPECT_GE(count, 3u);
  EXPECT_EQ(copies.cleared, 20u * 37);
  // Some rows may move if the machine delays a device by longer than passes take.
  EXPECT_LT(copies.there, 20u * 37);
  EXPECT_GE(copies.back, 20u * 37);
  EXPECT_LT(copies.back, 2u * 20 * 37);
}

TEST(SeveralDevices, GoOnWithTheSumsOfOthers) {
  RenderOptions options = small(), ofFirst = options;
  options.samplesPerPixel = 33;
  ofFirst.samplesPerPixel = 10;
  PassOptions passes;
  passes.checkpoint = [](const PartialRendering &, bool) {};
  PartialRendering rendering;
  Copies ofFirstTeam, ofSecond;
  teamWithOwnSums(ofFirst, ofFirstTeam).renderInPasses(passes, nullptr, rendering);
  const Image image = teamWithOwnSums(options, ofSecond).renderInPasses(passes, nullptr, rendering);
  EXPECT_EQ(image.pixels, onOne(options).pixels);
  EXPECT_EQ(ofSecond.cleared, 0u);
  EXPECT_GE(ofSecond.there, windowOf(options).pixels());
}

/// A device that takes longer gives rows away between passes.
TEST(SeveralDevices, ShareWhatIsLeftOfThePasses) {
  RenderOptions options = small();
  options.width = 4;
  options.height = 160;
  options.samplesPerPixel = 6;
  options.threads = 1;
  PartialRendering ofOne, ofSeveral;
  PassOptions passes;
  passes.checkpoint = [](const PartialRendering &, bool) {}; // one pass after the other
  const Image expected =
      HostMegakernel(codeOf(paint), emptyScene(), options).renderInPasses(passes, nullptr, ofOne);
  std::vector<std::uint64_t> ofSlow; // its pixels, pass by pass
  SeveralDevices several(
      2,
      [&](std::size_t i) {
        RenderOptions ofDevice = options;
        ofDevice.maxDepth = std::uint32_t(i); // the second one takes its time
        return std::make_unique<HostMegakernel>(codeOf(paint), emptyScene(), ofDevice);
      },
      options);
  const auto progress = [&](const PassState &state) {
    ofSlow.push_back(several.samplesOf(1) / state.samplesPerPixel);
  };
  EXPECT_EQ(several.renderInPasses(passes, progress, ofSeveral).pixels, expected.pixels);
  EXPECT_EQ(ofSeveral.sums.colors, ofOne.sums.colors);
  ASSERT_GT(ofSlow.size(), 1u);
  EXPECT_EQ(ofSlow.front(), 4u * 80);
  EXPECT_LT(ofSlow.back(), 4u * 50);
}

TEST(SeveralDevices, NameTheFirstSamplesThatAreNotFinite) {
  RenderOptions options = small();
  options.threads = 1;
  options.height = 40;
  RenderStatistics ofOne, ofSeveral;
  const Image expected =
      HostMegakernel(codeOf(paintInfinities), emptyScene(), options).render(&ofOne);
  EXPECT_EQ(team(2, options, paintInfinities).render(&ofSeveral).pixels, expected.pixels);
  EXPECT_EQ(ofSeveral.samplesNotFinite, 2u * 40);
  EXPECT_EQ(ofSeveral.samplesNotFinite, ofOne.samplesNotFinite);
  ASSERT_EQ(ofSeveral.notFinite.size(), ofOne.notFinite.size());
  for (std::size_t i = 0; i < ofOne.notFinite.size(); ++i)
    EXPECT_FALSE(ofOne.notFinite[i] < ofSeveral.notFinite[i] ||
                 ofSeveral.notFinite[i] < ofOne.notFinite[i]);
}

TEST(SeveralDevices, TellHowFarTheyAre) {
  RenderOptions options = small();
  options.maxDepth = 1;
  options.threads = 1;
  double last = 0;
  unsigned calls = 0;
  bool isAscending = true;
  options.progress = [&](double share) {
    isAscending &= share >= last && share <= 1;
    last = share;
    ++calls;
  };
  team(2, options).render();
  EXPECT_TRUE(isAscending);
  EXPECT_GT(calls, 2u);
  EXPECT_GT(last, 0.3);
}

TEST(SeveralDevices, StopTogether) {
  RenderOptions options = small();
  options.width = 1000;
  options.height = 1000;
  options.maxDepth = 1;
  options.threads = 1;
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  options.progress = [&](double share) { cancel = share > 0; };
  options.keepsUnfinished = true;
  RenderStatistics statistics;
  const Image part = team(2, options).render(&statistics);
  EXPECT_TRUE(statistics.isUnfinished);
  EXPECT_GT(statistics.pixels, 0u);
  EXPECT_LT(statistics.pixels, 1000000u);
  EXPECT_EQ(part.at(999, 999)[2], 0.0f);
}

TEST(SeveralDevices, AFaultOfOneEndsAll) {
  RenderOptions options = small();
  options.maxDepth = 1; // the others take their time, so that this one gets a share
  SeveralDevices several(
      3,
      [&](std::size_t i) {
        const auto overflow = [](const RtslJob *job, std::uint32_t) {
          __atomic_store_n(&job->status->problem, RTSL_PROBLEM_STACK, __ATOMIC_RELAXED);
        };
        return std::make_unique<HostMegakernel>(codeOf(i == 1 ? +overflow : paint), emptyScene(),
                                                options);
      },
      options);
  EXPECT_THROW(several.render(), Error);
}
