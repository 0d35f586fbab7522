//===- RenderCommand.cpp - rtslc render -----------------------------------===//
#include "NotFinite.h"
#include "Preview.h"
#include "RenderOnChange.h"
#include "RenderTarget.h"
#include "runtime/program/PrintLog.h"
#include "runtime/render/MachineStack.h"
#include "runtime/render/Renderer.h"
#include "scenefile/SceneFile.h"
#include "support/AtomicFile.h"
#include "tools/common/Interruption.h"
#include "tools/common/OptionValues.h"
#include "tools/common/OutOfMemory.h"
#include "tools/common/Outcome.h"
#include "tools/common/Output.h"
#include "tools/common/PictureOptions.h"
#include "tools/common/Progress.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

namespace rtsl::tool {

namespace {

using Clock = std::chrono::steady_clock;

struct RenderCommandOptions {
  CommonOptions common;
  std::string scene;     // or shaders, of which a class is shown
  std::string className; // of that class; empty: the last
  std::string output;
  std::vector<std::string> overrides;
  std::string engine; // empty: the scene's
  std::optional<std::uint32_t> samples, depth, seed;
  std::uint32_t threads = 0;
  std::optional<PictureSize> size;
  runtime::Traversal traversal = runtime::Traversal::Embree;
  bool json = false;
  bool quiet = false;
  bool watches = false;          // for changes of files
  std::optional<double> seconds; // --time
  double noise = 0;              // --noise; 0: not given
  bool isInPasses() const { return seconds || noise > 0; }
  bool prints = false, exceptions = false;
  runtime::PictureFormat format = runtime::PictureFormat::ByName;
  TargetName target = TargetName::Host;
  bool hasGpuArchitecture = false; // --gpu-arch was given
};

/// What the command line changes in the scene: `--set`, and options that decide what is compiled.
std::vector<std::string> overridesOf(const RenderCommandOptions &options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.engine.empty())
    overrides.push_back("render.engine=" + options.engine);
  if (options.depth)
    overrides.push_back(fmt::format("render.depth={}", *options.depth));
  return overrides;
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

runtime::RenderOptions renderOptions(const RenderCommandOptions &options,
                                     const scene::RenderSettings &settings) {
  runtime::RenderOptions render = scene::renderOptions(settings);
  if (options.size) {
    render.width = options.size->width;
    render.height = options.size->height;
  }
  render.samplesPerPixel = options.samples.value_or(
      options.isInPasses() ? runtime::mostSamplesPerPixel : render.samplesPerPixel);
  render.maxDepth = options.depth.value_or(render.maxDepth);
  render.seed = options.seed.value_or(render.seed);
  render.threads = options.threads;
  render.traversal = options.traversal;
  render.keepsUnfinished = true;
  if (options.exceptions)
    render.mostNotFinite = runtime::PrintLog::mostLines;
  return render;
}

struct Times {
  double compile = 0, scene = 0, image = 0;
};

/// What samples met, by RTSL_EXCEPTION_*.
constexpr const char *exceptionNames[RTSL_EXCEPTIONS] = {"", "stackOverflow", "badRay", "index"};

/// What is said of a rendering when it is over.
struct Summary {
  runtime::RenderOptions render;
  runtime::RenderStatistics statistics;
  std::vector<SampleNotFinite> notFinite;
  std::vector<std::string> printed;
  Times times;
  const runtime::GpuStatistics *gpu = nullptr;            // null: no GPU took part
  double error = std::numeric_limits<double>::infinity(); // runtime::PassState::error
};

nlohmann::ordered_json toJson(const SampleNotFinite &one) {
  // JSON has no numbers that are not finite
  nlohmann::ordered_json color = nlohmann::ordered_json::array();
  for (const float value : one.color)
    color.push_back(std::isfinite(value) ? nlohmann::ordered_json(value)
                    : std::isnan(value)  ? nlohmann::ordered_json("nan")
                                         : nlohmann::ordered_json(value > 0 ? "inf" : "-inf"));
  nlohmann::ordered_json document = {
      {"pixel", {one.sample.x, one.sample.y}}, {"sample", one.sample.sample}, {"color", color}};
  if (one.place)
    document["place"] = {
        {"file", one.place->file}, {"line", one.place->line}, {"column", one.place->column}};
  return document;
}

nlohmann::ordered_json toJson(const runtime::GpuStatistics &gpu) {
  return {{"device", gpu.device},
          {"registers", gpu.registers},
          {"localBytes", gpu.localBytes},
          {"blocks", gpu.blocks},
          {"threadsPerBlock", gpu.threadsPerBlock},
          {"laneBytes", gpu.laneBytes},
          {"loadSeconds", gpu.loadSeconds},
          {"uploadSeconds", gpu.uploadSeconds}};
}

std::string toJson(const RenderCommandOptions &options, const Summary &summary) {
  const runtime::RenderOptions &render = summary.render;
  const runtime::RenderStatistics &statistics = summary.statistics;
  nlohmann::ordered_json document = {{"version", 1},
                                     {"output", options.output},
                                     {"size", {render.width, render.height}},
                                     {"spp", render.samplesPerPixel},
                                     {"seed", render.seed},
                                     {"seconds",
                                      {{"compile", summary.times.compile},
                                       {"scene", summary.times.scene},
                                       {"build", statistics.buildSeconds},
                                       {"render", statistics.renderSeconds},
                                       {"image", summary.times.image}}},
                                     {"samples", statistics.samples},
                                     {"pixels", statistics.pixels},
                                     {"badRays", statistics.badRays},
                                     {"retracedRays", statistics.retracedRays},
                                     {"rescaledRays", statistics.rescaledRays},
                                     {"raysTooDeep", statistics.raysTooDeep},
                                     {"samplesNotFinite", statistics.samplesNotFinite},
                                     {"pixelsWithoutSample", statistics.pixelsWithoutSample},
                                     {"notFinite", nlohmann::ordered_json::array()}};
  for (const SampleNotFinite &one : summary.notFinite)
    document["notFinite"].push_back(toJson(one));
  if (std::isfinite(summary.error))
    document["noise"] = summary.error;
  if (statistics.isUnfinished || (options.isInPasses() && interruption()))
    document["stoppedBy"] = interruption();
  if (options.prints)
    document["printed"] = summary.printed;
  for (std::uint32_t i = 1; i < RTSL_EXCEPTIONS; ++i)
    if (statistics.exceptions[i])
      document["exceptions"][exceptionNames[i]] = statistics.exceptions[i];
  if (summary.gpu)
    document["gpu"] = toJson(*summary.gpu);
  return document.dump(2) + "\n";
}

void printSummary(const RenderCommandOptions &options, const Summary &summary) {
  const runtime::RenderOptions &render = summary.render;
  const runtime::RenderStatistics &statistics = summary.statistics;
  if (options.json)
    return printOut(toJson(options, summary));
  if (options.quiet || options.common.jsonDiagnostics) // there standard error is one JSON document
    return;
  fmt::print(
      stderr,
      "{}: {}x{}, {} spp; compiled in {:.0f} ms, rendered in {:.2f} s ({:.2f} million samples/s)\n",
      options.output == "-" ? "standard output" : options.output, render.width, render.height,
      render.samplesPerPixel, summary.times.compile * 1e3, statistics.renderSeconds,
      double(statistics.samples) / statistics.renderSeconds * 1e-6);
  if (std::isfinite(summary.error))
    fmt::print(stderr, "noise: {:.4g}\n", summary.error);
  if (summary.gpu)
    fmt::print(stderr, "{}\n", gpuText(*summary.gpu));
  for (const std::string &text : exceptionTexts(statistics, render))
    fmt::print(stderr, "{}\n", text);
  if (statistics.badRays)
    fmt::print(stderr, "{} rays had no direction or were not finite, and returned black\n",
               statistics.badRays);
}

/// Warns of what makes a picture wrong although it was rendered: samples that are left out, and
/// rays that are not sent.
void warn(const Summary &summary, Messages &messages) {
  const runtime::RenderStatistics &statistics = summary.statistics;
  if (statistics.isUnfinished)
    messages.diagnostics.report(Code::unfinishedPicture, {},
                                unfinishedText(statistics, summary.render));
  if (statistics.samplesNotFinite) {
    SourceRange range;
    for (const SampleNotFinite &one : summary.notFinite)
      if (one.place && !range.isValid())
        range = messages.rangeOf(*one.place);
    Diagnostic &diagnostic =
        messages.diagnostics.report(Code::samplesNotFinite, range, notFiniteText(statistics));
    for (const SampleNotFinite &one : summary.notFinite) {
      const auto isNan = [](float value) { return std::isnan(value); };
      const char *const what = one.color.empty() ? "not finite"
                               : std::any_of(one.color.begin(), one.color.end(), isNan)
                                   ? "not a number"
                                   : "infinite";
      const std::string place = one.place ? fmt::format("since {}:{}:{}", one.place->file,
                                                        one.place->line, one.place->column)
                                          : "and the source line was not found";
      diagnostic.note(fmt::format("{} is {}, {}", sampleText(one.sample), what, place));
    }
    if (statistics.samplesNotFinite > summary.notFinite.size())
      diagnostic.note(fmt::format("and {} more samples",
                                  statistics.samplesNotFinite - summary.notFinite.size()));
  }
  if (statistics.raysTooDeep && !statistics.exceptions[RTSL_EXCEPTION_STACK_OVERFLOW])
    messages.diagnostics.report(Code::raysTooDeep, {}, tooDeepText(statistics, summary.render));
}

/// Renders, and frees the acceleration structures.
runtime::Image renderOn(RenderTarget &target, const runtime::Scene &scene,
                        const runtime::RenderOptions &options,
                        runtime::RenderStatistics &statistics) {
  const Clock::time_point start = Clock::now();
  const std::unique_ptr<runtime::Backend> backend = target.prepare(scene, options);
  const double seconds = secondsSince(start);
  runtime::Image image = backend->render(&statistics);
  statistics.buildSeconds = seconds;
  return image;
}

/// The same in passes. The picture so far is written at intervals.
runtime::Image renderInPasses(const RenderCommandOptions &options, const runtime::Scene &scene,
                              Progress &progress, Summary &summary) {
  runtime::PassOptions passes;
  passes.seconds = options.seconds.value_or(passes.seconds);
  passes.error = options.noise;
  if (options.output != "-")
    passes.picture = [&](const runtime::Image &image) {
      runtime::writeImage(options.output, image, options.format);
    };
  const auto show = [&](const runtime::PassState &state) {
    if (!options.quiet)
      progress.update(fmt::format(
          "{} spp, {:.0f} s{}", state.samplesPerPixel, state.seconds,
          std::isfinite(state.error) ? fmt::format(", noise {:.4f}", state.error) : ""));
  };
  runtime::PassState state;
  runtime::Renderer renderer(scene, summary.render);
  runtime::Image image = renderer.renderInPasses(passes, show, state, &summary.statistics);
  summary.render.samplesPerPixel = state.samplesPerPixel;
  summary.error = state.error;
  return image;
}

/// The scene of the file, or one that shows a class of it. Nothing if there are errors.
std::optional<Preview> readInput(const RenderCommandOptions &options, Messages &messages) {
  if (holdsShaders(options.scene))
    return makePreview({options.scene, options.className, overridesOf(options)}, options.common,
                       messages);
  return Preview{
      readScene(options.scene, overridesOf(options), messages, "render"), options.scene, {}};
}

/// Renders unless there are errors, and gives whether a picture was written. `files` gets those that
/// it depends on. `stop` stops the rendering; null: a signal does. The unfinished picture is written
/// unless `--watch` was given.
bool renderScene(const RenderCommandOptions &options, Messages &messages,
                 const std::atomic<bool> *stop, std::vector<std::string> &files) {
  runtime::checkWritable(options.output, options.format);
  checkOutputs(options.output, options.common.dependencies, {options.scene});
  const std::optional<Preview> input = readInput(options, messages);
  if (!input)
    return false;
  const scene::SceneDescription &description = input->description;
  files = withFiles(description, {input->file});

  const std::unique_ptr<RenderTarget> target =
      makeRenderTarget(options.target, options.hasGpuArchitecture);
  Summary summary;
  Clock::time_point start = Clock::now();
  std::vector<std::string> filesRead;
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, messages, &filesRead, input->takenNames);
  if (!module)
    return false;
  filesRead.front() = input->file;
  filesRead = withFiles(description, filesRead);
  files = filesRead;
  checkOutputs(options.output, options.common.dependencies, {options.scene}, filesRead);
  CompileOptions compile = options.common.compile;
  compile.threads = options.threads;
  LinkRequest request = linkRequest(description);
  request.features |= features(options.prints, options.exceptions);
  keep(options.common.keep, request, compile);
  if (options.common.keep.has(Item::Events) && options.target != TargetName::Gpu)
    request.features |= RTSL_FEATURE_PRINT; // the lines are thrown away
  std::optional<runtime::Scene> scene =
      target->compile(*module, request, compile, messages.diagnostics, [&](const auto &program) {
        const Clock::time_point begin = Clock::now();
        runtime::Scene made = scene::buildScene(description, program);
        summary.times.scene = secondsSince(begin);
        return made;
      });
  if (!scene)
    return false;
  summary.times.compile = secondsSince(start) - summary.times.scene;
  for (const Warning &warning : scene->warnings())
    messages.report(warning);

