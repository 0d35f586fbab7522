//===- Suggest.h - what the author may have meant -------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "support/ClosestName.h"

#include <string>
#include <vector>

namespace rtsl {

/// A spelling of another shading language, and the one of RTSL.
struct ForeignSpelling {
  std::string replacement; // empty: no direct replacement, only the advice
  std::string advice;
  /// Same meaning and same arguments: `check --fix` may apply it.
  bool sure = false;
  std::string append = {}; // at the end of the call's arguments
  std::string after = {};  // after the call
  bool isVariable = false; // the call becomes a variable
  /// The module of the library that `advice` is about: "std.noise".
  std::string module = {};
};
/// Null if `name` is not known from HLSL, CUDA, OptiX, GLSL's rasteriser or the RenderMan language.
const ForeignSpelling *foreignSpelling(const std::string &name);
/// Every such name, sorted.
std::vector<std::string> foreignNames();
/// Adds the fix and the advice to a message about `name`, which is called if `call` is valid.
/// `whyNot`, if not empty, is the reason why the replacement is not allowed there; it is added
/// instead. `hasModule`: the program imports the module that the advice is about.
void suggestSpelling(Diagnostic &diagnostic, const ForeignSpelling &foreign,
                     const std::string &whyNot, bool hasModule, SourceRange name,
                     SourceRange call = {});

} // namespace rtsl
