//===- RenderTarget.h - the targets of `rtslc render` ---------------------===//
//
// A target compiles a scene's program and creates the backend of the runtime that renders it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/driver/SceneProgram.h"
#include "runtime/accel/DeviceTrees.h"
#include "runtime/gpu/Gpus.h"
#include "runtime/render/Backend.h"
#include "tools/common/GpuOptions.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

/// The trees of a picture, for the next one of the same command.
struct KeptTrees {
  std::shared_ptr<runtime::KeptTrees> ofHost; // null: there are none
  std::shared_ptr<runtime::Gpus> gpus;        // on which `ofDevices` are, and then outlives them
  runtime::KeptDeviceTrees ofDevices;
  std::map<std::string, std::shared_ptr<KeptTrees>> ofViews; // by name
};

class RenderTarget {
public:
  virtual ~RenderTarget() = default;

  /// Compiles the module for the scene that `build` creates, and returns the scene. Nothing if
  /// there were errors.
  virtual std::optional<runtime::Scene>
  compile(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
          Diagnostics &diagnostics, const BuildScene &build) = 0;

  /// The backend for the scene that compile() returned. The target must outlive it, and the scene
  /// must not change during its lifetime. `kept`: trees that may follow to this scene, and are
  /// taken; null: there are no other pictures.
  virtual std::unique_ptr<runtime::Backend>
  prepare(const runtime::Scene &scene, const runtime::RenderOptions &options, KeptTrees *kept) = 0;
  /// Gives the trees of the last backend, which has rendered its picture.
  virtual void keepTrees(runtime::Backend &backend, KeptTrees &kept) = 0;

  /// Program::stateNames of what compile() has compiled.
  virtual std::vector<std::string> stateNames(const runtime::Scene &scene) const {
    return scene.program().stateNames;
  }

  /// What ran on each GPU, while the last backend exists. Empty for targets without a GPU.
  virtual std::vector<runtime::GpuStatistics> gpus() const { return {}; }
};

enum class TargetName : std::uint8_t { Host, HostMegakernel, Gpu };

/// The trees that were built, and what ran on the GPU, for --json.
nlohmann::ordered_json toJson(const runtime::TreeFigures &tree);
nlohmann::ordered_json toJson(const runtime::GpuStatistics &gpu);

/// Adds --target.
void addTargetOption(CLI::App &command, TargetName &target);
/// Adds --pixels-in-turns.
void addPixelsInTurnsOption(CLI::App &command, std::uint32_t &pixels);
/// Adds --traversal.
void addTraversalOption(CLI::App &command, runtime::Traversal &traversal);

/// `hasArchitecture`: CompileOptions::gpu was set by the user; otherwise code for a GPU is compiled
/// for the installed one. `kept` as for prepare(). Throws NoDevice if the target is a GPU and there
/// is none.
std::unique_ptr<RenderTarget> makeRenderTarget(TargetName name, bool hasArchitecture,
                                               const GpuOptions &gpu, KeptTrees *kept = nullptr);

} // namespace rtsl::tool
