//===- Outcome.h - messages about the outcome of a rendering --------------===//
#pragma once

#include "runtime/gpu/GpuRenderer.h"
#include "runtime/render/RenderOptions.h"
#include "runtime/render/passes/Passes.h"

#include <string>
#include <vector>

namespace rtsl::tool {

/// "3 samples of 1000 were infinite or not a number, and are left out of the means of their pixels"
std::string notFiniteText(const runtime::RenderStatistics &statistics);

/// "pixel 12,40 sample 3"
std::string sampleText(const runtime::SampleId &sample);

constexpr const char *depthOption = "`--depth`";

/// "25 rays in 1000 samples exceeded the depth limit 8 and returned nothing: ..." `depth` is what
/// sets this limit.
std::string tooDeepText(const runtime::RenderStatistics &statistics,
                        const runtime::RenderOptions &options, const char *depth = depthOption);

/// "3 rays had no direction or were not finite, and returned black"; empty: none, or they ended
/// samples.
std::string badRaysText(const runtime::RenderStatistics &statistics);

/// A sentence for each kind of exception that samples met.
std::vector<std::string> exceptionTexts(const runtime::RenderStatistics &statistics,
                                        const runtime::RenderOptions &options,
                                        const char *depth = depthOption);

/// "stopped by SIGINT after 12.5 % of the samples: 100 of 800 pixels are done, ..."
std::string unfinishedText(const runtime::RenderStatistics &statistics,
                           const runtime::RenderOptions &options);

/// "SIGINT", or "the caller" if no signal has come.
const char *nameOfStop();

/// The same of a rendering in passes: "stopped by SIGINT after 12 of 64 samples per pixel".
/// `isOpenEnded`: no number of samples was requested.
std::string unfinishedPassesText(const runtime::PassState &state,
                                 const runtime::RenderStatistics &statistics,
                                 const runtime::RenderOptions &options, bool isOpenEnded);

/// "fast" or "good"
const char *nameOf(runtime::TreeKind kind);

/// "fast trees: 15,977 nodes for 99,950 items, cost 7.06, built in 4 ms"
std::string treeText(const runtime::TreeFigures &tree);

/// "NVIDIA H100: 80 registers and 2400 local bytes per thread, ..."
std::string gpuText(const runtime::GpuStatistics &gpu);

} // namespace rtsl::tool
