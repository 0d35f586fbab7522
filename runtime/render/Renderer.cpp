#include "runtime/render/Renderer.h"

#include "runtime/device/organisations/Slice.h"
#include "runtime/embree/HostScene.h"
#include "runtime/render/HostThreads.h"
#include "runtime/render/Watch.h"
#include "support/Clock.h"
#include "support/ErrorMessages.h"
#include "support/Fibers.h"
#include "support/FirstFew.h"

#include <algorithm>
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
  Window tile = {};           // that it renders; empty: none
  std::uint32_t x = 0, y = 0; // its next pixel
};

/// The sums of one pixel, or of a half of its samples.
struct PixelSum {
  double colors[RTSL_MAX_COLOR] = {};
  double squares = 0, values = 0; // of the means of the components
  std::uint32_t counted = 0, deciding = 0;
  bool isClosed = false;   // `colors` is complete,
  bool hasDecided = false; // and `squares` and `values` are

  template <typename Count>
  void add(const float *color, Count components) {
    for (std::uint32_t c = 0; c < components; ++c)
      colors[c] += double(color[c]);
    ++counted;
  }

  template <typename Count>
  void decide(const float *color, Count components) {
    double value = 0;
    for (std::uint32_t c = 0; c < components; ++c)
      value += double(color[c]);
    value /= double(components);
    values += value;
    squares += value * value;
    ++deciding;
  }

  template <typename Count>
  void load(const PixelSums &from, std::size_t pixel, std::uint32_t half, Count components) {
    const std::size_t at = pixel * from.halves() + half;
    std::copy_n(&from.colors[at * components], std::uint32_t(components), colors);
    if (from.isMeasured())
      squares = from.squares[at];
    counted = from.counted[at];
    if (from.isAdaptive()) {
      values = from.values[at];
      deciding = from.deciding[at];
      isClosed = from.closed[pixel] >> half & 1;
      hasDecided = from.closed[pixel] >> (1 - half) & 1;
    }
  }

  template <typename Count>
  void store(PixelSums &to, std::size_t pixel, std::uint32_t half, Count components) const {
    const std::size_t at = pixel * to.halves() + half;
    std::copy_n(colors, std::uint32_t(components), &to.colors[at * components]);
    if (to.isMeasured())
      to.squares[at] = squares;
    to.counted[at] = counted;
    if (to.isAdaptive()) {
      to.values[at] = values;
      to.deciding[at] = deciding;
    }
  }
};

std::uint64_t stackBytes(const Program &program, const RtslLaunch &launch) {
  return program.stackBytes ? program.stackBytes(launch.maxDepth, launch.referenceChain) : 0;
}

} // namespace

struct Renderer::Implementation {
  const Scene &scene;
  const RenderOptions &options;
  std::shared_ptr<HostScene> host;
  RtslLaunch launch{};

  // One rendering.
  Image *image = nullptr;
  Watch *watch = nullptr;
  std::uint32_t samplesOfPixel = 0;
  PixelSums *sums = nullptr; // of the passes before; null: there is one pass
  std::atomic<std::uint64_t> nextTile{0};
  Window window;
  std::uint64_t tilesAcross = 0, tileCount = 0;
  std::mutex mutex; // for what follows
  RenderStatistics totals;
  SamplesNotFinite notFinite{RTSL_FIRST_NOT_FINITE};

  Implementation(const Scene &scene, const RenderOptions &options)
      : scene(scene), options(options) {}

  bool takeTile(Worker &worker);
  template <typename Count>
  void renderPixels(Worker &worker, Count components);
  template <std::uint32_t halves, typename Count>
  void renderPixel(std::uint32_t x, std::uint32_t y, Worker &worker, Count components);
  unsigned pixelsInTurns() const;
  void work(std::uint64_t stack);
  void add(Worker &worker);
};

