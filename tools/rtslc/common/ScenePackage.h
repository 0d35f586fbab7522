//===- ScenePackage.h - compiles a scene into a package -------------------===//
#pragma once

#include "codegen/driver/SceneProgram.h"

#include <memory>
#include <optional>

namespace rtsl::tool {

/// Compiles the module for the scene that `build` creates, stores the code in `package`, and
/// returns the scene. Constructors and bounds run here; the package has only their results. Nothing
/// if there were errors.
inline std::optional<runtime::Scene>
compileScenePackage(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, Diagnostics &diagnostics,
                    const BuildScene &build, runtime::Package &package) {
  std::optional<runtime::Scene> scene;
  if (!compilePackage(module, request, options, diagnostics, storeScene(build, scene), package))
    return std::nullopt;
  return scene;
}

} // namespace rtsl::tool
