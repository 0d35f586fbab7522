//===- ExplainGpu.h - what a scene's program costs a GPU ------------------===//
#pragma once

#include "codegen/driver/SceneProgram.h"

#include <cstdint>
#include <optional>
#include <string>

namespace rtsl::tool {

struct GpuRequest {
  const std::string &scene; // its file, for people
  const typed::Module &module;
  const LinkRequest &request;
  const CompileOptions &compile;
  const BuildScene &buildScene;
  std::uint32_t maxDepth = 0;
  std::uint32_t maxRegisters = 0; // of the megakernel; 0: by the program
  bool isJson = false;
};

/// Registers, spills, local memory and occupancy of the megakernel and of each of its steps alone,
/// as a wavefront has them, and the bytes of the rays of a sample. Nothing if there were errors.
std::optional<std::string> explainGpu(const GpuRequest &what, Diagnostics &diagnostics);

} // namespace rtsl::tool
