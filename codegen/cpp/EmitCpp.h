//===- EmitCpp.h - a checked module as C++ --------------------------------===//
//
// Prints RTSL as one file of C++17 on GLM and rtsl/shader.h. It is printed from the typed tree,
// which still has the author's loops, expressions and names; docs/cpp-output.md explains why, and
// how the output keeps the bits of the compiler's own machine code. The description of the
// program (types of rays, places of attributes, what of a hit is read) comes from linking.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/Names.h"
#include "frontend/diagnostics/Diagnostics.h"
#include "sema/typed/TypedAst.h"

#include <optional>
#include <string>

namespace rtsl {
struct ModuleFacts;
}

namespace rtsl::cpp {

struct HitErrorFunctions;

struct Options {
  std::string name = "shaders";      // of the namespace, and of the exported `<name>_shaders`
  std::uint32_t colorComponents = 3; // 1 to RTSL_MAX_COLOR
  bool lineDirectives = false;       // `#line` for code of the author's files
  bool prints = false;               // `print` prints; otherwise it is left out
  bool exceptions = false;           // samples end at what docs/language.md calls an exception
  std::uint32_t undefined = 0;       // RTSL_FEATURE_UNDEFINED_*, for tests
  std::uint32_t sampler = 0;         // RTSL_FEATURE_SAMPLER_*, or 0
  bool checkIndices = true;
  // the reason why traces are calls: what cannot be printed as states; empty: there is none
  std::string whyCalls;
  bool fast = false; // RTSL_FAST: the C++ compiler may change last digits (docs/fast.md)
  const HitErrorFunctions *hitErrors = nullptr; // HitErrors.h; null: there are none
};

struct StateProgram;

/// The text, formatted; nothing if something cannot be printed, which is reported. `facts`: what
/// linking has found out of the module (codegen/link/LinkModule.h). `states`: methods that trace,
/// split, to be printed as their states (States.h); null: traces are calls.
std::optional<std::string> print(const typed::Module &module, const ModuleFacts &facts,
                                 const Options &options, Diagnostics &diagnostics,
                                 const StateProgram *states = nullptr);

} // namespace rtsl::cpp