Renderer::Renderer(const Scene &scene, const RenderOptions &options,
                   std::shared_ptr<HostScene> hostScene)
    : Renderer(scene, options, std::move(hostScene), nullptr) {}

Renderer::Renderer(const Scene &scene, const RenderOptions &options,
                   std::shared_ptr<KeptTrees> kept)
    : Renderer(scene, options, nullptr, std::move(kept)) {}

Renderer::Renderer(const Scene &scene, const RenderOptions &options,
                   std::shared_ptr<HostScene> hostScene, std::shared_ptr<KeptTrees> kept)
    : Backend(options), self(std::make_unique<Implementation>(scene, this->options)) {
  const Clock::time_point start = Clock::now();
  const RtslLaunch complete = scene.launch(); // or it throws
  const Program &program = scene.program();
  if (!program.sample)
    throw Error(message::noCodeForSamples());
  try {
    self->host = std::move(hostScene);
    if (!self->host)
      self->host = std::make_shared<HostScene>(scene, options.traversal == Traversal::Embree,
                                               threadCount(options), options.tree,
                                               kept ? std::move(*kept) : KeptTrees());
    isRefitted = self->host->isRefitted();
    makePicture(complete.colorComponents);
    update();
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryForTree());
  }
  self->window = windowOf(options);
  self->tilesAcross = (self->window.width() + tileSize - 1) / tileSize;
  self->tileCount = self->tilesAcross * ((self->window.height() + tileSize - 1) / tileSize);
  buildSeconds = secondsSince(start);
}

Renderer::~Renderer() = default;

void Renderer::update() {
  self->host->update();
  self->launch =
      options.traversal == Traversal::Device ? self->host->deviceLaunch() : self->scene.launch();
  self->launch.host = self->host.get();
  setLaunch(self->launch, options);
}

std::shared_ptr<HostScene> Renderer::hostScene() const {
  return self->host;
}

std::shared_ptr<KeptTrees> Renderer::takeTrees() {
  return std::make_shared<KeptTrees>(self->host->takeTrees());
}

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

/// The sums of a pixel are taken in the order of its samples, on whichever thread. A sample that is
/// not finite is left out, because one such sample would make the mean of the pixel not finite. The
/// numbers of halves and of components are template arguments so that compilers unroll the loops
/// over them.
template <std::uint32_t halves, typename Count>
void Renderer::Implementation::renderPixel(std::uint32_t x, std::uint32_t y, Worker &worker,
                                           Count components) {
  const auto sample = scene.program().sample;
  const std::uint32_t column = x - window.x0, row = y - window.y0;
  const std::size_t index = std::size_t(row) * window.width() + column;
  PixelSum parts[halves];
  for (std::uint32_t half = 0; sums && half < halves; ++half)
    parts[half].load(*sums, index, half, components);
  const bool isMeasured = sums && sums->isMeasured();
  const std::uint32_t before = sums ? sums->taken[index] : 0;
  std::uint32_t taken = before;
  for (; taken < samplesOfPixel && !watch->isStopped(); ++taken) {
    PixelSum &sum = parts[taken % halves];
    const std::uint32_t number = device::numberInHalf(taken, halves);
    float color[RTSL_MAX_COLOR];
    sample(&worker.launch, x, y, number, color);
    if (!isFinite(color, components)) {
      worker.notFinite.add({x, y, number});
      continue;
    }
    if (!sum.isClosed)
      sum.add(color, components);
    if (isMeasured && !sum.hasDecided)
      sum.decide(color, components);
  }
  worker.samples += taken - before;
  worker.pixels += taken >= samplesOfPixel;
  if (sums) {
    for (std::uint32_t half = 0; half < halves; ++half)
      parts[half].store(*sums, index, half, components);
    sums->taken[index] = taken;
    return;
  }
  const PixelSum &sum = parts[0];
  worker.pixelsWithoutSample += taken > 0 && sum.counted == 0;
  float *pixel = image->at(column, row);
  for (std::uint32_t c = 0; c < components; ++c)
    pixel[c] = sum.counted ? float(sum.colors[c] / double(sum.counted))
               : taken     ? options.withoutSample
                           : 0.0f;
}

