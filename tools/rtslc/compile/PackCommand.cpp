//===- PackCommand.cpp - rtslc pack ---------------------------------------===//
#include "runtime/accel/BvhBuilder.h"
#include "runtime/accel/FlatScene.h"
#include "runtime/package/NativeCode.h"
#include "runtime/package/Package.h"
#include "scenefile/SceneFile.h"
#include "support/AtomicFile.h"
#include "tools/common/GpuOptions.h"
#include "tools/common/PictureOptions.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/ScenePackage.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>

#include <memory>
#include <optional>

namespace rtsl::tool {

namespace {

struct PackOptions {
  CommonOptions common;
  std::string scene, output;
  std::vector<std::string> overrides;
  std::optional<runtime::TreeKind> tree;
  GpuOptions gpu;
  bool quiet = false;
};

/// A package is rendered many times, so it has good trees, unless fast ones are requested: they
/// are built where it is rendered.
runtime::FlatScene flatten(const runtime::Scene &scene, std::optional<runtime::TreeKind> tree) {
  return tree == runtime::TreeKind::Fast ? runtime::flatten(scene)
                                         : runtime::flatten(scene, runtime::buildBvh(scene));
}

/// The buffers of the ray generation, for `rtsl-run --in` and `--out`.
std::vector<runtime::PackageBuffer> buffersOf(const runtime::Scene &scene,
                                              const runtime::FlatScene &flat,
                                              const scene::SceneDescription &description) {
  std::vector<runtime::PackageBuffer> buffers;
  const RtslLaunch launch = scene.launch();
  if (!description.rayGeneration || launch.rayGeneration == 0)
    return buffers;
  const scene::ObjectDescription &object = *description.rayGeneration;
  std::uint64_t records = 0; // where they are in the flat scene
  std::memcpy(&records, flat.bytes.data() + offsetof(RtslLaunch, records), sizeof records);
  for (const runtime::MemberInfo &member : scene.classOf(launch.rayGeneration).members) {
    if (member.type.bufferRank == 0 || !member.isPublic ||
        member.type.kind == runtime::ValueType::Kind::Reference)
      continue;
    runtime::PackageBuffer buffer;
    buffer.name = member.name;
    for (const auto &[key, value] : object.members)
      if (key.text == member.name && value->kind == scene::JsonValue::Kind::String)
        buffer.sceneName = value->string;
    buffer.type = member.type;
    buffer.values = member.values;
    buffer.place = records + launch.rayGeneration + member.offset;
    buffer.hasLaunchSize = member.type.isOutput && !scene::isGiven(object, member.name);
    const std::string &sized = description.render.sizeBuffer;
    buffer.setsLaunchSize = !sized.empty() && buffer.isNamed(sized);
    buffers.push_back(std::move(buffer));
  }
  return buffers;
}

void packScene(const PackOptions &options, Messages &messages) {
  checkOutputs(options.output, options.common.dependencies, {options.scene});
  scene::SceneDescription description =
      readScene(options.scene, options.overrides, messages, "pack");
  std::vector<std::string> filesRead;
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, messages, &filesRead);
  if (!module)
    return;
  filesRead = withFiles(description, filesRead);
  checkOutputs(options.output, options.common.dependencies, {options.scene}, filesRead);
  CompileOptions compile = options.common.compile;
  compile.codeCache = keptCode();
  LinkRequest request = linkRequest(description);
  keep(options.common.keep, request, compile);
  runtime::Package package;
  package.compiler = "rtslc " RTSL_VERSION;
  package.options = scene::renderOptions(description.render);
  package.hasSamples = description.render.hasSamples;
  const std::optional<runtime::Scene> scene = compileScenePackage(
      *module, request, compile, messages.diagnostics,
      [&](const auto &constructors) { return scene::buildScene(description, constructors); },
      package);
  if (!scene)
    return;
  if (options.gpu.maxRegisters)
    package.registers = options.gpu.maxRegisters;
  for (const Warning &warning : scene->warnings())
    messages.report(warning);
  package.scene = flatten(*scene, options.tree);
  package.buffers = buffersOf(*scene, package.scene, description);

  const runtime::NativeCode code(package.host);
  const std::uint32_t chain = package.scene.launch().referenceChain;
  for (std::uint32_t depth = 0; depth < package.laneBytes.size(); ++depth)
    package.laneBytes[depth] = static_cast<std::uint32_t>(code.entries().laneBytes(depth, chain));

  const std::string bytes = runtime::serialize(package);
  writeFileAtomically(options.output, bytes);
  writeDependencies(options.common.dependencies, options.output, {options.scene}, filesRead);
  if (!options.quiet && !options.common.jsonDiagnostics)
    fmt::print(stderr,
               "{}: {:.2f} MiB; PTX {} kB for {} and newer, host code {} kB, scene {:.2f} MiB{}\n",
               options.output, double(bytes.size()) / (1 << 20), package.ptx.size() / 1000,
               options.common.compile.gpu, package.host.bytes.size() / 1000,
               double(package.scene.bytes.size()) / (1 << 20),
               package.scene.hasTrees() ? "" : " without trees");
}

int pack(const PackOptions &options) {
  Messages messages(options.common);
  try {
    packScene(options, messages);
  } catch (const Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addPackCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<PackOptions>();
  CLI::App *command = app.add_subcommand(packSummary.command, packSummary.text);
  command->add_option("SCENE", options->scene, "a scene file (JSON); - is standard input")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "the package, usually named .rtslpkg; - is standard output")
      ->required()
      ->type_name("PACKAGE");
  addSetOption(*command, options->overrides);
  addTreeOption(*command, options->tree);
  addMaxRegistersOption(*command, options->gpu);
  command->add_flag("-q,--quiet", options->quiet, "no summary");
  addProgramOptions(*command, options->common);
  command->footer("example:\n  rtslc pack examples/glass/scene.json -o glass.rtslpkg\n  rtsl-run "
                  "glass.rtslpkg -o glass.png --target=gpu");
  command->callback([options, &action] {
    if (options->common.compile.floatingPoint == FloatingPoint::Double)
      throw CLI::ValidationError(
          "--fp", "packages also run on GPUs and do not support double; give strict or fast");
    action = [options] { return pack(*options); };
  });
}

} // namespace rtsl::tool
