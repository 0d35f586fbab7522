//===- RenderScene.cpp - one picture of rtslc render -----------------------===//
#include "Preview.h"
#include "RenderCommand.h"
#include "RenderIdentity.h"
#include "RenderSummary.h"
#include "runtime/image/Layers.h"
#include "runtime/program/PrintLog.h"
#include "runtime/render/MachineStack.h"
#include "support/Clock.h"
#include "support/ErrorMessages.h"
#include "tools/common/Interruption.h"
#include "tools/common/OutOfMemory.h"
#include "tools/common/Outcome.h"
#include "tools/common/Output.h"
#include "tools/common/Progress.h"
#include "tools/rtslc/common/MaterialCheck.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace rtsl::tool {

namespace {

/// What the command line changes in the scene: `--set`, and options that decide what is compiled.
std::vector<std::string> overridesOf(const RenderCommandOptions &options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.engine.empty())
    overrides.push_back("render.engine=" + options.engine);
  if (options.depth)
    overrides.push_back(fmt::format("render.depth={}", *options.depth));
  if (!options.camera.empty())
    overrides.push_back("camera=" + options.camera);
  if (options.frame)
    overrides.push_back(fmt::format("frame={}", *options.frame));
  return overrides;
}

runtime::RenderOptions renderOptions(const RenderCommandOptions &options,
                                     const scene::RenderSettings &settings) {
  runtime::RenderOptions render = scene::renderOptions(settings);
  if (options.size)
    options.size->apply(render);
  render.crop = options.crop;
  render.samplesPerPixel = options.samples.value_or(
      options.isOpenEnded() ? runtime::mostSamplesPerPixel : render.samplesPerPixel);
  render.seed = options.seed.value_or(render.seed);
  render.threads = options.threads;
  render.pixelsInTurns = options.pixelsInTurns;
  render.traversal = options.traversal;
  render.tree = options.tree;
  render.keepsUnfinished = true;
  render.isAdaptive = options.isAdaptive;
  if (options.exceptions)
    render.mostNotFinite = runtime::PrintLog::mostLines;
  return render;
}

/// The scene of the file, or one that shows a class of it. Nothing if there are errors.
std::optional<Preview> readInput(const RenderCommandOptions &options, Messages &messages) {
  if (holdsShaders(options.scene))
    return makePreview({options.scene, options.className, overridesOf(options)}, options.common,
                       messages);
  return Preview{
      readScene(options.scene, overridesOf(options), messages, "render", options.keptFiles),
      options.scene,
      {}};
}

/// A distance is one number, the same in all components.
runtime::Layer layerOf(const std::string &view, runtime::Image image) {
  if (view != "depth")
    return {view, {}, std::move(image)};
  runtime::Image distances = image;
  distances.channels = 1;
  distances.pixels.resize(std::size_t(image.width) * image.height);
  for (std::size_t i = 0; i < distances.pixels.size(); ++i)
    distances.pixels[i] = image.pixels[i * image.channels];
  return {view, {"Z"}, std::move(distances)};
}

/// One picture, from its files to the file that it is written to.
class ScenePicture {
public:
  ScenePicture(const RenderCommandOptions &options, Messages &messages,
               const std::atomic<bool> *stop, std::vector<std::string> &files)
      : options(options), messages(messages), stop(stop), files(files) {}

  bool make() {
    if (!read() || !compile() || !compileViews())
      return false;
    const std::uint64_t failedBefore = runtime::failedMachineStacks();
    const runtime::Image image = render("rendering");
    const std::vector<runtime::Layer> layers = renderViews();
    if (options.watches && !summary.unfinished.empty()) {
      runtime::takePrintLog();
      return false;
    }
    if (summary.statistics.samples == 0)
      throw Error(message::stoppedBeforeFirstSample());
    summary.printed = runtime::takePrintLog().texts(scene->program().prints);
    std::uint64_t stackBytes = 0;
    if (runtime::failedMachineStacks(&stackBytes) > failedBefore)
      throw Error(message::noMemoryForRays(stackBytes));
    write(image, layers);
    describe();
    return true;
  }

private:
  /// A view of --aov: a picture of its own, with the samples of the main one.
  struct View {
    View(const RenderCommandOptions &options, Messages &messages, const std::atomic<bool> *stop)
        : options(options),
          picture(std::make_unique<ScenePicture>(this->options, messages, stop, files)) {}

