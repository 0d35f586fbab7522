#include "runtime/render/Backend.h"

#include "runtime/render/Watch.h"
#include "support/Clock.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"
#include "support/ProcessorTime.h"

#include <utility>

namespace rtsl::runtime {

static const RenderOptions &checked(const RenderOptions &options) {
  checkOptions(options);
  return options;
}

Backend::Backend(const RenderOptions &options) : options(checked(options)) {}

Backend::~Backend() = default;

void Backend::makePicture(std::uint32_t channels) {
  const Window window = windowOf(options);
  picture = newImage(window.width(), window.height(), channels);
  if (options.crop) {
    picture.left = window.x0;
    picture.top = window.y0;
    picture.wholeWidth = options.width;
    picture.wholeHeight = options.height;
  }
}

void addEvents(const RtslStatus &status, RenderStatistics &statistics) {
  statistics.badRays += status.badRays;
  statistics.raysTooDeep += status.raysTooDeep;
  for (std::uint32_t i = 0; i < RTSL_EXCEPTIONS; ++i)
    statistics.exceptions[i] += status.exceptions[i];
  add(status.visits, statistics.visits);
}

Image Backend::render(RenderStatistics *statistics) {
  return renderAtOnce(options, statistics);
}

Image Backend::renderAtOnce(const RenderOptions &watched, RenderStatistics *statistics) {
  if (picture.pixels.empty())
    makePicture(channels());
  RenderStatistics said;
  samplesOfPixel = options.samplesPerPixel;
  try {
    begin();
    Watch watch(watched);
    const Clock::time_point start = Clock::now();
    const double processorStart = processorSeconds();
    run(watch);
    const double seconds = secondsSince(start), processor = processorSeconds() - processorStart;
    said = finish();
    said.renderSeconds = seconds;
    said.processorSeconds = processor;
  } catch (...) { // a partial picture is not returned
    picture = Image();
    throw;
  }
  said.buildSeconds = buildSeconds;
  said.tree = trees;
  said.isRefitted = isRefitted;
  said.isUnfinished = said.pixels < pixelCount();
  Image image = std::exchange(picture, Image());
  if (said.isUnfinished && !watched.keepsUnfinished)
    throw Error(message::renderingCancelled());
  if (statistics)
    *statistics = std::move(said);
  return image;
}

} // namespace rtsl::runtime
