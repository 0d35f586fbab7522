#include "MeasureItems.h"

#include "runtime/render/Renderer.h"
#include "support/ProcessorTime.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace rtsl::tool {

namespace {

/// Instructions that this process and its threads run in user mode. Many machines do not allow to
/// count them.
class InstructionCounter {
public:
  InstructionCounter() {
    perf_event_attr what{};
    what.type = PERF_TYPE_HARDWARE;
    what.size = sizeof what;
    what.config = PERF_COUNT_HW_INSTRUCTIONS;
    what.disabled = 1;
    what.inherit = 1;
    what.exclude_kernel = 1;
    what.exclude_hv = 1;
    descriptor = static_cast<int>(syscall(SYS_perf_event_open, &what, 0, -1, -1, 0));
  }
  ~InstructionCounter() {
    if (descriptor >= 0)
      close(descriptor);
  }
  InstructionCounter(const InstructionCounter &) = delete;

  void start() const {
    if (descriptor < 0)
      return;
    ioctl(descriptor, PERF_EVENT_IOC_RESET, 0);
    ioctl(descriptor, PERF_EVENT_IOC_ENABLE, 0);
  }
  std::optional<std::uint64_t> stop() const {
    std::uint64_t count = 0;
    if (descriptor < 0)
      return std::nullopt;
    ioctl(descriptor, PERF_EVENT_IOC_DISABLE, 0);
    if (read(descriptor, &count, sizeof count) != sizeof count || count == 0)
      return std::nullopt;
    return count;
  }

private:
  int descriptor = -1;
};

struct TimedRendering {
  double seconds = 0;
  std::optional<std::uint64_t> instructions;
  std::vector<float> pixels;
};

/// A scene with its program and its trees, ready to be rendered again and again.
class Subject {
public:
  Subject(runtime::Scene made, const runtime::RenderOptions &options)
      : scene(std::make_unique<runtime::Scene>(std::move(made))), renderer(*scene, options) {}

  TimedRendering render(const InstructionCounter &counter) {
    TimedRendering rendering;
    const double start = processorSeconds();
    counter.start();
    const runtime::Image image = renderer.render();
    rendering.instructions = counter.stop();
    rendering.seconds = processorSeconds() - start;
    rendering.pixels = image.pixels;
    return rendering;
  }

private:
  std::unique_ptr<runtime::Scene> scene;
  runtime::Renderer renderer;
};

std::unique_ptr<Subject> makeSubject(const MeasureRequest &what, ItemSet kept,
                                     Diagnostics &diagnostics) {
  LinkRequest request = what.request;
  CompileOptions compile = what.compile;
  keep(kept, request, compile);
  std::optional<runtime::Scene> scene =
      compileScene(what.module, request, compile, diagnostics, what.buildScene);
  return scene ? std::make_unique<Subject>(std::move(*scene), what.render) : nullptr;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 != 0 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

bool sameBits(const std::vector<float> &a, const std::vector<float> &b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

ItemMeasurement compare(Subject &leftOut, Subject &kept, const MeasureRequest &what,
                        const InstructionCounter &counter) {
  ItemMeasurement measurement;
  measurement.pairs = what.pairs;
  std::vector<double> seconds, ratios;
  leftOut.render(counter); // caches and clocks warm up
  kept.render(counter);
  for (unsigned pair = 0; pair < what.pairs; ++pair) {
    TimedRendering without, with;
    if (pair % 2 == 0)
      without = leftOut.render(counter), with = kept.render(counter);
    else
      with = kept.render(counter), without = leftOut.render(counter);
    seconds.push_back(without.seconds);
    ratios.push_back(with.seconds / without.seconds - 1);
    measurement.isSameImage &= sameBits(with.pixels, without.pixels);
    measurement.instructions = without.instructions;
    measurement.instructionsKept = with.instructions;
  }
  measurement.seconds = median(seconds);
  measurement.slower = median(ratios);
  std::sort(ratios.begin(), ratios.end());
  const auto [low, high] = medianRanks(ratios.size());
  measurement.slowerLow = ratios[low];
  measurement.slowerHigh = ratios[high];
  return measurement;
}

} // namespace

std::pair<std::size_t, std::size_t> medianRanks(std::size_t count) {
  // P(fewer than k + 1 of n lie below the median), from the binomial distribution with 1/2.
  double below = 0, term = std::pow(0.5, static_cast<double>(count));
  std::size_t rank = 0;
  for (std::size_t k = 0; 2 * k + 1 < count; ++k) {
    below += term;
    if (2 * below > 0.05)
      break;
    rank = k;
    term *= static_cast<double>(count - k) / static_cast<double>(k + 1);
  }
  return {rank, count - 1 - rank};
}

std::optional<std::vector<ItemMeasurement>> measureItems(const MeasureRequest &what,
                                                         Diagnostics &diagnostics) {
  const InstructionCounter counter;
  const std::unique_ptr<Subject> leftOut = makeSubject(what, {}, diagnostics);
  if (!leftOut)
    return std::nullopt;
  std::vector<ItemMeasurement> measurements;
  for (std::size_t i = 0; i < what.kept.size(); ++i) {
    Diagnostics unheard(diagnostics.sources());
    if (what.progress)
      what.progress(static_cast<double>(i) / static_cast<double>(what.kept.size()));
    const std::unique_ptr<Subject> kept = makeSubject(what, what.kept[i], unheard);
    if (!kept)
      continue; // a class that the scene does not use may be incomplete
    measurements.push_back(compare(*leftOut, *kept, what, counter));
    measurements.back().kept = what.names[i];
  }
  return measurements;
}

} // namespace rtsl::tool
