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
#include <utility>

namespace rtsl {

/// Makes a scene's objects for a program.
using BuildScene = std::function<runtime::Scene(std::shared_ptr<const runtime::Program>)>;

/// Has `build` make the scene, which must outlive the result, and returns its facts.
inline MakeObjects storeScene(BuildScene build, std::optional<runtime::Scene> &scene) {
  return [build = std::move(build), &scene](std::shared_ptr<const runtime::Program> constructors) {
    scene = build(std::move(constructors));
    return scene->facts();
  };
}

/// Compiles the module for the scene that `build` makes, and returns the scene with its program.
/// Nothing if there were errors.
inline std::optional<runtime::Scene>
compileScene(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
             Diagnostics &diagnostics, const BuildScene &build) {
  std::optional<runtime::Scene> scene;
  const auto program =
      compileProgram(module, request, options, diagnostics, storeScene(build, scene));
  if (!program)
    return std::nullopt;
  scene->useProgram(program);
  return scene;
}

} // namespace rtsl
