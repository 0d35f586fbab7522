//===- RunCommand.cpp - rtslc run -----------------------------------------===//
//
// Runs the launches of a scene for the sake of its output buffers (docs/scene-format.md#buffers).
//
//===----------------------------------------------------------------------===//
#include "RunCommand.h"

#include "runtime/buffers/BufferOutput.h"
#include "runtime/program/PrintLog.h"
#include "scenefile/SceneFile.h"
#include "scenefile/files/KeptFiles.h"
#include "support/AtomicFile.h"
#include "support/Clock.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"
#include "tools/common/BufferOptions.h"
#include "tools/common/Interruption.h"
#include "tools/common/OptionValues.h"
#include "tools/common/Outcome.h"
#include "tools/common/Output.h"
#include "tools/common/PictureOptions.h"
#include "tools/common/Progress.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace rtsl::tool {

namespace {

constexpr std::uint32_t mostRepeats = 1000000;

using Json = nlohmann::ordered_json;

/// One launch, when it is over.
struct Launch {
  std::string rayGeneration; // its class
  runtime::RenderOptions render;
  runtime::RenderStatistics statistics;
  double compileSeconds = 0;
  std::vector<double> repeatSeconds; // ascending
  std::optional<runtime::GpuStatistics> gpu;
  std::vector<runtime::OutputBuffer> outputs;
};

/// The seconds of the launch alone: by the clock of the GPU, if that runs it.
double secondsOf(const runtime::RenderStatistics &statistics) {
  return statistics.kernelSeconds > 0 ? statistics.kernelSeconds : statistics.renderSeconds;
}

/// The scene, with the buffers of --in.
scene::SceneDescription readInputs(const RunOptions &options, Messages &messages) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.inputs.empty()) {
    if (options.scene == "-")
      throw Error(message::inputNeedsFile());
    const scene::JsonValue root = scene::parseJson(readFile(options.scene), options.scene);
    const scene::JsonValue *buffers = root.find("buffers");
    for (const BufferFile &input : options.inputs) {
      const bool isNamed = buffers && buffers->find(input.name);
      if (!isNamed && root.find("passes"))
        throw Error(message::noInputBuffer(input.name));
      overrides.push_back(fmt::format("{}.{}={}", isNamed ? "buffers" : "rayGeneration", input.name,
                                      Json{{"buffer", input.file}}.dump()));
    }
  }
  return readScene(options.scene, overrides, messages, "run");
}

/// The command has no option for it, because passes may have different ones.
constexpr const char *depthOfScene = "`depth` in the scene file";

/// Rejects, before anything runs, names of --out that stand for no buffer, and files whose format
/// has no place for its elements.
void checkBuffers(const RunOptions &options, const scene::SceneDescription &description,
                  const typed::Module &module) {
  std::set<std::string> names;
  std::map<std::string, const Type *> elements; // by those of the names that are known to have one
  for (const auto &buffer : description.buffers)
    names.insert(buffer.first);
  for (std::size_t i = 0; i < scene::launchCount(description); ++i) {
    const std::optional<scene::ObjectDescription> &start =
        scene::launchOf(description, i).rayGeneration;
    const typed::Class *one = start ? module.findClass(start->className.text) : nullptr;
    for (; one; one = one->base)
      for (const auto &member : one->members)
        if (member->type->is(TypeKind::Buffer) && member->type->mode != BufferMode::Read) {
          names.insert(member->name);
          elements[member->name] = member->type->element;
          for (const auto &[name, value] : start->members)
            if (name.text == member->name && value->kind == scene::JsonValue::Kind::String)
              elements[value->string] = member->type->element;
        }
  }
  for (const BufferFile &output : options.outputs)
    if (!names.count(output.name)) {
      Error error(message::noOutputBuffer(output.name));
      const std::string near = closestName(output.name, {names.begin(), names.end()});
      if (!near.empty())
        error.note(fmt::format("did you mean `{}`?", near));
      else if (!names.empty())
        error.note(fmt::format("it has `{}`", fmt::join(names, "`, `")));
      throw error;
    }
  for (const BufferFile &output : options.outputs)
    if (const auto known = elements.find(output.name); known != elements.end())
      runtime::checkBufferFile(output.file, output.name, known->second->is(TypeKind::Struct),
                               toString(known->second));
}

runtime::RenderOptions renderOptions(const RunOptions &options,
                                     const scene::RenderSettings &settings) {
  runtime::RenderOptions render = scene::renderOptions(settings);
  if (!settings.hasSamples)
    render.samplesPerPixel = 1;
  render.threads = options.threads;
  render.pixelsInTurns = options.pixelsInTurns;
  render.traversal = options.traversal;
  render.tree = options.tree;
  render.cancel = catchInterruptions();
  return render;
}

