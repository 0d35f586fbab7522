#include "runtime/render/Renderer.h"

#include "runtime/embree/HostScene.h"
#include "runtime/render/HostThreads.h"
#include "runtime/render/Watch.h"
#include "support/FirstFew.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>
#include <type_traits>
#include <utility>

namespace rtsl::runtime {

namespace {

/// Small enough that cores finish together, large enough that taking one costs nothing.
constexpr std::uint32_t tileSize = 16;

using SamplesNotFinite = FirstFew<SampleId, std::less<SampleId>>;

/// What one thread has rendered and met.
struct Worker {
  RtslLaunch launch;
  RtslStatus status{}; // lanes count in it
  std::uint64_t samples = 0, pixels = 0, pixelsWithoutSample = 0;
  SamplesNotFinite notFinite;
};

/// The sums of one pixel's finite samples.
struct PixelSum {
  double colors[RTSL_MAX_COLOR] = {};
  double squares = 0; // of the means of the components
  std::uint32_t counted = 0;

  template <typename Count>
  void add(const float *color, Count components) {
    for (std::uint32_t c = 0; c < components; ++c)
      colors[c] += double(color[c]);
    ++counted;
  }

  template <typename Count>
  void addSquare(const float *color, Count components) {
    double value = 0;
    for (std::uint32_t c = 0; c < components; ++c)
      value += double(color[c]);
    value /= double(components);
    squares += value * value;
  }

  template <typename Count>
  void load(const PixelSums &from, std::size_t pixel, Count components) {
    std::copy_n(&from.colors[pixel * components], std::uint32_t(components), colors);
    squares = from.squares[pixel];
    counted = from.counted[pixel];
  }

  template <typename Count>
  void store(PixelSums &to, std::size_t pixel, Count components) const {
    std::copy_n(colors, std::uint32_t(components), &to.colors[pixel * components]);
    to.squares[pixel] = squares;
    to.counted[pixel] = counted;
  }
};

std::uint64_t stackBytes(const Program &program, const RtslLaunch &launch) {
  return program.stackBytes ? program.stackBytes(launch.maxDepth, launch.referenceChain) : 0;
}

} // namespace

struct Renderer::Implementation {
  const Scene &scene;
  const RenderOptions &options;
  std::unique_ptr<HostScene> host;
  RtslLaunch launch{};

  // One rendering.
  Image *image = nullptr;
  Watch *watch = nullptr;
  std::uint32_t samplesBefore = 0, samplesAfter = 0; // per pixel, of this pass
  PixelSums *sums = nullptr; // of the passes before; null: there is one pass
  std::atomic<std::uint64_t> nextTile{0};
  std::uint64_t tilesAcross = 0, tileCount = 0;
  std::mutex mutex; // for what follows
  RenderStatistics totals;
  SamplesNotFinite notFinite{RTSL_FIRST_NOT_FINITE};

  Implementation(const Scene &scene, const RenderOptions &options)
      : scene(scene), options(options) {}

  template <typename Count>
  void renderTile(std::uint64_t tile, Worker &worker, Count components);
  void work();
  void add(Worker &worker);
};

Renderer::Renderer(const Scene &scene, const RenderOptions &options)
    : Backend(options), self(std::make_unique<Implementation>(scene, this->options)) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  self->launch = scene.launch();
  const Program &program = scene.program();
  if (!program.sample)
    throw Error(ErrorCode::Internal, "the program has no code for samples");
  try {
    self->host = std::make_unique<HostScene>(scene, options.traversal == Traversal::Embree,
                                             threadCount(options));
    if (options.traversal == Traversal::Device)
      self->launch = self->host->deviceLaunch();
    makePicture(program.colorComponents);
  } catch (const std::bad_alloc &) {
    throw Error(ErrorCode::OutOfMemory, "not enough memory for the scene's acceleration structure");
  }
  self->launch.host = self->host.get();
  self->launch.width = options.width;
  self->launch.height = options.height;
  self->launch.maxDepth = options.maxDepth;
  self->launch.seed = options.seed;
  self->tilesAcross = (options.width + tileSize - 1) / tileSize;
  self->tileCount = self->tilesAcross * ((options.height + tileSize - 1) / tileSize);
  buildSeconds = std::chrono::duration<double>(Clock::now() - start).count();
}

