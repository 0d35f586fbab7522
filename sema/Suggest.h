//===- Suggest.h - what the author may have meant -------------------------===//
#pragma once

#include "frontend/ClosestName.h"

#include <string>

namespace rtsl {

/// How other shading languages spell something, and how RTSL does.
struct ForeignSpelling {
  std::string replacement; // empty: there is no word for word replacement, only the advice
  std::string advice;
};
/// Null if `name` is not known from HLSL, CUDA, OptiX, GLSL's rasteriser or the RenderMan language.
const ForeignSpelling *foreignSpelling(const std::string &name);

} // namespace rtsl
