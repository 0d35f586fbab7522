//===- Suggest.h - what the author may have meant -------------------------===//
#pragma once

#include <string>
#include <vector>

namespace rtsl {

/// The candidate that is most like `name`, or empty: at most a third of its letters may be wrong,
/// missing, doubled or swapped. Case alone never counts as more than one mistake.
std::string closestName(const std::string &name, const std::vector<std::string> &candidates);

/// How other shading languages spell something, and how RTSL does.
struct ForeignSpelling {
  std::string replacement; // empty: there is no word for word replacement, only the advice
  std::string advice;
};
/// Null if `name` is not known from HLSL, CUDA, OptiX, GLSL's rasteriser or the RenderMan language.
const ForeignSpelling *foreignSpelling(const std::string &name);

} // namespace rtsl