Renderer::~Renderer() = default;

const RtslLaunch &Renderer::launch() const {
  return self->launch;
}

void Renderer::onThread(const std::function<void()> &work) const {
  const HostThreads threads(options, 1, stackBytes(self->scene.program(), self->launch));
  threads.run([&](unsigned) { work(); });
}

template <typename Count>
bool isFinite(const float *color, Count components) {
  bool finite = true;
  for (std::uint32_t c = 0; c < components; ++c)
    finite &= std::isfinite(color[c]);
  return finite;
}

/// Sums of a pixel are taken in the order of its samples, whoever takes them. A sample that is not
/// finite is left out of the mean, for it would take the whole pixel with it. A number of
/// components that is a constant makes no loops of them.
template <typename Count>
void Renderer::Implementation::renderTile(std::uint64_t tile, Worker &worker, Count components) {
  auto sample = scene.program().sample;
  std::uint32_t x0 = std::uint32_t(tile % tilesAcross) * tileSize,
                y0 = std::uint32_t(tile / tilesAcross) * tileSize;
  std::uint32_t x1 = std::min(x0 + tileSize, launch.width),
                y1 = std::min(y0 + tileSize, launch.height);
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = x0; x < x1; ++x) {
      const std::size_t index = std::size_t(y) * launch.width + x;
      PixelSum sum;
      if (sums)
        sum.load(*sums, index, components);
      std::uint32_t taken = samplesBefore;
      for (; taken < samplesAfter && !watch->isStopped(); ++taken) {
        float color[RTSL_MAX_COLOR];
        sample(&worker.launch, x, y, taken, color);
        if (!isFinite(color, components)) {
          worker.notFinite.add({x, y, taken});
          continue;
        }
        sum.add(color, components);
        if (sums)
          sum.addSquare(color, components);
      }
      if (sums)
        sum.store(*sums, index, components);
      worker.samples += taken - samplesBefore;
      worker.pixels += taken == samplesAfter;
      worker.pixelsWithoutSample += taken > 0 && sum.counted == 0;
      float *pixel = image->at(x, y);
      for (std::uint32_t c = 0; c < components; ++c)
        pixel[c] = sum.counted ? float(sum.colors[c] / double(sum.counted))
                   : taken     ? options.withoutSample
                               : 0.0f;
    }
}

void Renderer::Implementation::work() {
  rayCounters() = RayCounters();
  Worker worker{launch, {}, 0, 0, 0, SamplesNotFinite(options.mostNotFinite)};
  worker.launch.status = &worker.status;
  try {
    while (!watch->isStopped()) {
      std::uint64_t tile = nextTile.fetch_add(1, std::memory_order_relaxed);
      if (tile >= tileCount)
        break;
      if (launch.colorComponents == 3)
        renderTile(tile, worker, std::integral_constant<std::uint32_t, 3>());
      else
        renderTile(tile, worker, launch.colorComponents);
      watch->advance(tileCount);
    }
  } catch (...) {
    watch->stop();
    throw;
  }
  add(worker);
}

void Renderer::Implementation::add(Worker &worker) {
  const RayCounters &counters = rayCounters();
  std::lock_guard<std::mutex> lock(mutex);
  totals.samples += worker.samples;
  totals.pixels += worker.pixels;
  totals.pixelsWithoutSample += worker.pixelsWithoutSample;
  totals.badRays += counters.badRays;
  totals.retracedRays += counters.retracedRays;
  totals.rescaledRays += counters.rescaledRays;
  addEvents(worker.status, totals);
  notFinite.add(std::move(worker.notFinite));
}

std::uint32_t Renderer::channels() const {
  return self->launch.colorComponents;
}

