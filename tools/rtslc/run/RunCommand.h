//===- RunCommand.h - what commands that run launches share ---------------===//
#pragma once

#include "tools/common/BufferOptions.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/render/RenderTarget.h"

#include <string>
#include <vector>

namespace rtsl::tool {

struct RunOptions {
  CommonOptions common;
  std::string scene;
  std::string picture; // empty: none is written
  std::vector<BufferFile> inputs, outputs;
  std::vector<std::string> overrides;
  std::uint32_t threads = 0;
  std::uint32_t pixelsInTurns = 0; // 0: not given
  std::uint32_t repeats = 0;       // further runs of each launch, to measure it
  runtime::Traversal traversal = runtime::Traversal::Embree;
  std::optional<runtime::TreeKind> tree;
  TargetName target = TargetName::Host;
  bool hasGpuArchitecture = false; // --gpu-arch was given
  GpuOptions gpu;
  bool json = false, quiet = false, prints = false, exceptions = false;
};

/// Adds the options that do not depend on what is run: threads, target, messages, ...
void addRunOptions(CLI::App &command, RunOptions &options);
/// When all options are read. Throws CLI::ValidationError for those that exclude each other.
void completeRunOptions(const CLI::App &command, RunOptions &options);

/// Runs the launches of the scene and writes the outputs. Gives the exit status.
int runLaunches(RunOptions options);

} // namespace rtsl::tool
