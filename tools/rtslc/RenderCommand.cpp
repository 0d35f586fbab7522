//===- RenderCommand.cpp - rtslc render -----------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "PictureSize.h"
#include "Progress.h"
#include "SceneShaders.h"
#include "codegen/driver/SceneProgram.h"
#include "runtime/FlatScene.h"
#include "runtime/HostMegakernel.h"
#include "runtime/MachineStack.h"
#include "runtime/PrintLog.h"
#include "runtime/Renderer.h"
#include "scene/SceneFile.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

namespace rtsl::tool {

namespace {

using Clock = std::chrono::steady_clock;

struct RenderCommandOptions {
  CommonOptions common;
  std::string scene;
  std::string output;
  std::vector<std::string> overrides;
  std::optional<std::uint32_t> samples, depth, seed;
  std::uint32_t threads = 0;
  std::optional<PictureSize> size;
  runtime::Traversal traversal = runtime::Traversal::Embree;
  bool json = false;
  bool quiet = false;
  bool prints = false, exceptions = false;
};

std::atomic<bool> interrupted{false};

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

runtime::RenderOptions renderOptions(const RenderCommandOptions &options, const scene::RenderSettings &settings) {
  runtime::RenderOptions render = scene::renderOptions(settings);
  if (options.size) {
    render.width = options.size->width;
    render.height = options.size->height;
  }
  render.samplesPerPixel = options.samples.value_or(render.samplesPerPixel);
  render.maxDepth = options.depth.value_or(render.maxDepth);
  render.seed = options.seed.value_or(render.seed);
  render.threads = options.threads;
  render.traversal = options.traversal;
  render.cancel = &interrupted;
  return render;
}

struct Times {
  double compile = 0, scene = 0, image = 0;
};

/// What samples met, by RTSL_EXCEPTION_*.
constexpr const char *exceptionNames[RTSL_EXCEPTIONS] = {"", "stackOverflow", "badRay", "index"};

void printExceptions(const runtime::RenderOptions &render, const runtime::RenderStatistics &statistics) {
  const std::uint64_t *counts = statistics.exceptions;
  if (counts[RTSL_EXCEPTION_STACK_OVERFLOW])
    fmt::print(stderr, "{} samples sent rays deeper than {}: give a larger `--depth`, or end the recursion in the shader\n",
               counts[RTSL_EXCEPTION_STACK_OVERFLOW], render.maxDepth);
  if (counts[RTSL_EXCEPTION_BAD_RAY])
    fmt::print(stderr, "{} samples sent a ray without a direction, or one that was not finite\n",
               counts[RTSL_EXCEPTION_BAD_RAY]);
  if (counts[RTSL_EXCEPTION_INDEX])
    fmt::print(stderr, "{} samples used an index that was out of range\n", counts[RTSL_EXCEPTION_INDEX]);
}

void printSummary(const RenderCommandOptions &options, const runtime::RenderOptions &render,
                  const runtime::RenderStatistics &statistics, const std::vector<std::string> &printed,
                  const Times &times) {
  if (options.json) {
    nlohmann::ordered_json document = {
        {"version", 1},
        {"output", options.output},
        {"size", {render.width, render.height}},
        {"spp", render.samplesPerPixel},
        {"seed", render.seed},
        {"seconds",
         {{"compile", times.compile},
          {"scene", times.scene},
          {"build", statistics.buildSeconds},
          {"render", statistics.renderSeconds},
          {"image", times.image}}},
        {"samples", statistics.samples},
        {"badRays", statistics.badRays},
        {"retracedRays", statistics.retracedRays},
        {"rescaledRays", statistics.rescaledRays},
        {"samplesNotFinite", statistics.samplesNotFinite}};
    if (options.prints)
      document["printed"] = printed;
    for (std::uint32_t i = 1; i < RTSL_EXCEPTIONS; ++i)
      if (statistics.exceptions[i])
        document["exceptions"][exceptionNames[i]] = statistics.exceptions[i];
    fmt::print("{}\n", document.dump(2));
  } else if (!options.quiet && !options.common.jsonDiagnostics) { // there standard error is one JSON document
    fmt::print(stderr, "{}: {}x{}, {} spp; compiled in {:.0f} ms, rendered in {:.2f} s ({:.2f} million samples/s)\n",
               options.output, render.width, render.height, render.samplesPerPixel, times.compile * 1e3,
               statistics.renderSeconds, double(statistics.samples) / statistics.renderSeconds * 1e-6);
    printExceptions(render, statistics);
    if (statistics.samplesNotFinite)
      fmt::print(stderr, "{} samples were infinite or not a number, and count as black\n", statistics.samplesNotFinite);
    if (statistics.badRays)
      fmt::print(stderr, "{} rays had no direction or were not finite, and saw black\n", statistics.badRays);
  }
}

/// By the GPU's program.
runtime::Image renderFlat(const runtime::Scene &scene, const runtime::RenderOptions &options,
                          runtime::RenderStatistics &statistics) {
  const Clock::time_point start = Clock::now();
  runtime::FlatScene flat = runtime::flatten(scene);
  const double seconds = secondsSince(start);
  runtime::Image image = runtime::renderOnHost(scene.program().megakernel, std::move(flat), options, &statistics);
  statistics.buildSeconds = seconds;
  return image;
}

void renderScene(const RenderCommandOptions &options, Messages &messages) {
  runtime::checkWritable(options.output);
  const scene::SceneDescription description = scene::readSceneFile(options.scene, options.overrides);

  Times times;
  Clock::time_point start = Clock::now();
  std::vector<std::string> filesRead;
  const std::unique_ptr<typed::Module> module = loadShaders(description, options.common, messages, &filesRead);
  if (!module)
    return;
  CompileOptions compile = options.common.compile;
  LinkRequest request = linkRequest(description);
  request.features |= features(options.prints, options.exceptions);
  keep(options.common.keep, request, compile);
  if (options.common.keep.has(Item::Events)) // the lines are thrown away
    request.features |= RTSL_FEATURE_PRINT;
  const std::optional<runtime::Scene> compiled =
      compileScene(*module, request, compile, messages.diagnostics, [&](const auto &program) {
        const Clock::time_point begin = Clock::now();
        runtime::Scene scene = scene::buildScene(description, program);
        times.scene = secondsSince(begin);
        return scene;
      });
  if (!compiled)
    return;
  times.compile = secondsSince(start) - times.scene;
  const runtime::Scene &scene = *compiled;
  for (const runtime::Warning &warning : scene.warnings())
    messages.report(warning);

  runtime::RenderOptions render = renderOptions(options, description.render);
  Progress progress("rendering");
  if (!options.quiet)
    render.progress = [&](double share) { progress.update(share); };
  runtime::RenderStatistics statistics;
  const runtime::Image image = options.common.compile.target == Target::HostMegakernel
                                   ? renderFlat(scene, render, statistics)
                                   : runtime::render(scene, render, &statistics);
  progress.finish();
  const std::vector<std::string> printed = runtime::takePrintLog().texts(scene.program().prints);
  if (options.prints && !options.json) // there the lines are part of the document
    for (const std::string &line : printed)
      fmt::print("{}\n", line);
  std::uint64_t stackBytes = 0;
  if (runtime::failedMachineStacks(&stackBytes))
    throw runtime::Error(runtime::ErrorCode::OutOfMemory,
                         fmt::format("no memory for rays in flight: a thread needs {} bytes; ask for a smaller `--depth`",
                                     stackBytes));

  start = Clock::now();
  runtime::writeImage(options.output, image);
  writeDependencies(options.common.dependencies, options.output, {options.scene}, withMeshes(description, filesRead));
  times.image = secondsSince(start);
  printSummary(options, render, statistics, printed, times);
}

int render(const RenderCommandOptions &options) {
  std::signal(SIGINT, [](int) { interrupted = true; });
  Messages messages(options.common);
  try {
    renderScene(options, messages);
  } catch (const runtime::Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addRenderCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<RenderCommandOptions>();
  CLI::App *command = app.add_subcommand(renderSummary.command, renderSummary.text);
  command->add_option("SCENE", options->scene, "a scene file (JSON)")->required();
  command->add_option("-o,--output", options->output, "the picture: .png or .exr")->required()->type_name("IMAGE");
  command->add_option("--spp", options->samples, "samples a pixel")->check(CLI::Range(1u, 1u << 24))->type_name("N");
  addSizeOption(*command, options->size);
  command->add_option("--threads", options->threads, "threads; all cores if not given")
      ->check(CLI::Range(1u, 4096u))
      ->type_name("N");
  command->add_option("--depth", options->depth, "how often a ray may lead to another; 0: camera rays only")
      ->check(CLI::Range(0u, 1000u))
      ->type_name("N");
  command->add_option("--seed", options->seed, "seed of the random numbers")->type_name("N");
  command->add_option("--set", options->overrides, "change a value of the scene file, such as objects.3.mesh=bunny.obj")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  command->add_option("--traversal", options->traversal, "embree: fast; device: the one that GPUs run")
      ->transform(CLI::CheckedTransformer(std::map<std::string, runtime::Traversal>{
                                              {"embree", runtime::Traversal::Embree}, {"device", runtime::Traversal::Device}})
                      .description(""))
      ->type_name("embree|device");
  command
      ->add_option("--target", options->common.compile.target,
                   "host: the fastest way on this machine; host-megakernel: the program that GPUs run, on the CPU")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Target>{{"host", Target::Host},
                                                                        {"host-megakernel", Target::HostMegakernel}})
                      .description(""))
      ->type_name("host|host-megakernel");
  command->add_flag("--print", options->prints,
                    "show what shaders print, in the order of pixels, on standard output");
  command->add_flag("--exceptions", options->exceptions,
                    "end samples that send a bad ray, one too deep, or use an index out of range, and say how many");
  command->add_flag("--json", options->json, "write times and counts to standard output as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress and no summary");
  addPreprocessorOptions(*command, options->common.preprocessor);
  addDependencyOptions(*command, options->common.dependencies);
  addCompileOptions(*command, options->common);
  addKeepOption(*command, options->common);
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc render examples/glass/scene.json -o glass.png --spp 64 --size 1920x1080");
  command->callback([options, &action] { action = [options] { return render(*options); }; });
}

} // namespace rtsl::tool
