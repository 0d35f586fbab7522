//===- SceneProgram.h - a scene, and the program that renders it ----------===//
//
// For programs that use scenes: the compiler itself only uses runtime/program/Program.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "runtime/scene/Scene.h"

#include <functional>
#include <memory>
#include <optional>

namespace rtsl {

/// Makes a scene's objects for a program.
using BuildScene = std::function<runtime::Scene(std::shared_ptr<const runtime::Program>)>;

/// Compiles the module for the scene that `build` makes, and returns the scene with its program.
/// Nothing if there were errors.
inline std::optional<runtime::Scene>
compileScene(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
             Diagnostics &diagnostics, const BuildScene &build) {
  std::optional<runtime::Scene> scene;
  const auto program =
      compileProgram(module, request, options, diagnostics, [&](const auto &constructors) {
        scene = build(constructors);
        return scene->facts();
      });
  if (!program)
    return std::nullopt;
  scene->useProgram(program);
  return scene;
}

} // namespace rtsl
