//===- Outcome.cpp - messages about the outcome of a rendering ------------===//
#include "Outcome.h"

#include "Interruption.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

namespace rtsl::tool {

std::string notFiniteText(const runtime::RenderStatistics &statistics) {
  if (statistics.pixelsWithoutSample == 0)
    return message::samplesNotFinite(statistics.samplesNotFinite, statistics.samples);
  return message::samplesNotFinitePixelsBlack(statistics.samplesNotFinite, statistics.samples,
                                              statistics.pixelsWithoutSample);
}

std::string sampleText(const runtime::SampleId &sample) {
  return fmt::format("pixel {},{} sample {}{}", sample.x, sample.y,
                     sample.sample % RTSL_SECOND_HALF,
                     sample.sample >= RTSL_SECOND_HALF ? " of the second half" : "");
}

std::string tooDeepText(const runtime::RenderStatistics &statistics,
                        const runtime::RenderOptions &options, const char *depth) {
  return message::raysTooDeep(statistics.raysTooDeep, statistics.samples, options.maxDepth, depth);
}

std::string badRaysText(const runtime::RenderStatistics &statistics) {
  if (!statistics.badRays || statistics.exceptions[RTSL_EXCEPTION_BAD_RAY])
    return {};
  return message::badRays(statistics.badRays);
}

std::vector<std::string> exceptionTexts(const runtime::RenderStatistics &statistics,
                                        const runtime::RenderOptions &options, const char *depth) {
  const std::uint64_t *counts = statistics.exceptions;
  std::vector<std::string> texts;
  if (counts[RTSL_EXCEPTION_STACK_OVERFLOW])
    texts.push_back(
        message::samplesTooDeep(counts[RTSL_EXCEPTION_STACK_OVERFLOW], options.maxDepth, depth));
  if (counts[RTSL_EXCEPTION_BAD_RAY])
    texts.push_back(message::samplesOfBadRays(counts[RTSL_EXCEPTION_BAD_RAY]));
  if (counts[RTSL_EXCEPTION_INDEX])
    texts.push_back(message::samplesOutOfRange(counts[RTSL_EXCEPTION_INDEX]));
  return texts;
}

std::string unfinishedText(const runtime::RenderStatistics &statistics,
                           const runtime::RenderOptions &options) {
  const double pixels = double(windowOf(options).pixels());
  return message::pictureUnfinished(
      nameOfStop(), 100 * double(statistics.samples) / (pixels * options.samplesPerPixel),
      statistics.pixels, pixels);
}

const char *nameOfStop() {
  const char *const signal = interruption();
  return signal ? signal : "the caller";
}

std::string unfinishedPassesText(const runtime::PassState &state,
                                 const runtime::RenderStatistics &statistics,
                                 const runtime::RenderOptions &options, bool isOpenEnded) {
  return fmt::format("stopped by {} after {}{} samples per pixel{}", nameOfStop(),
                     state.samplesPerPixel,
                     isOpenEnded ? "" : fmt::format(" of {}", options.samplesPerPixel),
                     !statistics.isUnfinished    ? ""
                     : state.samplesPerPixel > 0 ? "; some pixels have more"
                                                 : "; some pixels have more, the others are black");
}

const char *nameOf(runtime::TreeKind kind) {
  return kind == runtime::TreeKind::Fast ? "fast" : "good";
}

std::string treeText(const runtime::TreeFigures &tree) {
  const std::string cost = tree.cost > 0 ? fmt::format(", cost {:.3g}", tree.cost) : "";
  return fmt::format("{} tree: {} nodes for {} items{}, {} in {:.0f} ms", nameOf(tree.kind),
                     tree.nodes, tree.items, cost, tree.isRefitted ? "refitted" : "built",
                     tree.seconds * 1e3);
}

std::string gpuText(const runtime::GpuStatistics &gpu) {
  const std::string spills =
      gpu.spillStores && *gpu.spillStores > 0 ? fmt::format(" ({} spilled)", *gpu.spillStores) : "";
  const std::string samples = gpu.samples ? fmt::format("{} samples; ", *gpu.samples) : "";
  return fmt::format("{}: {}{} registers and {} local bytes{} per thread, {} blocks of {} threads "
                     "({:.0f} % of those that fit), {} bytes for the rays of each; code loaded in "
                     "{:.0f} ms, scene in {:.0f} ms",
                     gpu.device, samples, gpu.registers, gpu.localBytes, spills, gpu.blocks,
                     gpu.threadsPerBlock, gpu.occupancy * 100, gpu.laneBytes, gpu.loadSeconds * 1e3,
                     gpu.uploadSeconds * 1e3);
}

} // namespace rtsl::tool