/// Compiles and runs the launches in their order.
class Launches {
public:
  Launches(const RunOptions &options, const typed::Module &module, Messages &messages)
      : options(options), module(module), messages(messages) {}

  /// Nothing if there were errors, which are reported.
  bool run(const scene::SceneDescription &description) {
    const std::size_t count = scene::launchCount(description);
    const auto kept = count > 1 ? std::make_shared<scene::KeptFiles>() : nullptr;
    for (std::size_t i = 0; i < count; ++i) {
      scene::SceneDescription launch = scene::launchOf(description, i);
      launch.keptFiles = kept;
      if (!runOne(launch, i, count))
        return false;
    }
    return true;
  }

  /// The buffer of this name: one of the scene's, or an output of the last launch that has it.
  std::optional<runtime::OutputBuffer> find(const std::string &name) const {
    if (const auto named = buffers.made.find(name); named != buffers.made.end()) {
      const runtime::Value &value = named->second.value;
      return runtime::OutputBuffer{name, named->second.type, value.sizes,
                                   reinterpret_cast<std::uint8_t *>(value.words->data()),
                                   4 * value.words->size()};
    }
    for (auto launch = launches.rbegin(); launch != launches.rend(); ++launch)
      for (const runtime::OutputBuffer &output : launch->outputs)
        if (output.member == name)
          return output;
    return std::nullopt;
  }

  /// All buffers that launches wrote, by the names for --out.
  std::vector<std::string> names() const {
    std::set<const std::uint8_t *> written;
    std::vector<std::string> names;
    for (const Launch &launch : launches)
      for (const runtime::OutputBuffer &output : launch.outputs)
        if (written.insert(output.elements).second)
          names.push_back(nameOf(output));
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
  }

  std::vector<Launch> launches;
  runtime::Image picture; // of the last one
  std::vector<std::string> printed;

private:
  std::string nameOf(const runtime::OutputBuffer &output) const {
    for (const auto &[name, buffer] : buffers.made)
      if (reinterpret_cast<const std::uint8_t *>(buffer.value.words->data()) == output.elements)
        return name;
    return output.member;
  }

  bool runOne(const scene::SceneDescription &description, std::size_t number, std::size_t count) {
    const Clock::time_point start = Clock::now();
    CompileOptions compile = options.common.compile;
    compile.threads = options.threads;
    compile.rendersPicture = !options.picture.empty();
    LinkRequest request = linkRequest(description);
    request.features |= features(options.prints, options.exceptions);
    keep(options.common.keep, request, compile);
    std::unique_ptr<RenderTarget> target =
        makeRenderTarget(options.target, options.hasGpuArchitecture, options.gpu);
    std::optional<runtime::Scene> scene =
        target->compile(module, request, compile, messages.diagnostics, [&](const auto &program) {
          return scene::buildScene(description, program, buffers);
        });
    if (!scene)
      return false;
    for (const Warning &warning : scene->warnings())
      messages.report(warning);
    Launch launch;
    if (description.rayGeneration && description.render.engine != runtime::Engine::Classic)
      launch.rayGeneration = description.rayGeneration->className.text;
    launch.render = renderOptions(options, description.render);
    launch.render.wantsPicture = !options.picture.empty();
    launch.render.prints = options.prints;
    launch.compileSeconds = secondsSince(start);
    Progress progress(count == 1 ? "running" : fmt::format("running {} of {}", number + 1, count));
    runtime::RenderOptions shown = launch.render; // whose `progress` must not outlive this
    if (!options.quiet)
      shown.progress = [&](double share) { progress.update(share); };
    const std::unique_ptr<runtime::Backend> backend = target->prepare(*scene, shown, nullptr);
    if (const auto gpus = target->gpus(); !gpus.empty())
      launch.gpu = gpus.front();
    picture = backend->render(&launch.statistics);
    for (const std::string &line : runtime::takePrintLog().texts(scene->program().prints))
      printed.push_back(line);
    launch.outputs = scene->outputs();
    repeat(*backend, launch);
    progress.finish();
    warn(launch);
    launches.push_back(std::move(launch));
    // The scene owns the elements of buffers without a name.
    scenes.push_back(std::make_unique<runtime::Scene>(std::move(*scene)));
    targets.push_back(std::move(target));
    return true;
  }

