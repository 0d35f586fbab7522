//===- ExplainCommand.h - the options of rtslc explain -------------------===//
#pragma once

#include "tools/common/GpuOptions.h"
#include "tools/common/PictureOptions.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"

#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

struct ExplainOptions {
  CommonOptions common;
  std::vector<std::string> files, overrides;
  std::string output = "-";
  bool states = false, measure = false, noSavings = false, gpu = false;
  GpuOptions gpuOptions;
  unsigned pairs = 11;
  std::optional<PictureSize> size; // of pictures that are measured
  std::uint32_t samples = 1;
  ReportFormat format = ReportFormat::Text;
};

/// What the program of a scene contains and leaves out, its states, or what it costs a GPU; nothing
/// if there were errors.
std::optional<std::string> explainScene(const ExplainOptions &options, Messages &messages,
                                        std::vector<std::string> &filesRead);

} // namespace rtsl::tool
