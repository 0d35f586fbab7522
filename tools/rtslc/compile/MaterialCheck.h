//===- MaterialCheck.h - whether materials scatter light that can be -------===//
#pragma once

#include "codegen/link/LinkRequest.h"
#include "runtime/scene/Scene.h"
#include "support/Error.h"

#include <vector>

namespace rtsl::tool {

/// Whether engines of the scene run `sampleBSDF` or `BSDF` of some material.
bool scattersByMethods(const LinkRequest &request, const runtime::Program &program);

/// Draws directions of each material on the scene's surfaces, and evaluates them: values below 0,
/// values that are no numbers, and directions with a value but a density of 0 are warnings, one for
/// each method and class, at its first object. The scene's program has SamplingSlots.def
/// (LinkRequest::isSampled).
std::vector<Warning> checkMaterials(const runtime::Scene &scene, const LinkRequest &request);

} // namespace rtsl::tool
