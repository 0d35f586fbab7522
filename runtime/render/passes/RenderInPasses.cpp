//===- RenderInPasses.cpp - passes of samples, and checkpoints between them ===//
#include "runtime/render/Backend.h"
#include "runtime/render/Watch.h"
#include "runtime/render/passes/Adaptive.h"
#include "support/Clock.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"
#include "support/ProcessorTime.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace rtsl::runtime {

namespace {

Clock::time_point after(Clock::time_point from, double seconds) {
  constexpr double longest = 1e9; // further than any rendering, and not too far for the clock
  return from + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(std::min(seconds, longest)));
}

/// While it exists, sets `stop` at a time, or `secondsToEnd` after `cancel` was set.
class Pause {
public:
  Pause(std::atomic<bool> &stop, const std::atomic<bool> *cancel, Clock::time_point time,
        double secondsToEnd)
      : stop(stop), cancel(cancel), secondsToEnd(secondsToEnd), time(time),
        thread([this] { run(); }) {}
  ~Pause() {
    {
      std::lock_guard<std::mutex> lock(mutex);
      isOver = true;
    }
    ended.notify_one();
    thread.join();
  }
  Pause(const Pause &) = delete;
  Pause &operator=(const Pause &) = delete;

private:
  void run() {
    constexpr std::chrono::milliseconds moment(10); // to notice that it is cancelled
    bool isCancelled = false;
    std::unique_lock<std::mutex> lock(mutex);
    while (!isOver && !stop) {
      if (!isCancelled && cancel && *cancel) {
        isCancelled = true;
        time = std::min(time, after(Clock::now(), secondsToEnd));
      }
      stop = Clock::now() >= time;
      ended.wait_until(lock, std::min(time, Clock::now() + moment), [this] { return isOver; });
    }
  }

  std::atomic<bool> &stop;
  const std::atomic<bool> *cancel;
  const double secondsToEnd;
  Clock::time_point time;
  std::mutex mutex;
  std::condition_variable ended;
  bool isOver = false;
  std::thread thread;
};

bool isGoodEnough(const PassState &state, const PassOptions &passes, bool isAdaptive) {
  const bool endsByError = passes.error > 0 && !isAdaptive; // there pixels end one by one
  return state.seconds >= passes.seconds || (endsByError && state.error <= passes.error);
}

} // namespace

/// Is the first pass the only one, and better without sums?
bool Backend::isOnePass(const PassOptions &passes, const PartialRendering &rendering) const {
  const PassSizes sizes = passSizes();
  const std::uint32_t all = options.samplesPerPixel;
  return rendering.sums.isEmpty() && !passes.isMeasured() && (all == 1 || sizes.prefersNoSums) &&
         samplesOfPass({}, passes, sizes, all) == all;
}

Image Backend::renderOnePass(const PassOptions &passes,
                             const std::function<void(const PassState &)> &progress,
                             PartialRendering &rendering, RenderStatistics *statistics) {
  std::atomic<bool> stop{false};
  RenderOptions watched = options;
  watched.cancel = &stop;
  watched.keepsUnfinished = true;
  const Pause pausing(stop, options.cancel, Clock::time_point::max(), passes.secondsToEndPass());
  RenderStatistics said;
  Image image = renderAtOnce(watched, &said);
  rendering.state.seconds = said.renderSeconds;
  if (!said.isUnfinished) {
    rendering.state.samplesPerPixel = options.samplesPerPixel;
    if (progress)
      progress(rendering.state);
  }
  if (statistics)
    *statistics = std::move(said);
  return image;
}

/// Allocates the sums of a rendering that begins. Gives the samples that there are.
SampleCounts Backend::takeSums(PartialRendering &rendering, const PassOptions &passes) {
  if (rendering.sums.isEmpty()) {
    rendering.sums =
        PixelSums::make(pixelCount(), channels(), options.isAdaptive, passes.isMeasured());
    return {};
  }
  if (rendering.sums.pixels() != pixelCount() ||
      rendering.sums.isAdaptive() != options.isAdaptive ||
      rendering.sums.colors.size() != pixelCount() * channels() * rendering.sums.halves())
    throw Error(message::sumsOfOtherPixels());
  if (passes.isMeasured() && !rendering.sums.isMeasured())
    throw Error(message::sumsNotMeasured());
  const SampleCounts counts = countSamples(rendering.sums);
  if (counts.most > options.samplesPerPixel)
    throw Error(message::tooManySamplesAlready(counts.most, options.samplesPerPixel));
  return counts;
}

/// Renders until each pixel has `samplesOfPixel` samples, or until `pause`, or some time after it
/// was cancelled. Gives whether the pass is done.
bool Backend::runPass(const PassState &state, Clock::time_point pause, double secondsToEnd,
                      RenderStatistics &met) {
  std::atomic<bool> stop{false};
  RenderOptions ofPass = options;
  ofPass.cancel = &stop;
  if (options.progress)
    ofPass.progress = [&](double share) {
      const double samples =
          state.samplesPerPixel + share * double(samplesOfPixel - state.samplesPerPixel);
      options.progress(samples / options.samplesPerPixel);
    };
  begin();
  {
    const Pause pausing(stop, options.cancel, pause, secondsToEnd);
    Watch watch(ofPass);
    run(watch);
  }
  RenderStatistics said = finish();
  const bool isDone = said.pixels == pixelCount();
  met.kernelSeconds += said.kernelSeconds;
  addMet(std::move(said), options.mostNotFinite, met);
  return isDone;
}

