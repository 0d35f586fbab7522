//===- RenderIdentity.h - what the bits of a picture depend on -------------===//
#pragma once

#include "RenderTarget.h"
#include "runtime/render/passes/Checkpoint.h"
#include "scenefile/SceneFile.h"
#include "tools/rtslc/common/Messages.h"

#include <string>
#include <vector>

namespace rtsl::tool {

/// What rtslc render makes a picture of.
struct RenderInput {
  const scene::SceneDescription &description;
  const std::vector<std::string> &files; // all; the first is the scene's
  const SourceManager &sources;          // texts of shaders
  const CommonOptions &options;
  const runtime::RenderOptions &render;
  TargetName target;
  bool raisesExceptions;
  double noise; // of an adaptive rendering
};

/// With --fp=fast also the target, the traversal and how traces are compiled: other arithmetic
/// gives the same bits on all of them. Not the number of samples,
/// and the limit of the error only if it decides which pixels have them. Throws what readFile does.
runtime::Identity identityOf(const RenderInput &input);

} // namespace rtsl::tool