/// Begins the next tile. False: there is none. Of the tile before, the pixels of this thread's
/// other fibers may not be finished.
bool Renderer::Implementation::takeTile(Worker &worker) {
  if (worker.tile.pixels() != 0)
    watch->advance(tileCount);
  worker.tile = {};
  worker.y = 0;
  if (watch->isStopped())
    return false;
  const std::uint64_t tile = nextTile.fetch_add(1, std::memory_order_relaxed);
  if (tile >= tileCount)
    return false;
  const std::uint32_t x0 = window.x0 + std::uint32_t(tile % tilesAcross) * tileSize,
                      y0 = window.y0 + std::uint32_t(tile / tilesAcross) * tileSize;
  worker.tile = {x0, y0, std::min(x0 + tileSize, window.x1), std::min(y0 + tileSize, window.y1)};
  worker.x = x0;
  worker.y = y0;
  return true;
}

/// Renders pixels, one after the other, until no tile is left.
template <typename Count>
void Renderer::Implementation::renderPixels(Worker &worker, Count components) {
  for (;;) {
    if (worker.y == worker.tile.y1 && !takeTile(worker))
      return;
    const std::uint32_t x = worker.x, y = worker.y;
    if (++worker.x == worker.tile.x1) {
      worker.x = worker.tile.x0;
      ++worker.y;
    }
    const std::size_t index = std::size_t(y - window.y0) * window.width() + (x - window.x0);
    if (sums && !sums->isOpen(index))
      ++worker.pixels;
    else
      sums && sums->isAdaptive() ? renderPixel<2>(x, y, worker, components)
                                 : renderPixel<1>(x, y, worker, components);
  }
}

/// Where the frames of shaders may be large, or are not known, there are no stacks for several
/// pixels.
unsigned Renderer::Implementation::pixelsInTurns() const {
  constexpr std::uint64_t largestStack = 16 << 20;
  const Program &program = scene.program();
  if (options.pixelsInTurns != 0)
    return options.pixelsInTurns;
  return program.stackBytes && stackBytes(program, launch) <= largestStack ? host->raysInTurns()
                                                                           : 1;
}

void Renderer::Implementation::work(std::uint64_t stack) {
  rayCounters() = RayCounters();
  Worker worker{launch, {}, 0, 0, 0, SamplesNotFinite(options.mostNotFinite)};
  worker.launch.status = &worker.status;
  Fibers::run(pixelsInTurns(), stack, [&](unsigned) {
    try {
      if (launch.colorComponents == 3)
        renderPixels(worker, std::integral_constant<std::uint32_t, 3>());
      else
        renderPixels(worker, launch.colorComponents);
    } catch (...) {
      watch->stop();
      throw;
    }
  });
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
  self->totals = RenderStatistics();
  self->notFinite = SamplesNotFinite(options.mostNotFinite);
}

void Renderer::run(Watch &watch) {
  self->image = &picture;
  self->watch = &watch;
  self->samplesOfPixel = samplesOfPixel;
  self->sums = sums;
  const std::uint64_t stack = stackBytes(self->scene.program(), self->launch);
  const HostThreads threads(options, self->tileCount, stack);
  threads.run([&](unsigned) { self->work(stack); });
}

RenderStatistics Renderer::finish() {
  trees = self->host->treeFigures(); // with Embree it is built for the first ray that needs it
  self->totals.samplesNotFinite = self->notFinite.total();
  self->totals.notFinite = self->notFinite.take();
  return std::move(self->totals);
}

Image render(const Scene &scene, const RenderOptions &options, RenderStatistics *statistics) {
  return Renderer(scene, options).render(statistics);
}

} // namespace rtsl::runtime
