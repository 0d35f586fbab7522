//===- MaterialCheck.h - checks BSDFs and emission of a scene's materials -===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "codegen/link/LinkRequest.h"
#include "runtime/scene/Scene.h"
#include "support/Error.h"

#include <vector>

namespace rtsl::tool {

/// Whether engines of the scene run `sampleBSDF`, `BSDF` or `emission` of some material.
bool hasSurfaceMethods(const LinkRequest &request, const runtime::Program &program);

/// Whether a class of the scene has a `sampleBSDF` that is not the library's. The samples of one
/// that draws directions of another length than 1 are finite.
bool drawsByAuthors(const LinkRequest &request, const typed::Module &module,
                    const SourceManager &sources);

/// Draws directions of each material on the scene's surfaces, and evaluates them and the light that
/// it emits: values below 0, values that are no numbers, and directions with a value but a density
/// of 0 are warnings, one for each method and class, at its first object. The scene gets a program
/// of its own for this.
std::vector<Warning> tryMaterials(runtime::Scene &scene, const typed::Module &module,
                                  const SourceManager &sources, LinkRequest request,
                                  CompileOptions compile);

} // namespace rtsl::tool
