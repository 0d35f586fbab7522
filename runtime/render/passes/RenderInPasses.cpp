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

/// While it exists, sets `stop` at a time, or when `cancel` is set.
class Pause {
public:
  Pause(std::atomic<bool> &stop, const std::atomic<bool> *cancel, Clock::time_point time)
      : stop(stop), cancel(cancel), time(time), thread([this] { run(); }) {}
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
    std::unique_lock<std::mutex> lock(mutex);
    while (!isOver && !stop) {
      stop = Clock::now() >= time || (cancel && *cancel);
      ended.wait_until(lock, std::min(time, Clock::now() + moment), [this] { return isOver; });
    }
  }

  std::atomic<bool> &stop;
  const std::atomic<bool> *cancel;
  const Clock::time_point time;
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

/// Allocates the sums of a rendering that begins.
void Backend::takeSums(PartialRendering &rendering) {
  if (rendering.sums.isEmpty())
    rendering.sums = PixelSums::make(pixelCount(), channels(), options.isAdaptive);
  if (rendering.sums.pixels() != pixelCount() ||
      rendering.sums.isAdaptive() != options.isAdaptive ||
      rendering.sums.colors.size() != pixelCount() * channels() * rendering.sums.halves())
    throw Error(message::sumsOfOtherPixels());
  const std::uint32_t most = countSamples(rendering.sums).most;
  if (most > options.samplesPerPixel)
    throw Error(message::tooManySamplesAlready(most, options.samplesPerPixel));
}

/// Renders until each pixel has `samplesOfPixel` samples, or, if there are checkpoints, until it is
/// cancelled or time for one. Gives whether the pass is done.
bool Backend::runPass(const PassOptions &passes, Clock::time_point pause, RenderStatistics &met) {
  std::atomic<bool> stop{false};
  RenderOptions ofPass = options;
  ofPass.progress = nullptr;
  ofPass.cancel = passes.checkpoint ? &stop : nullptr;
  begin();
  {
    std::optional<Pause> pausing;
    if (passes.checkpoint)
      pausing.emplace(stop, options.cancel, pause);
    Watch watch(ofPass);
    run(watch);
  }
  RenderStatistics said = finish();
  const bool isDone = said.pixels == pixelCount();
  addMet(std::move(said), options.mostNotFinite, met);
  return isDone;
}

/// Measures the error after a pass of a rendering that ends by its error.
void Backend::measure(const PassOptions &passes, PartialRendering &rendering) {
  fetchSums();
  if (!options.isAdaptive) {
    rendering.state.error = relativeError(rendering.sums, channels());
    return;
  }
  rendering.state.error = closeHalves(rendering.sums, windowOf(options).width(), passes.error);
  uploadSums();
}

void Backend::runPasses(const PassOptions &passes,
                        const std::function<void(const PassState &)> &progress,
                        PartialRendering &rendering) {
  PassState &state = rendering.state;
  const SampleCounts before = countSamples(rendering.sums);
  state.samplesPerPixel = before.least;
  std::uint32_t next = before.most; // the end of a pass that was interrupted
  const double secondsBefore = state.seconds;
  const Clock::time_point start = Clock::now();
  Clock::time_point shown = start, saved = start;
  uploadSums();
  do {
    if (next == state.samplesPerPixel) {
      const bool isAnyLeft =
          next < options.samplesPerPixel && countSamples(rendering.sums).openPixels > 0;
      if (!isAnyLeft || (next > 0 && isGoodEnough(state, passes, options.isAdaptive)))
        break;
      next += samplesOfPass(state, passes, options.samplesPerPixel);
    }
    samplesOfPixel = next;
    const bool isDone =
        runPass(passes, after(saved, passes.secondsBetweenCheckpoints), rendering.met);
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
        resolve(rendering.sums, options.withoutSample, picture);
        passes.picture(picture);
        shown = Clock::now();
      }
    }
    if (passes.checkpoint && secondsSince(saved) >= passes.secondsBetweenCheckpoints) {
      fetchSums();
      passes.checkpoint(rendering, false);
      saved = Clock::now();
    }
  } while (!options.cancel || !*options.cancel);
  fetchSums();
}

Image Backend::renderInPasses(const PassOptions &passes,
                              const std::function<void(const PassState &)> &progress,
                              PartialRendering &rendering, RenderStatistics *statistics) {
  takeSums(rendering);
  if (picture.pixels.empty())
    makePicture(channels());
  sums = &rendering.sums;
  const double processorStart = processorSeconds();
  try {
    runPasses(passes, progress, rendering);
    if (passes.checkpoint)
      passes.checkpoint(rendering, true);
  } catch (...) {
    sums = nullptr;
    picture = Image();
    throw;
  }
  sums = nullptr;
  const double processor = processorSeconds() - processorStart;
  resolve(rendering.sums, options.withoutSample, picture);

  RenderStatistics said = rendering.met;
  const SampleCounts counts = countSamples(rendering.sums);
  said.samples = counts.samples;
  said.samplesNotFinite = counts.notFinite;
  said.pixelsWithoutSample = counts.pixelsWithoutSample;
  said.openPixels = options.isAdaptive ? counts.openPixels : 0;
  for (std::size_t pixel = 0; pixel < rendering.sums.pixels(); ++pixel)
    said.pixels += !rendering.sums.isOpen(pixel) || rendering.sums.taken[pixel] == counts.most;
  said.isUnfinished = counts.least < counts.most || counts.least == 0;
  said.renderSeconds = rendering.state.seconds;
  said.processorSeconds = processor;
  said.buildSeconds = buildSeconds;
  said.isRefitted = isRefitted;
  if (statistics)
    *statistics = std::move(said);
  return std::exchange(picture, Image());
}

} // namespace rtsl::runtime
