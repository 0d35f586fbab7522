//===- RenderCommand.cpp - rtslc render -----------------------------------===//
#include "RenderCommand.h"

#include "Preview.h"
#include "RenderOnChange.h"
#include "runtime/image/Layers.h"
#include "scenefile/LibraryEngines.h"
#include "scenefile/files/KeptFiles.h"
#include "support/AtomicFile.h"
#include "tools/common/Interruption.h"
#include "tools/common/OptionValues.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

namespace rtsl::tool {

namespace {

/// Renders once, and reports everything.
ExitStatus render(const RenderCommandOptions &options, const std::atomic<bool> *stop,
                  Rendering &rendering) {
  Messages messages(options.common);
  try {
    rendering.isDone = renderScene(options, messages, stop, rendering.files);
  } catch (Error &error) {
    if (error.code == ErrorCode::NoDevice)
      error.note("`--target=host-megakernel` renders the same picture on the CPU");
    messages.report(error);
  }
  // After an error not all files are known, but those that were read until then.
  std::error_code unknown;
  rendering.files.push_back(options.scene);
  for (FileId file = 1; file <= messages.sources.count(); ++file)
    if (std::filesystem::exists(messages.sources.name(file), unknown))
      rendering.files.emplace_back(messages.sources.name(file));
  std::sort(rendering.files.begin(), rendering.files.end());
  rendering.files.erase(std::unique(rendering.files.begin(), rendering.files.end()),
                        rendering.files.end());
  return messages.status();
}

/// --watch: an error that no change of a file can correct ends it at once.
int watch(const RenderCommandOptions &options) {
  Messages messages(options.common);
  try {
    readFile(options.scene);
    runtime::checkWritable(options.output, options.format);
    checkOutputs(options.output, options.common.dependencies, {options.scene});
    renderOnChange(
        [&](const std::atomic<bool> &stop) {
          Rendering rendering;
          render(options, &stop, rendering);
          return rendering;
        },
        options.output, options.quiet);
  } catch (const Error &error) {
    messages.report(error);
  }
  return statusAfterInterruption(messages.status());
}

/// --frames: one picture after the other, until one fails.
int renderFrames(const RenderCommandOptions &options) {
  for (std::uint32_t frame = options.frames->first; frame <= options.frames->last; ++frame) {
    RenderCommandOptions ofFrame = options;
    ofFrame.frame = frame;
    ofFrame.output = nameOfFrame(options.output, frame);
    if (!options.checkpoint.file.empty())
      ofFrame.checkpoint.file = nameOfFrame(options.checkpoint.file, frame);
    Rendering rendering;
    const ExitStatus status = render(ofFrame, nullptr, rendering);
    if (status != Fine || interruption())
      return statusAfterInterruption(status);
  }
  return Fine;
}

int render(RenderCommandOptions options) {
  options.common.compile.codeCache = keptCode();
  if (options.watches || options.frames || !options.aovs.empty())
    options.keptFiles = std::make_shared<scene::KeptFiles>();
  if (options.watches || options.frames) {
    options.keptTrees = std::make_shared<KeptTrees>();
    return options.watches ? watch(options) : renderFrames(options);
  }
  Rendering rendering;
  const ExitStatus status = render(options, nullptr, rendering);
  return statusAfterInterruption(status);
}

/// Compiling takes a third less time than with -O2, and the picture is the same.
constexpr unsigned optimizationOfWatch = 1;

/// Rejects options that make no sense for several pictures.
void rejectWithWatch(const RenderCommandOptions &options) {
  if (options.scene == "-")
    throw CLI::ValidationError("--watch", "standard input is no file that changes; give one");
  if (options.output == "-")
    throw CLI::ValidationError("--watch", "standard output takes one picture; give a file to `-o`");
  if (options.json || options.common.jsonDiagnostics)
    throw CLI::ValidationError("--watch",
                               "a JSON document describes one picture, not several; leave it out");
}

/// Rejects what cannot be done for several frames.
void rejectWithFrames(const RenderCommandOptions &options) {
  checkFrameName("--output", options.output);
  if (!options.checkpoint.file.empty())
    checkFrameName("--checkpoint", options.checkpoint.file);
  if (!options.checkpoint.resumed.empty())
    throw CLI::ValidationError("--resume", "frames that were not begun have no checkpoint; "
                                           "`--checkpoint` resumes those that have one");
  if (options.frame)
    throw CLI::ValidationError("--frames", "`--frame` is one frame; give one of the two");
  if (options.watches)
    throw CLI::ValidationError("--frames", "`--watch` renders one picture again and again; give a "
                                           "frame to `--frame` instead");
  if (options.json || options.common.jsonDiagnostics)
    throw CLI::ValidationError("--frames",
                               "a JSON document describes one picture, not several; leave it out");
}

/// Rejects what cannot be done with --time, --noise and --checkpoint.
void rejectInPasses(const RenderCommandOptions &options) {
  if (options.watches && options.isOpenEnded())
    throw CLI::ValidationError(options.seconds ? "--time" : "--noise",
                               "`--watch` renders each picture with the same number of samples; "
                               "give one to `--spp` instead");
  if (options.checkpoint.file.empty())
    return;
  if (options.checkpoint.file == "-")
    throw CLI::ValidationError("--checkpoint", "standard output cannot be read again; give a file");
  if (options.watches)
    throw CLI::ValidationError("--checkpoint",
                               "`--watch` renders pictures of a changing scene, and "
                               "a checkpoint is of one picture; leave one out");
  if (options.prints)
    throw CLI::ValidationError("--checkpoint", "a checkpoint does not keep what shaders have "
                                               "printed; leave out `--print`");
}

/// Adds --aov.
void addAovOption(CLI::App &command, std::vector<std::string> &aovs) {
  const std::vector<std::string> &views = scene::libraryViews();
  command
      .add_option_function<std::vector<std::string>>(
          "--aov",
          [&aovs, views](const std::vector<std::string> &names) {
            for (const std::string &given : names) {
              const std::string name = given == "normal" ? "normals" : given; // others say so
              if (std::find(views.begin(), views.end(), name) == views.end())
                refuseWord("--aov", name, views);
              if (std::find(aovs.begin(), aovs.end(), name) == aovs.end())
                aovs.push_back(name);
            }
          },
          "views that are rendered too, as layers of an EXR picture; several between commas")
      ->type_name(joined(views))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// Rejects options that a GPU cannot support.
void rejectWithoutGpuSupport(const RenderCommandOptions &options) {
  if (options.common.compile.floatingPoint == FloatingPoint::Double)
    throw CLI::ValidationError("--fp",
                               "shaders on a GPU compute in single precision; give strict or fast");
}

/// When all options are read. Throws CLI::ValidationError for those that exclude each other.
void completeRenderOptions(const CLI::App &command, RenderCommandOptions &options) {
  for (const auto &[name, isGiven] :
       {std::make_pair("--json", options.json), std::make_pair("--print", options.prints)})
    if (isGiven && options.output == "-")
      throw CLI::ValidationError(name, "standard output is the picture; give a file to `-o`");
  if (!options.className.empty() && !holdsShaders(options.scene))
    throw CLI::ValidationError("--class", fmt::format("`{}` is a scene, which names its classes; "
                                                      "give a file of shaders (.rtsl)",
                                                      options.scene));
  if (command.count("--noise") && (options.noise == 0 || std::isinf(options.noise)))
    throw CLI::ValidationError("--noise", "no picture is without error; give a number like 0.01");
  if (options.isAdaptive && !command.count("--noise"))
    throw CLI::ValidationError("--adaptive", "the error decides which pixels take more samples; "
                                             "give the wanted one to `--noise`");
  completeCheckpointOptions(options.checkpoint);
  if (command.count("--checkpoint-every") && options.checkpoint.file.empty())
    throw CLI::ValidationError("--checkpoint-every", "there is no `--checkpoint`");
  rejectInPasses(options);
  if (options.frames)
    rejectWithFrames(options);
  if (options.watches) {
    rejectWithWatch(options);
    if (!command.count("-O"))
      options.common.compile.optimization = optimizationOfWatch;
  }
  checkPictureName(options.output, options.format);
  if (!options.aovs.empty() && !runtime::isExr(options.output, options.format))
    throw CLI::ValidationError("--aov", "only EXR files have layers; give a name that ends in "
                                        ".exr, or `--format=exr`");
  checkToneOptions(command, options.output, options.format);
  if (options.target == TargetName::Gpu)
    rejectWithoutGpuSupport(options);
  else
    rejectGpuOptions(command);
  if (options.countsSteps && options.target == TargetName::Host)
    throw CLI::ValidationError("--lane-use", "there are no lanes; add `--target=gpu`, or "
                                             "`--target=host-megakernel` for the steps alone");
  if (options.target != TargetName::Host)
    options.common.compile.target = Target::HostMegakernel;
  options.hasGpuArchitecture = command.count("--gpu-arch") != 0;
}

} // namespace

void addRenderCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<RenderCommandOptions>();
  CLI::App *command = app.add_subcommand(renderSummary.command, renderSummary.text);
  command
      ->add_option(
          "FILE", options->scene,
          "a scene (.json); a model (.gltf, .glb, .obj) or RTSL (.rtsl), of which one class "
          "is shown, in a standard scene; - is a scene on standard input")
      ->required();
  command
      ->add_option("--class", options->className,
                   "the class of an RTSL file to show; default: the last one that can be shown")
      ->type_name("NAME");
  addPictureOption(*command, options->output, options->format);
  addToneOptions(*command, options->tones);
  addWhole(*command, "--spp", options->samples, 1, runtime::mostSamplesPerPixel,
           "samples per pixel");
  command
      ->add_option_function<std::string>(
          "--time",
          [options](const std::string &text) { options->seconds = parseDuration("--time", text); },
          "render samples for this time (30s, 2m, 500ms); at most --spp")
      ->type_name("TIME");
  addNotNegative(*command, "--noise", options->noise,
                 "render samples until the estimated relative error of the picture is at most X, "
                 "like 0.01; at most --spp");
  command->add_flag("--adaptive", options->isAdaptive,
                    "with --noise: more samples for pixels that need them, and fewer for others");
  addCheckpointOptions(*command, options->checkpoint);
  addTevOption(*command, options->tev);
  addSizeOption(*command, options->size);
  addCropOption(*command, options->crop);
  command->add_option("--camera", options->camera, "one of the scene's `cameras`")
      ->type_name("NAME");
  addFrameOptions(*command, options->frame, options->frames);
  addWhole(*command, "--threads", options->threads, 1, runtime::mostThreads,
           "threads; default: all cores");
  addPixelsInTurnsOption(*command, options->pixelsInTurns);
  addWhole(*command, "--depth", options->depth, 0, runtime::maxRayDepth,
           "limit of nested `trace` calls; 0: camera rays only");
  command
      ->add_option(
          "--engine", options->engine,
          "classic, path, volume, programs; or a view: normals, depth, id, albedo, occlusion")
      ->type_name("NAME");
  addAovOption(*command, options->aovs);
  addWhole(*command, "--seed", options->seed, 0, 0xffffffff, "seed of the random numbers");
  addSetOption(*command, options->overrides);
  addTraversalOption(*command, options->traversal);
  addTreeOption(*command, options->tree);
  addTargetOption(*command, options->target);
  addGpusOption(*command, options->gpu);
  addMaxRegistersOption(*command, options->gpu);
  command->add_flag("--lane-use", options->countsSteps,
                    "count the steps of warps, and the lanes that take part in them: of a GPU, and "
                    "of --target=host-megakernel, whose warps have one lane");
  command->add_flag("--print", options->prints,
                    "write the output of `print` to standard output, in the order of pixels");
  command->add_flag("--exceptions", options->exceptions,
                    "end samples that send an invalid ray, exceed the depth limit, or use an index "
                    "out of range, and count them; list all samples that are not finite");
  command->add_flag("--json", options->json, "write times and counts to standard output as JSON");
  command->add_flag("--watch", options->watches,
                    "render again whenever a file of the scene is saved, until Ctrl-C");
  command->add_flag("-q,--quiet", options->quiet, "no progress and no summary");
  addProgramOptions(*command, options->common);
  command->footer("examples:\n  rtslc render examples/glass/scene.json -o glass.png --spp 64 "
                  "--size 1920x1080\n"
                  "  rtslc render examples/cornell/room.json -o normals.png --engine normals\n"
                  "  rtslc render examples/gltf/still-life.gltf -o picture.png --set "
                  "camera.name=Plan\n"
                  "  rtslc render Clay.rtsl -o clay.png --set Clay.polish=0.2");
  command->callback([options, command, &action] {
    completeRenderOptions(*command, *options);
    action = [options] { return render(*options); };
  });
}

} // namespace rtsl::tool