    const RenderCommandOptions options;
    std::vector<std::string> files;
    const std::unique_ptr<ScenePicture> picture;
  };

  /// Compiles the views before the picture is rendered, because their programs may have mistakes.
  bool compileViews() {
    for (const std::string &name : options.aovs) {
      RenderCommandOptions ofView = options;
      ofView.engine = name;
      ofView.aovs.clear();
      ofView.seconds.reset();
      ofView.noise = 0;
      ofView.isAdaptive = false;
      ofView.checkpoint = {};
      ofView.tev = {};
      ofView.isLayer = true;
      ofView.prints = false;
      if (options.keptTrees) {
        ofView.keptTrees = options.keptTrees->ofViews[name];
        if (!ofView.keptTrees)
          ofView.keptTrees = options.keptTrees->ofViews[name] = std::make_shared<KeptTrees>();
      }
      views.push_back(std::make_unique<View>(ofView, messages, stop));
      if (!views.back()->picture->read() || !views.back()->picture->compile())
        return false;
    }
    return true;
  }

  /// Renders the views; returns those that are complete.
  std::vector<runtime::Layer> renderViews() {
    std::vector<runtime::Layer> layers;
    std::string missing;
    for (const auto &view : views) {
      const std::string &name = view->options.engine;
      ScenePicture &picture = *view->picture;
      if (!isStopped()) {
        picture.samples = summary.render.samplesPerPixel;
        runtime::Image image = picture.render("rendering " + name);
        if (!picture.summary.statistics.isUnfinished) {
          layers.push_back(layerOf(name, std::move(image)));
          continue;
        }
      }
      missing += (missing.empty() ? "`" : ", `") + name + "`";
    }
    if (!missing.empty())
      summary.unfinished += summary.unfinished.empty()
                                ? fmt::format("stopped by {} before the picture had the layers {}",
                                              nameOfStop(), missing)
                                : fmt::format("; the picture has no layers {}", missing);
    return layers;
  }

  bool isStopped() const { return stop ? stop->load() : interruption() != nullptr; }

  /// Reads all files but meshes, images and buffers.
  bool read() {
    runtime::checkWritable(options.output, options.format);
    checkOutputFiles();
    if (!connectToViewer())
      return false;
    input = readInput(options, messages);
    if (!input)
      return false;
    warnOfFrame();
    input->description.keptFiles = options.keptFiles;
    input->description.placesMeshes = !options.keptTrees;
    files = withFiles(input->description, {input->file});
    runtime::checkOptions(renderOptions(options, input->description.render));
    target = makeRenderTarget(options.target, options.hasGpuArchitecture, options.gpu,
                              options.keptTrees.get());
    start = Clock::now();
    std::vector<std::string> filesRead;
    module =
        loadShaders(input->description, options.common, messages, &filesRead, input->takenNames);
    if (!module)
      return false;
    filesRead.front() = input->file;
    files = withFiles(input->description, filesRead);
    checkOutputFiles(files);
    return true;
  }

  /// A frame was given for a scene without any; of --frames, the first one says so.
  void warnOfFrame() const {
    if (options.frame && isFirstFrame() && !input->description.isAnimated)
      messages.report(Warning{message::framesAlike(), {}});
  }

  /// Called before anything takes long, so that an error is reported at once.
  bool connectToViewer() {
    if (options.tev.host.empty())
      return true;
    viewer.emplace(options.tev, options.output == "-" ? options.scene : options.output);
    if (viewer->failure().empty())
      return true;
    messages.diagnostics
        .report(Code::viewerUnreachable, {}, options.tev.shownHost(), options.tev.port,
                viewer->failure())
        .note("start tev there first; it listens on port 14158 unless told otherwise");
    return false;
  }

  void checkOutputFiles(const std::vector<std::string> &filesRead = {}) const {
    const DependencyOptions &dependencies = options.common.dependencies;
    checkOutputs(options.output, dependencies, {options.scene}, filesRead);
    checkCheckpointFile(options.checkpoint, options.output, dependencies, {options.scene},
                        filesRead);
  }