  /// Runs the launch again, and keeps what it wrote and printed before.
  void repeat(runtime::Backend &backend, Launch &launch) const {
    std::vector<std::vector<std::uint8_t>> written;
    if (options.repeats > 0)
      for (const runtime::OutputBuffer &output : launch.outputs)
        written.emplace_back(output.elements, output.elements + output.bytes);
    for (std::uint32_t i = 0; i < options.repeats; ++i) {
      runtime::RenderStatistics statistics;
      backend.render(&statistics);
      launch.repeatSeconds.push_back(secondsOf(statistics));
      runtime::takePrintLog();
    }
    std::sort(launch.repeatSeconds.begin(), launch.repeatSeconds.end());
    for (std::size_t i = 0; i < written.size(); ++i)
      std::copy(written[i].begin(), written[i].end(), launch.outputs[i].elements);
  }

  void warn(const Launch &launch) const {
    const runtime::RenderStatistics &statistics = launch.statistics;
    if (statistics.samplesNotFinite && launch.render.wantsPicture)
      messages.diagnostics.reportText(Code::samplesNotFinite, {}, notFiniteText(statistics));
    if (statistics.raysTooDeep && !statistics.exceptions[RTSL_EXCEPTION_STACK_OVERFLOW])
      messages.diagnostics.reportText(Code::raysTooDeep, {},
                                      tooDeepText(statistics, launch.render, depthOfScene));
  }

  const RunOptions &options;
  const typed::Module &module;
  Messages &messages;
  scene::NamedBuffers buffers;
  std::vector<std::unique_ptr<RenderTarget>> targets;
  std::vector<std::unique_ptr<runtime::Scene>> scenes; // which the targets outlive
};

/// The size of each dimension; two unless the launch has three.
std::vector<std::uint32_t> sizeOf(const runtime::RenderOptions &render) {
  std::vector<std::uint32_t> sizes{render.width, render.height / render.slices};
  if (render.slices > 1)
    sizes.push_back(render.slices);
  return sizes;
}

std::string fileOf(const RunOptions &options, const std::string &buffer) {
  for (const BufferFile &output : options.outputs)
    if (output.name == buffer)
      return output.file;
  return {};
}

std::string toJson(const RunOptions &options, const Launches &all) {
  Json document = {{"version", 1}, {"launches", Json::array()}, {"buffers", Json::array()}};
  for (const Launch &launch : all.launches) {
    document["launches"].push_back({{"rayGeneration", launch.rayGeneration},
                                    {"size", sizeOf(launch.render)},
                                    {"spp", launch.render.samplesPerPixel},
                                    {"seconds",
                                     {{"compile", launch.compileSeconds},
                                      {"build", launch.statistics.buildSeconds},
                                      {"run", launch.statistics.renderSeconds}}},
                                    {"samples", launch.statistics.samples},
                                    {"badRays", launch.statistics.badRays},
                                    {"raysTooDeep", launch.statistics.raysTooDeep}});
    if (options.repeats > 0)
      document["launches"].back()["repeats"] = launch.repeatSeconds;
    if (launch.statistics.tree)
      document["launches"].back()["tree"] = tool::toJson(*launch.statistics.tree);
    if (launch.gpu)
      document["launches"].back()["gpu"] = tool::toJson(*launch.gpu);
  }
  for (const std::string &name : all.names()) {
    const runtime::OutputBuffer buffer = *all.find(name);
    document["buffers"].push_back(
        {{"name", name}, {"type", buffer.type.name}, {"size", buffer.sizes}});
    if (const std::string file = fileOf(options, name); !file.empty())
      document["buffers"].back()["file"] = file;
  }
  if (options.prints)
    document["printed"] = all.printed;
  return document.dump(2) + "\n";
}

void printSummary(const RunOptions &options, const Launches &all) {
  if (options.json)
    return printOut(toJson(options, all));
  if (options.prints && !all.printed.empty())
    printOut(fmt::format("{}\n", fmt::join(all.printed, "\n")));
  if (options.quiet || options.common.jsonDiagnostics) // there standard error is one JSON document
    return;
  for (const Launch &launch : all.launches) {
    fmt::print(stderr, "{}: {}, {} spp; compiled in {:.0f} ms, ran in {:.3f} s\n",
               launch.rayGeneration.empty() ? "camera" : launch.rayGeneration,
               fmt::join(sizeOf(launch.render), "x"), launch.render.samplesPerPixel,
               launch.compileSeconds * 1e3, launch.statistics.renderSeconds);
    if (options.repeats > 0)
      fmt::print(stderr, "repeated {} times: {:.3f} ms in the median\n", options.repeats,
                 launch.repeatSeconds[launch.repeatSeconds.size() / 2] * 1e3);
    for (const std::string &text : exceptionTexts(launch.statistics, launch.render, depthOfScene))
      fmt::print(stderr, "{}\n", text);
  }
  for (const std::string &name : all.names()) {
    const runtime::OutputBuffer buffer = *all.find(name);
    const std::string file = fileOf(options, name);
    fmt::print(stderr, "  {} {}, {}: {}\n", buffer.type.name, name, fmt::join(buffer.sizes, " x "),
               file.empty() ? fmt::format("not written, `--out {}=FILE` does", name) : file);
  }
}

