//===- Suggest.h - what the author may have meant -------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "support/ClosestName.h"

#include <string>
#include <vector>

namespace rtsl {

/// How other shading languages spell something, and how RTSL does.
struct ForeignSpelling {
  std::string replacement; // empty: there is no word for word replacement, only the advice
  std::string advice;
  /// It means the same, with the same arguments: `check --fix` may write it.
  bool sure = false;
  std::string append = {}; // at the end of the call's arguments
  std::string behind = {}; // behind the call
  bool isVariable = false; // a call of it becomes a name
};
/// Null if `name` is not known from HLSL, CUDA, OptiX, GLSL's rasteriser or the RenderMan language.
const ForeignSpelling *foreignSpelling(const std::string &name);
/// Every such name, sorted.
std::vector<std::string> foreignNames();
/// Adds the fix and the advice to a message about `name`, which calls something if `call` is valid.
/// `whyNot`, if there is any, says why the replacement cannot stand there, and takes its place.
void suggestSpelling(Diagnostic &diagnostic, const ForeignSpelling &foreign,
                     const std::string &whyNot, SourceRange name, SourceRange call = {});

} // namespace rtsl