  runtime::RenderOptions &render = summary.render = renderOptions(options, description.render);
  render.cancel = stop ? stop : catchInterruptions();
  const std::uint64_t failedBefore = runtime::failedMachineStacks();
  Progress progress("rendering");
  if (!options.quiet)
    render.progress = [&](double share) { progress.update(share); };
  const runtime::Image image = options.isInPasses()
                                   ? renderInPasses(options, *scene, progress, summary)
                                   : renderOn(*target, *scene, render, summary.statistics);
  summary.gpu = target->gpu();
  progress.finish();
  if (options.watches && summary.statistics.isUnfinished) {
    runtime::takePrintLog();
    return false;
  }
  if (summary.statistics.samples == 0)
    throw Error(ErrorCode::Cancelled, "stopped before the first sample: no picture is written");
  summary.printed = runtime::takePrintLog().texts(scene->program().prints);
  std::uint64_t stackBytes = 0;
  if (runtime::failedMachineStacks(&stackBytes) > failedBefore)
    throw Error(
        ErrorCode::OutOfMemory,
        fmt::format(
            "no memory for rays in flight: a thread needs {} bytes; give a smaller `--depth`",
            stackBytes));

  start = Clock::now();
  runtime::writeImage(options.output, image, options.format);
  writeDependencies(options.common.dependencies, options.output, {options.scene}, filesRead);
  summary.times.image = secondsSince(start);
  if (options.prints && !options.json) // there the lines are part of the document
    printOut(summary.printed.empty() ? "" : fmt::format("{}\n", fmt::join(summary.printed, "\n")));
  if (!summary.statistics.notFinite.empty())
    try {
      summary.notFinite = explainNotFinite(summary.statistics, *module, request, compile, *scene,
                                           render, messages.diagnostics);
    } catch (const std::exception &error) { // the picture is written, and the samples are counted
      if (!isOutOfMemory(error))
        throw;
      for (const runtime::SampleId &sample : summary.statistics.notFinite)
        summary.notFinite.push_back({sample, {}, std::nullopt});
    }
  warn(summary, messages);
  printSummary(options, summary);
  return true;
}

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

/// --watch: what no change of a file can mend ends it at once.
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

int render(const RenderCommandOptions &options) {
  if (options.watches)
    return watch(options);
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

/// Rejects what cannot be done with passes, which end by --time or --noise (`option`).
void rejectInPasses(const RenderCommandOptions &options, const char *option) {
  if (options.target != TargetName::Host)
    throw CLI::ValidationError(option, "only `--target=host` renders in passes; leave out "
                                       "`--target`, or give a number of samples to `--spp`");
  if (options.watches)
    throw CLI::ValidationError(option, "`--watch` renders each picture with the same number of "
                                       "samples; give one to `--spp` instead");
}

/// Rejects options that a GPU cannot support.
void rejectWithoutGpuSupport(const RenderCommandOptions &options) {
  if (options.prints)
    throw CLI::ValidationError("--print",
                               "a GPU cannot print; `--target=host-megakernel` prints, and renders "
                               "the same picture");
  if (options.common.compile.floatingPoint == FloatingPoint::Double)
    throw CLI::ValidationError("--fp",
                               "shaders on a GPU compute in single precision; give strict or fast");
}

} // namespace

void addRenderCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<RenderCommandOptions>();
  CLI::App *command = app.add_subcommand(renderSummary.command, renderSummary.text);
  command
      ->add_option("FILE", options->scene,
                   "a scene (.json), or RTSL (.rtsl), of which one class is shown in a standard "
                   "scene; - is a scene on standard input")
      ->required();
  command
      ->add_option("--class", options->className,
                   "the class of an RTSL file to show; default: the last one that can be shown")
      ->type_name("NAME");
  addPictureOption(*command, options->output, options->format);
  addWhole(*command, "--spp", options->samples, 1, runtime::mostSamplesPerPixel,
           "samples per pixel");
  command
      ->add_option_function<std::string>(
          "--time",
          [options](const std::string &text) { options->seconds = parseDuration("--time", text); },
          "render samples until this time is over (30s, 2m, 500ms); at most --spp")
      ->type_name("TIME");
  addNotNegative(*command, "--noise", options->noise,
                 "render samples until the estimated relative error of the picture is below; at "
                 "most --spp");
  addSizeOption(*command, options->size);
  addWhole(*command, "--threads", options->threads, 1, runtime::mostThreads,
           "threads; default: all cores");
  addWhole(*command, "--depth", options->depth, 0, runtime::maxRayDepth,
           "limit of nested `trace` calls; 0: camera rays only");
  command
      ->add_option("--engine", options->engine,
                   "classic, path, programs; or a view: normals, depth, id, albedo, occlusion")
      ->type_name("NAME");
  addWhole(*command, "--seed", options->seed, 0, 0xffffffff, "seed of the random numbers");
  addSetOption(*command, options->overrides);
  addTraversalOption(*command, options->traversal);
  addTargetOption(*command, options->target);
  command->add_flag("--print", options->prints,
                    "write the output of `print` to standard output, in the order of pixels");
  command->add_flag("--exceptions", options->exceptions,
                    "end samples that send an invalid ray, exceed the depth limit, or use an index "
                    "out of range, and count them; list all samples that are not finite");
  command->add_flag("--json", options->json, "write times and counts to standard output as JSON");
  command->add_flag("--watch", options->watches,
                    "render again whenever a file of the scene is saved, until Ctrl-C");
  command->add_flag("-q,--quiet", options->quiet, "no progress and no summary");
  addPreprocessorOptions(*command, options->common.preprocessor);
  addDependencyOptions(*command, options->common.dependencies);
  addCompileOptions(*command, options->common);
  addKeepOption(*command, options->common);
  addMessageOptions(*command, options->common);
  command->footer(
      "examples:\n  rtslc render examples/glass/scene.json -o glass.png --spp 64 --size 1920x1080\n"
      "  rtslc render examples/cornell/room.json -o normals.png --engine normals\n"
      "  rtslc render Clay.rtsl -o clay.png --set Clay.polish=0.2");
  command->callback([options, command, &action] {
    for (const auto &[name, isGiven] :
         {std::make_pair("--json", options->json), std::make_pair("--print", options->prints)})
      if (isGiven && options->output == "-")
        throw CLI::ValidationError(name, "standard output is the picture; give a file to `-o`");
    if (!options->className.empty() && !holdsShaders(options->scene))
      throw CLI::ValidationError("--class", fmt::format("`{}` is a scene, which names its classes; "
                                                        "give a file of shaders (.rtsl)",
                                                        options->scene));
    if (command->count("--noise") && (options->noise == 0 || std::isinf(options->noise)))
      throw CLI::ValidationError("--noise", "no picture is without error; give a number like 0.01");
    if (options->isInPasses())
      rejectInPasses(*options, options->seconds ? "--time" : "--noise");
    if (options->watches) {
      rejectWithWatch(*options);
      if (!command->count("-O"))
        options->common.compile.optimization = optimizationOfWatch;
    }
    checkPictureName(options->output, options->format);
    if (options->target == TargetName::Gpu)
      rejectWithoutGpuSupport(*options);
    if (options->target != TargetName::Host)
      options->common.compile.target = Target::HostMegakernel;
    options->hasGpuArchitecture = command->count("--gpu-arch") != 0;
    action = [options] { return render(*options); };
  });
}

} // namespace rtsl::tool