  /// Compiles the shaders for the scene, and makes the scene.
  bool compile() {
    const scene::SceneDescription &description = input->description;
    compileOptions = options.common.compile;
    compileOptions.threads = options.threads;
    request = linkRequest(description);
    request.features |= features(options.prints, options.exceptions);
    keep(options.common.keep, request, compileOptions);
    compileOptions.countsSteps = options.countsSteps;
    if (options.common.keep.has(Item::Events))
      request.features |= RTSL_FEATURE_PRINT; // the lines are thrown away
    scene = target->compile(*module, request, compileOptions, messages.diagnostics,
                            [&](const auto &program) {
                              const Clock::time_point begin = Clock::now();
                              const auto shown = showPhase("reading");
                              runtime::Scene made = scene::buildScene(description, program);
                              summary.times.scene = secondsSince(begin);
                              return made;
                            });
    if (!scene)
      return false;
    summary.times.compile = secondsSince(start) - summary.times.scene;
    for (const Warning &warning : scene->warnings())
      messages.report(warning);
    return true;
  }

  /// Null: nothing is shown.
  std::unique_ptr<PhaseProgress> showPhase(const char *what) const {
    return options.quiet ? nullptr : std::make_unique<PhaseProgress>(what);
  }

  runtime::Image render(const std::string &what) {
    runtime::RenderOptions &render = summary.render =
        renderOptions(options, input->description.render);
    render.samplesPerPixel = samples.value_or(render.samplesPerPixel);
    render.cancel = stop                             ? stop
                    : options.common.jsonDiagnostics ? catchInterruptions()
                                                     : catchInterruptionsOfSamples();
    render.prints = request.features & RTSL_FEATURE_PRINT;
    if (options.countsSteps) {
      summary.stateNames = target->stateNames(*scene);
      render.countedStates = summary.stateNames.size();
    }
    Progress progress(what);
    runtime::RenderOptions shown = render; // whose `progress` must not outlive this
    if (!options.quiet && !options.isOpenEnded())
      shown.progress = [&](double share) { progress.update(share); };
    const Clock::time_point begin = Clock::now();
    auto building = showPhase("building trees");
    const std::unique_ptr<runtime::Backend> backend =
        target->prepare(*scene, shown, options.keptTrees.get());
    building.reset();
    const double seconds = secondsSince(begin);
    runtime::Image image = options.isInPasses(render.samplesPerPixel)
                               ? renderInPasses(*backend, progress)
                               : backend->render(&summary.statistics);
    if (summary.statistics.isUnfinished && summary.unfinished.empty())
      summary.unfinished = unfinishedText(summary.statistics, render);
    summary.statistics.buildSeconds = seconds;
    if (options.keptTrees)
      target->keepTrees(*backend, *options.keptTrees);
    summary.gpus = target->gpus();
    return image;
  }

  /// The picture so far is written at intervals.
  runtime::Image renderInPasses(runtime::Backend &backend, Progress &progress) {
    runtime::PassOptions passes;
    passes.seconds = options.seconds.value_or(passes.seconds);
    passes.error = options.noise;
    const double secondsBetweenFiles = passes.secondsBetweenPictures;
    if (viewer)
      passes.secondsBetweenPictures = 1;
    Clock::time_point written = Clock::now();
    if (options.output != "-" || viewer)
      passes.picture = [&](const runtime::Image &image) {
        if (viewer)
          viewer->show(image);
        if (options.output == "-" || secondsSince(written) < secondsBetweenFiles)
          return;
        writePictureSoFar(options.output, image, options.format, options.tones);
        written = Clock::now();
      };
    runtime::PartialRendering rendering;
    if (!options.checkpoint.file.empty())
      rendering = resume(passes);
    const auto show = [&](const runtime::PassState &state) {
      if (!options.quiet && options.isOpenEnded())
        progress.update(fmt::format(
            "{} spp, {:.0f} s{}", state.samplesPerPixel, state.seconds,
            std::isfinite(state.error) ? fmt::format(", noise {:.4f}", state.error) : ""));
    };
    runtime::Image image = backend.renderInPasses(passes, show, rendering, &summary.statistics);
    const runtime::PassState &state = rendering.state;
    const bool isShort =
        !options.isOpenEnded() && state.samplesPerPixel < summary.render.samplesPerPixel;
    if (summary.statistics.isUnfinished || isShort)
      summary.unfinished =
          unfinishedPassesText(state, summary.statistics, summary.render, options.isOpenEnded());
    summary.statistics.isUnfinished |= isShort;
    summary.render.samplesPerPixel = state.samplesPerPixel;
    summary.error = state.error;
    return image;
  }

