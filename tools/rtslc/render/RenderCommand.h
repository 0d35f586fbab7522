//===- RenderCommand.h - options and parts of rtslc render -----------------===//
#pragma once

#include "CheckpointFile.h"
#include "FrameSequence.h"
#include "RenderTarget.h"
#include "TevViewer.h"
#include "runtime/render/RenderOptions.h"
#include "scenefile/SceneFile.h"
#include "tools/common/PictureOptions.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

struct RenderCommandOptions {
  CommonOptions common;
  std::string scene;     // or shaders, of which a class is shown
  std::string className; // of that class; empty: the last
  std::string output;
  std::vector<std::string> overrides;
  std::string engine;            // empty: the scene's
  std::vector<std::string> aovs; // views that become layers of the picture
  std::optional<std::uint32_t> samples, depth, seed;
  std::uint32_t threads = 0;
  std::uint32_t pixelsInTurns = 0; // 0: not given
  std::optional<PictureSize> size;
  std::optional<runtime::Window> crop;
  std::string camera;           // of the scene's `cameras`; empty: the scene's `camera`
  std::optional<double> frame;  // empty: the scene's
  std::optional<Frames> frames; // a picture for each
  runtime::Traversal traversal = runtime::Traversal::Embree;
  std::optional<runtime::TreeKind> tree;
  bool json = false;
  bool quiet = false;
  bool watches = false;          // for changes of files
  std::optional<double> seconds; // --time
  double noise = 0;              // --noise; 0: not given
  bool isAdaptive = false;
  CheckpointOptions checkpoint;
  TevOptions tev;
  bool isOpenEnded() const { return seconds || noise > 0; }
  bool isLayer = false; // a view of --aov, which is no picture of its own
  /// Whether there are pictures so far. They cost the sums of all pixels; one sample needs none.
  /// Several GPUs copy these sums in each pass. --watch never shows an unfinished picture, and
  /// --lane-use counts the steps of one pass.
  bool isInPasses(std::uint32_t samplesPerPixel) const {
    const bool isUsual =
        samplesPerPixel > 1 && gpu.count == 1 && !watches && !isLayer && !countsSteps;
    return isUsual || isOpenEnded() || !checkpoint.file.empty() || (!tev.host.empty() && !watches);
  }
  bool prints = false, exceptions = false;
  runtime::PictureFormat format = runtime::PictureFormat::ByName;
  runtime::ToneMapping tones;
  TargetName target = TargetName::Host;
  bool hasGpuArchitecture = false; // --gpu-arch was given
  GpuOptions gpu;
  bool countsSteps = false;                    // --lane-use
  std::shared_ptr<KeptTrees> keptTrees;        // null: there is one picture
  std::shared_ptr<scene::KeptFiles> keptFiles; // null: there is one picture, of one view
};

/// Renders unless there are errors, and gives whether a picture was written. `files` gets those
/// that it depends on. `stop` stops the rendering; null: a signal does. The unfinished picture is
/// written unless `--watch` was given.
bool renderScene(const RenderCommandOptions &options, Messages &messages,
                 const std::atomic<bool> *stop, std::vector<std::string> &files);

} // namespace rtsl::tool
