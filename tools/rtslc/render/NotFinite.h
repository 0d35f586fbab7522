//===- NotFinite.h - samples that are infinite or not a number -------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "runtime/render/Renderer.h"

#include <optional>
#include <vector>

namespace rtsl::tool {

/// A sample that is not finite, and why.
struct SampleNotFinite {
  runtime::SampleId sample;
  std::vector<float> color;
  /// Where a shader made the number to which that goes back; nothing if that is not found.
  std::optional<Place> place;
};

/// Renders samples of a rendering that are not finite again, by a program that checks its numbers
/// (runtime/program/NumberCheck.h), and finds out where each stopped being finite:
/// RenderOptions::mostNotFinite of them, where lanes have named fewer too. The scene gets that
/// program.
std::vector<SampleNotFinite> explainNotFinite(const runtime::RenderStatistics &statistics,
                                              const typed::Module &module, LinkRequest request,
                                              CompileOptions compile, runtime::Scene &scene,
                                              runtime::RenderOptions render,
                                              Diagnostics &diagnostics);

} // namespace rtsl::tool