void Renderer::begin() {
  self->nextTile = 0;
  self->samplesBefore = 0;
  self->samplesAfter = options.samplesPerPixel;
  self->totals = RenderStatistics();
  self->notFinite = SamplesNotFinite(options.mostNotFinite);
}

void Renderer::run(Watch &watch) {
  self->image = &picture;
  self->watch = &watch;
  const HostThreads threads(options, self->tileCount,
                            stackBytes(self->scene.program(), self->launch));
  threads.run([this](unsigned) { self->work(); });
}

RenderStatistics Renderer::finish() {
  self->totals.samplesNotFinite = self->notFinite.total();
  self->totals.notFinite = self->notFinite.take();
  return std::move(self->totals);
}

/// Passes are short, so that the limits are met and Ctrl-C need not wait, and long enough that
/// starting threads costs nothing. None passes a number of samples at which the error is measured.
static std::uint32_t samplesOfPass(const PassState &state, const PassOptions &passes,
                                   std::uint32_t most) {
  constexpr double longestSeconds = 0.5;
  if (state.samplesPerPixel == 0)
    return 1;
  const double rate = state.samplesPerPixel / std::max(state.seconds, 1e-9); // per second
  const double seconds = std::min(longestSeconds, std::max(0.0, passes.seconds - state.seconds));
  const double samples =
      std::clamp(std::floor(rate * seconds), 1.0, double(state.samplesPerPixel)); // at most double
  std::uint32_t left = most - state.samplesPerPixel;
  if (passes.error > 0)
    left = std::min(left, nextMeasurement(state.samplesPerPixel) - state.samplesPerPixel);
  return std::uint32_t(std::min(samples, double(left)));
}

Image Renderer::renderInPasses(const PassOptions &passes,
                               const std::function<void(const PassState &)> &progress,
                               PassState &state, RenderStatistics *statistics) {
  using Clock = std::chrono::steady_clock;
  const std::uint32_t components = self->launch.colorComponents;
  PixelSums sums;
  try {
    sums.colors.resize(pixelCount() * components);
    sums.squares.resize(pixelCount());
    sums.counted.resize(pixelCount());
  } catch (const std::bad_alloc &) {
    throw Error(ErrorCode::OutOfMemory, "not enough memory for the sums of the pixels");
  }
  if (picture.pixels.empty())
    makePicture(components);
  RenderOptions withoutStop = options; // passes are finished
  withoutStop.cancel = nullptr;
  withoutStop.progress = nullptr;

  begin();
  self->sums = &sums;
  state = PassState();
  const Clock::time_point start = Clock::now();
  Clock::time_point shown = start;
  const auto secondsSince = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  try {
    for (;;) {
      self->samplesBefore = state.samplesPerPixel;
      self->samplesAfter =
          state.samplesPerPixel + samplesOfPass(state, passes, options.samplesPerPixel);
      self->nextTile = 0;
      self->totals.pixels = self->totals.pixelsWithoutSample = 0; // those of the last pass count
      Watch watch(withoutStop);
      run(watch);
      if (passes.error > 0 && self->samplesAfter == nextMeasurement(state.samplesPerPixel))
        state.error = relativeError(sums, components);
      state.samplesPerPixel = self->samplesAfter;
      state.seconds = secondsSince(start);
      if (progress)
        progress(state);
      if (state.samplesPerPixel == options.samplesPerPixel || state.seconds >= passes.seconds ||
          state.error <= passes.error || (options.cancel && *options.cancel))
        break;
      if (passes.picture && secondsSince(shown) >= passes.secondsBetweenPictures) {
        passes.picture(picture);
        shown = Clock::now();
      }
    }
  } catch (...) {
    self->sums = nullptr;
    picture = Image();
    throw;
  }
  self->sums = nullptr;
  RenderStatistics said = finish();
  said.renderSeconds = state.seconds;
  said.buildSeconds = buildSeconds;
  if (statistics)
    *statistics = std::move(said);
  return std::exchange(picture, Image());
}

Image render(const Scene &scene, const RenderOptions &options, RenderStatistics *statistics) {
  return Renderer(scene, options).render(statistics);
}

} // namespace rtsl::runtime