void runScene(const RunOptions &options, Messages &messages) {
  std::vector<std::string> files;
  for (const BufferFile &output : options.outputs)
    files.push_back(output.file);
  if (!options.picture.empty())
    files.push_back(options.picture);
  for (const std::string &file : files)
    checkFileWritable(file);
  scene::SceneDescription description = readInputs(options, messages);
  std::vector<std::string> filesRead;
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, messages, &filesRead);
  if (!module)
    return;
  filesRead = withFiles(description, filesRead);
  for (const std::string &file : files)
    checkOutputs(file, {}, {options.scene}, filesRead);
  checkBuffers(options, description, *module);

  Launches launches(options, *module, messages);
  if (!launches.run(description))
    return;
  for (const BufferFile &output : options.outputs)
    runtime::writeBuffer(output.file, *launches.find(output.name));
  if (!options.picture.empty())
    runtime::writeImage(options.picture, launches.picture, runtime::PictureFormat::ByName);
  printSummary(options, launches);
}

} // namespace

int runLaunches(RunOptions options) {
  options.common.compile.codeCache = keptCode();
  Messages messages(options.common);
  try {
    runScene(options, messages);
  } catch (Error &error) {
    if (error.code == ErrorCode::NoDevice)
      error.note("`--target=host-megakernel` runs the same program on the CPU");
    if (error.code == ErrorCode::Cancelled)
      error.note("no buffer is written");
    messages.report(error);
  }
  return statusAfterInterruption(messages.status());
}

void addRunOptions(CLI::App &command, RunOptions &options) {
  addWhole(command, "--threads", options.threads, 1, runtime::mostThreads,
           "threads; default: all cores");
  addPixelsInTurnsOption(command, options.pixelsInTurns);
  addTraversalOption(command, options.traversal);
  addTreeOption(command, options.tree);
  addTargetOption(command, options.target);
  addMaxRegistersOption(command, options.gpu);
  addWhole(command, "--repeat", options.repeats, 0, mostRepeats,
           "run each launch N more times, and print how long these took; outputs are those of the "
           "first run");
  command.add_flag("--json", options.json, "write times and buffers to standard output as JSON");
  command.add_flag("-q,--quiet", options.quiet, "no progress and no summary");
  addCompileOptions(command, options.common);
  addKeepOption(command, options.common);
  addMessageOptions(command, options.common);
}

void completeRunOptions(const CLI::App &command, RunOptions &options) {
  checkOutputFiles(options.outputs, options.picture);
  if (options.target != TargetName::Gpu)
    rejectGpuOptions(command);
  if (options.target != TargetName::Host)
    options.common.compile.target = Target::HostMegakernel;
  options.hasGpuArchitecture = command.count("--gpu-arch") != 0;
}

void addRunCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App *command = app.add_subcommand(runSummary.command, runSummary.text);
  command->add_option("SCENE", options->scene, "a scene file (JSON); - is standard input")
      ->required();
  addBufferOption(*command, "--out", options->outputs,
                  "write an output buffer: .npy, .csv, or the elements as they lie in memory");
  addBufferOption(*command, "--in", options->inputs,
                  "read a buffer of `buffers`, or of the ray generation, from a file");
  command->add_option("-o,--output", options->picture, "the picture of the last launch")
      ->type_name("IMAGE");
  addSetOption(*command, options->overrides);
  command->add_flag("--print", options->prints,
                    "write the output of `print` to standard output, in the order of pixels");
  command->add_flag("--exceptions", options->exceptions,
                    "end samples that send an invalid ray, exceed the depth limit, or use an index "
                    "out of range, and count them");
  addPreprocessorOptions(*command, options->common.preprocessor);
  addRunOptions(*command, *options);
  command->footer("examples:\n"
                  "  rtslc run examples/line-of-sight/scene.json --out visible=visible.npy\n"
                  "  rtslc run scene.json --in rays=rays.npy --out hits=hits.csv");
  command->callback([options, command, &action] {
    completeRunOptions(*command, *options);
    action = [options] { return runLaunches(*options); };
  });
}

} // namespace rtsl::tool