/// May the first pass take all samples, as long as that does not last? On a CPU, passes of 1, 16
/// and more samples find less in the caches: 16 samples of each pixel took 6 % longer in a scene of
/// many instances.
bool Backend::triesWhole(const PassOptions &passes, const PartialRendering &rendering) const {
  constexpr std::uint32_t mostSamples = 64; // with more, the other passes cost little
  return rendering.state.samplesPerPixel == 0 && options.samplesPerPixel <= mostSamples &&
         passSizes().prefersWhole && !passes.isMeasured() && !std::isfinite(passes.seconds);
}

/// A pass with all samples, which is given up if it would last, or is cancelled. Gives whether it
/// is done.
bool Backend::tryWhole(const PassOptions &passes, PartialRendering &rendering) {
  constexpr double secondsOfTrial = 1;
  if (isCancelled())
    return false;
  const Clock::time_point start = Clock::now();
  samplesOfPixel = options.samplesPerPixel;
  if (runPass(rendering.state, after(start, secondsOfTrial), 0, rendering.met))
    return true;
  const double share = double(countSamples(rendering.sums).samples) /
                       (double(pixelCount()) * options.samplesPerPixel);
  if (isCancelled() || secondsSince(start) > share * passes.secondsBetweenPictures)
    return false;
  return runPass(rendering.state, Clock::time_point::max(), 0, rendering.met);
}

/// Measures the error after a pass of a rendering that ends by its error.
void Backend::measure(const PassOptions &passes, PartialRendering &rendering) {
  fetchSums();
  if (!options.isAdaptive) {
    rendering.state.error = relativeError(rendering.sums, channels());
    return;
  }
  rendering.state.error = closeHalves(rendering.sums, windowOf(options).width(), passes.error);
  uploadSums(countSamples(rendering.sums));
}

void Backend::runPasses(const PassOptions &passes,
                        const std::function<void(const PassState &)> &progress,
                        const SampleCounts &before, PartialRendering &rendering) {
  PassState &state = rendering.state;
  state.samplesPerPixel = before.least;
  std::uint32_t next = before.most; // the end of a pass that was interrupted
  const double secondsBefore = state.seconds;
  const Clock::time_point start = Clock::now();
  Clock::time_point shown = start, saved = start;
  uploadSums(before);
  if (triesWhole(passes, rendering)) {
    if (tryWhole(passes, rendering))
      state.samplesPerPixel = next = options.samplesPerPixel;
    state.seconds = secondsBefore + secondsSince(start);
  }
  do {
    if (next == state.samplesPerPixel) {
      const bool isAnyLeft = next < options.samplesPerPixel &&
                             (!options.isAdaptive || countSamples(rendering.sums).openPixels > 0);
      if (!isAnyLeft || (next > 0 && isGoodEnough(state, passes, options.isAdaptive)))
        break;
      next += samplesOfPass(state, passes, passSizes(), options.samplesPerPixel);
    }
    samplesOfPixel = next;
    const Clock::time_point pause = passes.checkpoint
                                        ? after(saved, passes.secondsBetweenCheckpoints)
                                        : Clock::time_point::max();
    const bool isDone = runPass(state, pause, passes.secondsToEndPass(), rendering.met);
    state.seconds = secondsBefore + secondsSince(start);
    if (isDone) {
      const bool isMeasured = passes.error > 0 && next == nextMeasurement(state.samplesPerPixel);
      const bool isShown = passes.picture && secondsSince(shown) >= passes.secondsBetweenPictures;
      if (isMeasured)
        measure(passes, rendering);
      else if (isShown)
        fetchSums();
      state.samplesPerPixel = next;
      if (progress)
        progress(state);
      if (isShown) {
        resolve(rendering.sums, options.withoutSample, picture, options.threads);
        passes.picture(picture);
        shown = Clock::now();
      }
    }
    if (passes.checkpoint && secondsSince(saved) >= passes.secondsBetweenCheckpoints) {
      fetchSums();
      passes.checkpoint(rendering, false);
      saved = Clock::now();
    }
  } while (!isCancelled());
  fetchSums();
}

Image Backend::renderInPasses(const PassOptions &passes,
                              const std::function<void(const PassState &)> &progress,
                              PartialRendering &rendering, RenderStatistics *statistics) {
  if (isOnePass(passes, rendering))
    return renderOnePass(passes, progress, rendering, statistics);
  const SampleCounts before = takeSums(rendering, passes);
  if (picture.pixels.empty())
    makePicture(channels());
  sums = &rendering.sums;
  const double processorStart = processorSeconds();
  try {
    runPasses(passes, progress, before, rendering);
    if (passes.checkpoint)
      passes.checkpoint(rendering, true);
  } catch (...) {
    sums = nullptr;
    picture = Image();
    throw;
  }
  sums = nullptr;
  const double processor = processorSeconds() - processorStart;
  resolve(rendering.sums, options.withoutSample, picture, options.threads);

  RenderStatistics said = rendering.met;
  const SampleCounts counts = countSamples(rendering.sums);
  said.samples = counts.samples;
  said.samplesNotFinite = counts.notFinite;
  said.pixelsWithoutSample = counts.pixelsWithoutSample;
  said.openPixels = options.isAdaptive ? counts.openPixels : 0;
  said.pixels = pixelCount() - counts.openPixels + counts.pixelsWithMost;
  said.isUnfinished = counts.least < counts.most || counts.least == 0;
  said.renderSeconds = rendering.state.seconds;
  said.processorSeconds = processor;
  said.buildSeconds = buildSeconds;
  said.tree = trees;
  said.isRefitted = isRefitted;
  if (statistics)
    *statistics = std::move(said);
  return std::exchange(picture, Image());
}

} // namespace rtsl::runtime
