#include "runtime/render/Renderer.h"

#include "runtime/embree/HostScene.h"
#include "support/FirstFew.h"
#include "support/WorkerThreads.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>
#include <type_traits>

namespace rtsl::runtime {

namespace {

/// Small enough that cores finish together, large enough that taking one costs nothing.
constexpr std::uint32_t tileSize = 16;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

using SamplesNotFinite = FirstFew<SampleId, std::less<SampleId>>;

struct Renderer::Implementation {
  struct Worker;

  const Scene &scene;
  RenderOptions options;
  std::unique_ptr<HostScene> host;
  RtslLaunch launch{};
  double buildSeconds = 0;

  // One rendering.
  Image image;
  std::atomic<std::uint64_t> nextTile{0};
  std::atomic<bool> stop{false};
  std::uint64_t tilesAcross = 0, tileCount = 0;
  std::mutex mutex; // for what follows
  std::uint64_t tilesDone = 0;
  RenderStatistics totals;
  SamplesNotFinite notFinite{RTSL_FIRST_NOT_FINITE};

  Implementation(const Scene &scene, const RenderOptions &options)
      : scene(scene), options(options) {}

  bool isCancelled() const {
    return stop.load(std::memory_order_relaxed) ||
           (options.cancel && options.cancel->load(std::memory_order_relaxed));
  }
  template <typename Count>
  void renderTile(std::uint64_t tile, Worker &worker, Count components);
  void work();
  void add(Worker &worker);
  void report();
};

/// What one thread has rendered and met.
struct Renderer::Implementation::Worker {
  RtslLaunch launch;
  RtslStatus status{}; // lanes count in it
  std::uint64_t samples = 0, pixels = 0, pixelsWithoutSample = 0;
  SamplesNotFinite notFinite;
};

Renderer::Renderer(const Scene &scene, const RenderOptions &options)
    : self(std::make_unique<Implementation>(scene, options)) {
  checkOptions(options);
  Clock::time_point start = Clock::now();
  self->launch = scene.launch();
  const Program &program = scene.program();
  if (!program.sample)
    throw Error(ErrorCode::Internal, "the program has no code for samples");
  try {
    self->host = std::make_unique<HostScene>(scene, options.traversal == Traversal::Embree,
                                             threadCount(options));
    if (options.traversal == Traversal::Device)
      self->launch = self->host->deviceLaunch();
    // while little was done
    self->image = newImage(options.width, options.height, program.colorComponents);
  } catch (const std::bad_alloc &) {
    throw Error(ErrorCode::OutOfMemory, "not enough memory for the scene's acceleration structure");
  }
  self->launch.host = self->host.get();
  self->launch.width = options.width;
  self->launch.height = options.height;
  self->launch.maxDepth = options.maxDepth;
  self->launch.seed = options.seed;
  self->buildSeconds = secondsSince(start);
}

Renderer::~Renderer() = default;

const RtslLaunch &Renderer::launch() const {
  return self->launch;
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
      double sum[RTSL_MAX_COLOR] = {};
      std::uint32_t taken = 0, counted = 0;
      for (; taken < options.samplesPerPixel && !isCancelled(); ++taken) {
        float color[RTSL_MAX_COLOR];
        sample(&worker.launch, x, y, taken, color);
        bool finite = true;
        for (std::uint32_t c = 0; c < components; ++c)
          finite &= std::isfinite(color[c]);
        if (!finite) {
          worker.notFinite.add({x, y, taken});
          continue;
        }
        ++counted;
        for (std::uint32_t c = 0; c < components; ++c)
          sum[c] += double(color[c]);
      }
      worker.samples += taken;
      worker.pixels += taken == options.samplesPerPixel;
      worker.pixelsWithoutSample += taken > 0 && counted == 0;
      float *pixel = image.at(x, y);
      for (std::uint32_t c = 0; c < components; ++c)
        pixel[c] = counted ? float(sum[c] / double(counted)) : taken ? options.withoutSample : 0.0f;
    }
}

void Renderer::Implementation::work() {
  rayCounters() = RayCounters();
  Worker worker{launch, {}, 0, 0, 0, SamplesNotFinite(options.mostNotFinite)};
  worker.launch.status = &worker.status;
  try {
    while (!isCancelled()) {
      std::uint64_t tile = nextTile.fetch_add(1, std::memory_order_relaxed);
      if (tile >= tileCount)
        break;
      if (launch.colorComponents == 3)
        renderTile(tile, worker, std::integral_constant<std::uint32_t, 3>());
      else
        renderTile(tile, worker, launch.colorComponents);
      report();
    }
  } catch (...) {
    stop = true;
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
  totals.raysTooDeep += worker.status.raysTooDeep;
  for (std::uint32_t i = 0; i < RTSL_EXCEPTIONS; ++i)
    totals.exceptions[i] += worker.status.exceptions[i];
  notFinite.add(std::move(worker.notFinite));
}

void Renderer::Implementation::report() {
  std::lock_guard<std::mutex> lock(mutex);
  ++tilesDone;
  if (options.progress)
    options.progress(double(tilesDone) / double(tileCount));
}

Image Renderer::render(RenderStatistics *statistics) {
  Implementation &s = *self;
  Clock::time_point start = Clock::now();
  s.image = newImage(s.options.width, s.options.height, s.launch.colorComponents);
  s.tilesAcross = (s.options.width + tileSize - 1) / tileSize;
  s.tileCount = s.tilesAcross * ((s.options.height + tileSize - 1) / tileSize);
  s.nextTile = 0;
  s.tilesDone = 0;
  s.stop = false;
  s.totals = RenderStatistics();
  s.notFinite = SamplesNotFinite(s.options.mostNotFinite);

  const Program &program = s.scene.program();
  const std::uint64_t stackBytes =
      program.stackBytes ? program.stackBytes(s.options.maxDepth, s.launch.referenceChain) : 0;
  const unsigned threads = unsigned(std::min<std::uint64_t>(threadCount(s.options), s.tileCount));
  runOnThreads(threads, stackBytes, [&s](unsigned) { s.work(); });

  const std::uint64_t pixels = std::uint64_t(s.options.width) * s.options.height;
  s.totals.isUnfinished = s.totals.pixels < pixels;
  if (s.totals.isUnfinished && !s.options.keepsUnfinished)
    throw Error(ErrorCode::Cancelled, "rendering was cancelled");
  s.totals.samplesNotFinite = s.notFinite.total();
  s.totals.notFinite = s.notFinite.take();
  s.totals.buildSeconds = s.buildSeconds;
  s.totals.renderSeconds = secondsSince(start);
  if (statistics)
    *statistics = s.totals;
  return std::move(s.image);
}

Image render(const Scene &scene, const RenderOptions &options, RenderStatistics *statistics) {
  return Renderer(scene, options).render(statistics);
}

} // namespace rtsl::runtime