  /// The rendering of the checkpoint, if there is one already; from now on it is kept there.
  runtime::PartialRendering resume(runtime::PassOptions &passes) {
    const RenderInput identified{input->description, files,          messages.sources,
                                 options.common,     summary.render, options.target,
                                 options.exceptions, options.noise};
    checkpoint.emplace(options.checkpoint, identityOf(identified));
    passes.secondsBetweenCheckpoints = checkpoint->seconds();
    passes.checkpoint = [this](const runtime::PartialRendering &rendering, bool isLast) {
      checkpoint->write(rendering, isLast);
    };
    runtime::PartialRendering rendering = checkpoint->read(
        windowOf(summary.render).pixels(), scene->program().colorComponents, options.isAdaptive);
    const runtime::SampleCounts counts = countSamples(rendering.sums);
    if (counts.most > summary.render.samplesPerPixel)
      throw Error(message::checkpointTooFar(options.checkpoint.file, counts.most,
                                            summary.render.samplesPerPixel),
                  Place{options.checkpoint.file})
          .note(fmt::format("give `--spp={}` or more, or another file", counts.most));
    summary.resumedAt = counts.least;
    return rendering;
  }

  void write(const runtime::Image &image, const std::vector<runtime::Layer> &layers) {
    if (viewer)
      viewer->show(image);
    const Clock::time_point begin = Clock::now();
    if (layers.empty())
      writePicture(options.output, image, options.format, options.tones);
    else
      runtime::writeLayers(options.output, image, layers);
    writeDependencies(options.common.dependencies, options.output, {options.scene}, files);
    summary.times.image = secondsSince(begin);
    if (options.prints && !options.json) // there the lines are part of the document
      printOut(summary.printed.empty() ? ""
                                       : fmt::format("{}\n", fmt::join(summary.printed, "\n")));
  }

  /// Called after the picture is in its file, because a slow viewer takes its time.
  void finishShowing() {
    if (!viewer)
      return;
    const auto shown = showPhase("sending the picture to the viewer");
    viewer->finish();
    if (!viewer->failure().empty())
      messages.diagnostics.report(Code::viewerLost, {}, options.tev.shownHost(), options.tev.port,
                                  viewer->failure());
  }

  bool isFirstFrame() const { return !options.frames || options.frame == options.frames->first; }

  /// Says what methods of materials do wrong, as `rtslc check` does, if the picture showed that, or
  /// may be wrong without showing it. The library's methods need no trial.
  void warnOfMaterials() {
    if (!hasSurfaceMethods(request, scene->program()))
      return;
    if (summary.statistics.samplesNotFinite ||
        (isFirstFrame() && drawsByAuthors(request, *module, messages.sources)))
      for (const Warning &warning :
           tryMaterials(*scene, *module, messages.sources, request, compileOptions))
        messages.report(warning);
  }

  /// Says what the rendering has met.
  void describe() {
    if (!summary.statistics.notFinite.empty())
      try {
        summary.notFinite = explainNotFinite(summary.statistics, *module, request, compileOptions,
                                             *scene, summary.render, messages.diagnostics);
      } catch (const std::exception &error) { // the picture is written, and the samples are counted
        if (!isOutOfMemory(error))
          throw;
        for (const runtime::SampleId &sample : summary.statistics.notFinite)
          summary.notFinite.push_back({sample, {}, std::nullopt});
      }
    warn(summary, messages);
    warnOfMaterials();
    if (checkpoint)
      checkpoint->report(messages);
    finishShowing();
    printSummary(options, summary);
  }

  const RenderCommandOptions &options;
  Messages &messages;
  const std::atomic<bool> *const stop;
  std::vector<std::string> &files; // that the picture depends on

  std::optional<Preview> input;
  std::unique_ptr<RenderTarget> target; // outlives the scene's backend
  std::unique_ptr<typed::Module> module;
  CompileOptions compileOptions;
  LinkRequest request;
  std::optional<runtime::Scene> scene;
  std::optional<CheckpointFile> checkpoint;
  std::optional<TevViewer> viewer;
  std::vector<std::unique_ptr<View>> views;
  std::optional<std::uint32_t> samples; // of a view: per pixel
  Clock::time_point start;              // of compiling
  PictureSummary summary;
};

} // namespace

bool renderScene(const RenderCommandOptions &options, Messages &messages,
                 const std::atomic<bool> *stop, std::vector<std::string> &files) {
  return ScenePicture(options, messages, stop, files).make();
}

} // namespace rtsl::tool
