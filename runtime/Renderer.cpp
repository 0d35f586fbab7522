#include "runtime/Renderer.h"

#include "runtime/HostScene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace rtsl::runtime {

namespace {

/// Small enough that cores finish together, large enough that taking one costs nothing.
constexpr std::uint32_t tileSize = 16;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

struct Renderer::Implementation {
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
  RtslStatus status{}; // of the samples: lanes count in it
  std::exception_ptr failure;

  Implementation(const Scene &scene, const RenderOptions &options)
      : scene(scene), options(options) {}

  template <typename Count>
  void renderTile(std::uint64_t tile, std::uint64_t &notFinite, Count components);
  void work();
  void report();
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
    self->image = Image(options.width, options.height, program.colorComponents);
  } catch (const std::bad_alloc &) {
    throw Error(ErrorCode::OutOfMemory,
                "not enough memory for the scene's acceleration structure or the picture");
  }
  self->launch.host = self->host.get();
  self->launch.width = options.width;
  self->launch.height = options.height;
  self->launch.maxDepth = options.maxDepth;
  self->launch.seed = options.seed;
  self->launch.status = &self->status;
  self->buildSeconds = secondsSince(start);
}

Renderer::~Renderer() = default;

const RtslLaunch &Renderer::launch() const {
  return self->launch;
}

/// Sums of a pixel are taken in the order of its samples, whoever takes them. A number of
/// components that is a constant makes no loops of them.
template <typename Count>
void Renderer::Implementation::renderTile(std::uint64_t tile, std::uint64_t &notFinite,
                                          Count components) {
  auto sample = scene.program().sample;
  std::uint32_t x0 = std::uint32_t(tile % tilesAcross) * tileSize,
                y0 = std::uint32_t(tile / tilesAcross) * tileSize;
  std::uint32_t x1 = std::min(x0 + tileSize, launch.width),
                y1 = std::min(y0 + tileSize, launch.height);
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = x0; x < x1; ++x) {
      double sum[RTSL_MAX_COLOR] = {};
      for (std::uint32_t s = 0; s < options.samplesPerPixel; ++s) {
        float color[RTSL_MAX_COLOR];
        sample(&launch, x, y, s, color);
        bool finite = true;
        for (std::uint32_t c = 0; c < components; ++c)
          finite &= std::isfinite(color[c]);
        if (!finite) { // one of them would take the whole pixel with it
          ++notFinite;
          continue;
        }
        for (std::uint32_t c = 0; c < components; ++c)
          sum[c] += double(color[c]);
      }
      float *pixel = image.at(x, y);
      for (std::uint32_t c = 0; c < components; ++c)
        pixel[c] = float(sum[c] / double(options.samplesPerPixel));
    }
}

void Renderer::Implementation::work() {
  RayCounters &counters = rayCounters();
  counters = RayCounters();
  std::uint64_t notFinite = 0;
  try {
    for (;;) {
      if (stop.load(std::memory_order_relaxed) ||
          (options.cancel && options.cancel->load(std::memory_order_relaxed)))
        break;
      std::uint64_t tile = nextTile.fetch_add(1, std::memory_order_relaxed);
      if (tile >= tileCount)
        break;
      if (launch.colorComponents == 3)
        renderTile(tile, notFinite, std::integral_constant<std::uint32_t, 3>());
      else
        renderTile(tile, notFinite, launch.colorComponents);
      report();
    }
  } catch (...) {
    std::lock_guard<std::mutex> lock(mutex);
    if (!failure)
      failure = std::current_exception();
    stop = true;
  }
  std::lock_guard<std::mutex> lock(mutex);
  totals.badRays += counters.badRays;
  totals.retracedRays += counters.retracedRays;
  totals.rescaledRays += counters.rescaledRays;
  totals.samplesNotFinite += notFinite;
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
  s.image = Image(s.options.width, s.options.height, s.launch.colorComponents);
  s.tilesAcross = (s.options.width + tileSize - 1) / tileSize;
  s.tileCount = s.tilesAcross * ((s.options.height + tileSize - 1) / tileSize);
  s.nextTile = 0;
  s.tilesDone = 0;
  s.stop = false;
  s.totals = RenderStatistics();
  s.status = RtslStatus();
  s.failure = nullptr;

  std::vector<std::thread> helpers;
  unsigned threads = unsigned(std::min<std::uint64_t>(threadCount(s.options), s.tileCount));
  try {
    for (unsigned i = 1; i < threads; ++i)
      helpers.emplace_back([&s] { s.work(); });
  } catch (const std::system_error &) {
    // Fewer threads than hoped for: the picture is the same.
  }
  s.work();
  for (std::thread &helper : helpers)
    helper.join();

  if (s.failure)
    std::rethrow_exception(s.failure);
  if (s.tilesDone < s.tileCount)
    throw Error(ErrorCode::Cancelled, "rendering was cancelled");
  s.totals.samples = std::uint64_t(s.options.width) * s.options.height * s.options.samplesPerPixel;
  s.totals.buildSeconds = s.buildSeconds;
  std::copy_n(s.status.exceptions, RTSL_EXCEPTIONS, s.totals.exceptions);
  s.totals.renderSeconds = secondsSince(start);
  if (statistics)
    *statistics = s.totals;
  return std::move(s.image);
}

Image render(const Scene &scene, const RenderOptions &options, RenderStatistics *statistics) {
  return Renderer(scene, options).render(statistics);
}

} // namespace rtsl::runtime
