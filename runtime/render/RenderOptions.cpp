#include "runtime/render/RenderOptions.h"

#include "runtime/device/ray/Divisor.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace rtsl::runtime {

static void checkRange(const char *what, std::uint64_t value, std::uint64_t lowest,
                       std::uint64_t highest) {
  if (value < lowest || value > highest)
    throw Error(message::optionOutOfRange(what, lowest, highest, value));
}

void add(const RtslTreeVisits &part, RtslTreeVisits &all) {
  all.rays += part.rays;
  all.nodes += part.nodes;
  all.items += part.items;
}

void addMet(RenderStatistics &&part, std::size_t most, RenderStatistics &met) {
  met.badRays += part.badRays;
  met.retracedRays += part.retracedRays;
  met.rescaledRays += part.rescaledRays;
  met.raysTooDeep += part.raysTooDeep;
  for (std::uint32_t i = 0; i < RTSL_EXCEPTIONS; ++i)
    met.exceptions[i] += part.exceptions[i];
  add(part.visits, met.visits);
  met.notFinite.insert(met.notFinite.end(), part.notFinite.begin(), part.notFinite.end());
  std::sort(met.notFinite.begin(), met.notFinite.end());
  met.notFinite.resize(std::min(met.notFinite.size(), most));
  met.steps.resize(std::max(met.steps.size(), part.steps.size()));
  for (std::size_t i = 0; i < part.steps.size(); ++i) {
    met.steps[i].steps += part.steps[i].steps;
    met.steps[i].lanes += part.steps[i].lanes;
  }
}

void setLaunch(RtslLaunch &launch, const RenderOptions &options) {
  device::setLaunchSize(launch, options.width, options.height / options.slices, options.slices);
  launch.maxDepth = options.maxDepth;
  launch.seed = options.seed;
}

static void checkSize(const RenderOptions &options) {
  checkRange("width", options.width, 1, options.height == 1 ? mostLaunchWidth : mostPixelsOfSide);
  if (options.slices == 1)
    return checkRange("height", options.height, 1, mostPixelsOfSide);
  checkRange("number of slices", options.slices, 1, mostPixelsOfSide);
  checkRange("number of rows", options.height, 1, mostLaunchRows);
  checkRange("number of launch indices", std::uint64_t(options.width) * options.height, 1,
             mostLaunchIndices);
  if (options.height % options.slices != 0)
    throw Error(message::rowsNotInSlices(options.height, options.slices));
}

void checkOptions(const RenderOptions &options) {
  checkSize(options);
  if (const std::optional<Window> &crop = options.crop;
      crop && (crop->x0 >= crop->x1 || crop->y0 >= crop->y1 || crop->x1 > options.width ||
               crop->y1 > options.height))
    throw Error(message::cropOutside(crop->x0, crop->y0, crop->x1, crop->y1, options.width,
                                     options.height));
  checkRange("number of samples per pixel", options.samplesPerPixel, 1, mostSamplesPerPixel);
  // Each level of trace takes stack of the thread.
  checkRange("depth", options.maxDepth, 0, maxRayDepth);
}

Window windowOf(const RenderOptions &options) {
  return options.crop.value_or(Window{0, 0, options.width, options.height});
}

unsigned threadCount(const RenderOptions &options) {
  if (options.threads)
    return std::min(options.threads, mostThreads);
  return std::max(1u, std::thread::hardware_concurrency());
}

} // namespace rtsl::runtime
