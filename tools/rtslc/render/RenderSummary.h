//===- RenderSummary.h - the summary that rtslc render prints -------------===//
#pragma once

#include "NotFinite.h"
#include "RenderCommand.h"
#include "runtime/gpu/GpuRenderer.h"
#include "tools/rtslc/common/Messages.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace rtsl::tool {

struct Times {
  double compile = 0, scene = 0, image = 0;
};

/// What is reported about a rendering when it is over.
struct PictureSummary {
  runtime::RenderOptions render;
  runtime::RenderStatistics statistics;
  std::vector<SampleNotFinite> notFinite;
  std::vector<std::string> printed, stateNames;
  Times times;
  std::vector<runtime::GpuStatistics> gpus;               // that took part
  double error = std::numeric_limits<double>::infinity(); // runtime::PassState::error
  std::string unfinished;      // says that the picture is so; empty: it is not
  std::uint32_t resumedAt = 0; // samples per pixel of the checkpoint
};

/// Warns of what makes a picture wrong although it was rendered: samples that are left out, and
/// rays that are not sent.
void warn(const PictureSummary &summary, Messages &messages);

/// Times and counts, in the form that the options choose.
void printSummary(const RenderCommandOptions &options, const PictureSummary &summary);

} // namespace rtsl::tool
