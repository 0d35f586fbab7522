//===- Main.cpp - rtsl-run, which renders packages ------------------------===//
//
// A program without a compiler in it: it renders what `rtslc pack` wrote, on a GPU or on the CPU.
// Exit status: 0 fine, 1 the package, the device or the picture is not as it must be, or there is
// no memory or disk, 2 wrong arguments, 3 a fault of rtsl-run or of the code in the package; 130
// and 143 if SIGINT or SIGTERM stopped it.
//
//===----------------------------------------------------------------------===//
#include "runtime/buffers/BufferOutput.h"
#include "runtime/gpu/Gpus.h"
#include "runtime/package/NativeCode.h"
#include "runtime/package/Package.h"
#include "runtime/render/HostMegakernel.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"
#include "tools/common/BufferOptions.h"
#include "tools/common/GpuOptions.h"
#include "tools/common/Interruption.h"
#include "tools/common/OptionValues.h"
#include "tools/common/OutOfMemory.h"
#include "tools/common/Outcome.h"
#include "tools/common/Output.h"
#include "tools/common/PictureOptions.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstring>
#include <iostream>
#include <optional>
#include <sstream>

using namespace rtsl;

namespace {

enum ExitStatus : int { Fine = 0, Refused = 1, Usage = 2, InternalError = 3 };
enum class Target : std::uint8_t { Gpu, Host };

struct Options {
  std::string package, output, reference;
  std::vector<tool::BufferFile> inputs, outputs;
  Target target = Target::Gpu;
  std::optional<std::uint32_t> samples, depth, seed;
  std::optional<tool::PictureSize> size;
  std::optional<runtime::Window> crop;
  std::optional<runtime::TreeKind> tree;
  std::uint32_t threads = 0;
  tool::GpuOptions gpu;
  bool quiet = false, json = false;
  runtime::PictureFormat format = runtime::PictureFormat::ByName;
  runtime::ToneMapping tones;
};

runtime::RenderOptions renderOptions(const Options &options, const runtime::Package &package) {
  runtime::RenderOptions render = package.options;
  if (options.size)
    options.size->apply(render);
  render.crop = options.crop;
  if (options.output.empty() && !package.hasSamples) // a launch, as of rtslc run
    render.samplesPerPixel = 1;
  render.samplesPerPixel = options.samples.value_or(render.samplesPerPixel);
  render.maxDepth = options.depth.value_or(render.maxDepth);
  render.seed = options.seed.value_or(render.seed);
  render.threads = options.threads;
  render.tree = options.tree.value_or(runtime::TreeKind::Fast); // if the package has none
  render.cancel = tool::catchInterruptionsOfSamples();
  render.keepsUnfinished = true;
  render.wantsPicture = !options.output.empty();
  return render;
}

std::string notFiniteJson(const std::vector<runtime::SampleId> &samples) {
  std::string text;
  for (const runtime::SampleId &one : samples)
    text += fmt::format("{}{{\"pixel\": [{}, {}], \"sample\": {}}}", text.empty() ? "" : ", ",
                        one.x, one.y, one.sample);
  return "[" + text + "]";
}

/// The members of a JSON object, without brackets.
std::string gpuJson(const runtime::GpuStatistics &gpu) {
  std::string text =
      fmt::format("\"registers\": {}, \"localBytes\": {}, \"occupancy\": {}, \"blocks\": {}, "
                  "\"threadsPerBlock\": {}, \"loadSeconds\": {}, \"uploadSeconds\": {}",
                  gpu.registers, gpu.localBytes, gpu.occupancy, gpu.blocks, gpu.threadsPerBlock,
                  gpu.loadSeconds, gpu.uploadSeconds);
  if (gpu.spillStores)
    text +=
        fmt::format(", \"spillStores\": {}, \"spillLoads\": {}", *gpu.spillStores, *gpu.spillLoads);
  return text;
}

std::string toJson(const runtime::Package &package, const runtime::RenderOptions &render,
                   const runtime::RenderStatistics &statistics,
                   const std::vector<runtime::GpuStatistics> &gpus) {
  std::string text = fmt::format(
      "{{\"version\": 1, \"size\": [{}, {}], \"spp\": {}, \"seed\": {}, \"depth\": {},\n"
      " \"renderSeconds\": {}, \"samplesPerSecond\": {}, \"samples\": {}, \"pixels\": {}, "
      "\"badRays\": {},\n"
      " \"raysTooDeep\": {}, \"samplesNotFinite\": {}, \"pixelsWithoutSample\": {}, \"notFinite\": "
      "{},\n"
      " \"states\": {}, \"frameBytes\": {}, \"laneBytes\": {}",
      render.width, render.height, render.samplesPerPixel, render.seed, render.maxDepth,
      statistics.renderSeconds, double(statistics.samples) / statistics.renderSeconds,
      statistics.samples, statistics.pixels, statistics.badRays, statistics.raysTooDeep,
      statistics.samplesNotFinite, statistics.pixelsWithoutSample,
      notFiniteJson(statistics.notFinite), package.stateCount, package.frameBytes,
      package.laneBytes[render.maxDepth]);
  if (statistics.isUnfinished)
    text += fmt::format(",\n \"stoppedBy\": \"{}\"", tool::interruption());
  if (!gpus.empty())
    text += fmt::format(",\n {}, \"kernelSeconds\": {}", gpuJson(gpus.front()),
                        statistics.kernelSeconds);
  if (gpus.size() > 1) {
    text += ",\n \"gpus\": [";
    for (const runtime::GpuStatistics &gpu : gpus)
      text += fmt::format("{}{{\"samples\": {}, {}}}", &gpu == &gpus.front() ? "" : ",\n  ",
                          gpu.samples.value_or(0), gpuJson(gpu));
    text += "]";
  }
  if (const auto &tree = statistics.tree)
    text +=
        fmt::format(",\n \"tree\": {{\"kind\": \"{}\", \"seconds\": {}, \"nodes\": {}, "
                    "\"items\": {}, \"cost\": {}}}",
                    tool::nameOf(tree->kind), tree->seconds, tree->nodes, tree->items, tree->cost);
  return text + "}\n";
}

/// What makes the picture wrong although it was rendered; --quiet does not hide it.
void warn(const runtime::RenderOptions &render, const runtime::RenderStatistics &statistics,
          const std::string &unfinished) {
  if (!unfinished.empty())
    fmt::print(stderr, "{}\n", unfinished);
  if (statistics.samplesNotFinite) {
    fmt::print(stderr, "{}\n", tool::notFiniteText(statistics));
    for (const runtime::SampleId &one : statistics.notFinite)
      fmt::print(stderr, "  {}\n", tool::sampleText(one));
    fmt::print(stderr, "{}\n", message::notFiniteNeedsScene());
  }
  if (statistics.raysTooDeep)
    fmt::print(stderr, "{}\n", tool::tooDeepText(statistics, render));
}

void report(const Options &options, const runtime::Package &package,
            const runtime::RenderOptions &render, const runtime::RenderStatistics &statistics,
            const std::vector<runtime::GpuStatistics> &gpus, const std::string &unfinished) {
  warn(render, statistics, unfinished);
  if (options.json)
    return tool::printOut(toJson(package, render, statistics, gpus));
  if (options.quiet)
    return;
  fmt::print(stderr, "{}: {}x{}, {} spp; rendered in {:.3f} s ({:.2f} million samples/s)\n",
             options.output == "-"    ? "standard output"
             : options.output.empty() ? options.package
                                      : options.output,
             render.width, render.height, render.samplesPerPixel, statistics.renderSeconds,
             double(statistics.samples) / statistics.renderSeconds * 1e-6);
  for (const runtime::GpuStatistics &gpu : gpus)
    fmt::print(stderr, "{}\n", tool::gpuText(gpu));
  if (statistics.tree)
    fmt::print(stderr, "{}\n", tool::treeText(*statistics.tree));
  if (const std::string text = tool::badRaysText(statistics); !text.empty())
    fmt::print(stderr, "{}\n", text);
}

/// The picture of --compare, read before time is spent on rendering; nothing without it.
std::optional<runtime::Image> readReference(const Options &options, const runtime::Package &package,
                                            const runtime::RenderOptions &render) {
  if (options.reference.empty())
    return std::nullopt;
  runtime::Image reference = runtime::readImage(options.reference);
  const std::uint32_t channels = package.scene.launch().colorComponents;
  const runtime::Window window = windowOf(render);
  if (reference.width != window.width() || reference.height != window.height() ||
      reference.channels != channels)
    throw Error(message::referencePictureDiffers(options.reference, reference.width,
                                                 reference.height, reference.channels,
                                                 window.width(), window.height(), channels));
  return reference;
}

/// Whether two pictures have the same bits; prints the result.
bool compare(const runtime::Image &image, const runtime::Image &reference, const Options &options) {
  std::size_t different = 0;
  const std::size_t channels = image.channels, count = image.pixels.size() / channels;
  for (std::size_t i = 0; i < count; ++i)
    different += std::memcmp(&image.pixels[i * channels], &reference.pixels[i * channels],
                             4 * channels) != 0;
  if (different == 0)
    fmt::print(stderr, "the same bits as `{}` in all {} pixels\n", options.reference, count);
  else
    fmt::print(stderr, "{} of {} pixels differ from `{}`\n", different, count, options.reference);
  return different == 0;
}

/// Rejects outputs that cannot be written, or that are inputs, before time is spent.
void checkOutputs(const Options &options) {
  std::vector<std::string> read{options.package};
  if (!options.reference.empty())
    read.push_back(options.reference);
  for (const tool::BufferFile &input : options.inputs)
    read.push_back(input.file);
  if (!options.output.empty()) {
    runtime::checkWritable(options.output, options.format);
    refuseToOverwrite(options.output, read);
  }
  for (const tool::BufferFile &output : options.outputs) {
    checkFileWritable(output.file);
    refuseToOverwrite(output.file, read);
  }
}

/// Reads the buffers of --in. The launch has the size of the one that gives it.
void readBuffers(const Options &options, runtime::LaunchBuffers &buffers,
                 runtime::RenderOptions &render) {
  for (const tool::BufferFile &input : options.inputs) {
    const runtime::PackageBuffer &buffer = buffers.find(input.name, "--in");
    buffers.read(buffer, input.file);
    if (!buffer.setsLaunchSize || options.size)
      continue;
    render.width = buffers.lengthOf(buffer);
    if (render.width == 0)
      throw Error(message::launchOfEmptyBuffer(input.file, input.name, runtime::mostLaunchIndices));
    render.height = render.slices = 1;
  }
  buffers.setSize(render);
}

/// What a rendering gives.
struct Result {
  runtime::Image image;
  runtime::RenderStatistics statistics;
  std::string unfinished; // why it is; empty: it is complete
};

/// A picture with several samples is rendered in passes: it is written at intervals, and all of it
/// has samples when it is stopped. Several GPUs would copy the sums of all pixels in each pass.
Result renderWith(runtime::Backend &backend, const Options &options,
                  const runtime::RenderOptions &render) {
  Result result;
  if (!render.wantsPicture || render.samplesPerPixel == 1 || options.gpu.count != 1) {
    result.image = backend.render(&result.statistics);
    if (result.statistics.isUnfinished)
      result.unfinished = tool::unfinishedText(result.statistics, render);
    return result;
  }
  runtime::PassOptions passes;
  if (options.output != "-")
    passes.picture = [&](const runtime::Image &image) {
      tool::writePictureSoFar(options.output, image, options.format, options.tones);
    };
  runtime::PartialRendering rendering;
  result.image = backend.renderInPasses(passes, nullptr, rendering, &result.statistics);
  if (rendering.state.samplesPerPixel < render.samplesPerPixel) {
    result.unfinished =
        tool::unfinishedPassesText(rendering.state, result.statistics, render, false);
    result.statistics.isUnfinished = true;
  }
  return result;
}

int render(const Options &options) {
  checkOutputs(options);
  runtime::Package package = runtime::readPackage(options.package);
  if (options.tree == runtime::TreeKind::Fast)
    package.scene.removeTrees();
  runtime::RenderOptions render = renderOptions(options, package);
  runtime::LaunchBuffers buffers(package.scene, package.buffers);
  for (const tool::BufferFile &output : options.outputs)
    buffers.find(output.name, "--out");
  readBuffers(options, buffers, render);
  const std::optional<runtime::Image> reference = readReference(options, package, render);
  std::vector<runtime::GpuStatistics> gpus;
  Result result;
  if (options.target == Target::Gpu) {
    runtime::Gpus devices(options.gpu.count);
    const runtime::GpuCode code = {
        package.ptx, package.laneBytes[render.maxDepth],
        options.gpu.maxRegisters ? options.gpu.maxRegisters : package.registers, package.wave};
    const std::unique_ptr<runtime::Backend> backend =
        devices.prepare(code, buffers.scene(), render);
    result = renderWith(*backend, options, render);
    gpus = devices.statistics();
  } else {
    const runtime::NativeCode code(package.host);
    runtime::HostMegakernel backend(code.entries(), buffers.scene(), render);
    result = renderWith(backend, options, render);
  }
  const auto &[image, statistics, unfinished] = result;
  if (statistics.samples == 0)
    throw Error(message::stoppedBeforeFirstSample());
  if (!options.output.empty())
    tool::writePicture(options.output, image, options.format, options.tones);
  if (!statistics.isUnfinished)
    for (const tool::BufferFile &output : options.outputs)
      runtime::writeBuffer(output.file, buffers.output(buffers.find(output.name, "--out")));
  report(options, package, render, statistics, gpus, unfinished);
  return !reference || compare(image, *reference, options) ? Fine : Refused;
}

void addOptions(CLI::App &app, Options &options) {
  app.set_version_flag("-V,--version", "rtsl-run " RTSL_VERSION);
  app.add_option("PACKAGE", options.package,
                 "a package written by `rtslc pack`; - is standard input")
      ->required();
  tool::addPictureOption(app, options.output, options.format)->required(false);
  tool::addToneOptions(app, options.tones);
  tool::addBufferOption(
      app, "--out", options.outputs,
      "write an output buffer: .npy, .csv, or the elements as they lie in memory");
  tool::addBufferOption(app, "--in", options.inputs,
                        "replace the elements of a buffer by those of a file");
  tool::addChoice(app, "--target", options.target,
                  tool::Choices<Target>{{"gpu", Target::Gpu}, {"host", Target::Host}},
                  "where to render: gpu, CUDA devices; host, all cores");
  tool::addWhole(app, "--spp", options.samples, 1, runtime::mostSamplesPerPixel,
                 "samples per pixel");
  tool::addTreeOption(app, options.tree);
  tool::addSizeOption(app, options.size);
  tool::addCropOption(app, options.crop);
  tool::addWhole(app, "--depth", options.depth, 0, runtime::maxRayDepth,
                 "limit of nested `trace` calls; 0: camera rays only");
  tool::addWhole(app, "--seed", options.seed, 0, 0xffffffff, "seed of the random numbers");
  tool::addWhole(app, "--threads", options.threads, 1, runtime::mostThreads,
                 "threads of the host; default: all cores");
  tool::addGpusOption(app, options.gpu);
  tool::addMaxRegistersOption(app, options.gpu);
  app.add_option("--compare", options.reference,
                 "a picture that must have the same bits; exit status 1 if it differs")
      ->type_name("IMAGE");
  app.add_flag("--json", options.json, "write times and counts to standard output as JSON");
  app.add_flag("-q,--quiet", options.quiet, "no summary");
  app.footer("example:\n  rtsl-run glass.rtslpkg -o glass.png --target=host --spp 64\n"
             "Exit status: 0 success, 1 an unusable package, device or file, or too little memory "
             "or disk space,\n"
             "2 wrong arguments, 3 an internal error; 130 after SIGINT (Ctrl-C), 143 after "
             "SIGTERM.");
  app.callback([&options, &app] {
    if (options.target != Target::Gpu)
      tool::rejectGpuOptions(app);
    if (options.output.empty() && options.outputs.empty())
      throw CLI::RequiredError("--output, a picture, or --out, a buffer,");
    if (options.output.empty() && !options.reference.empty())
      throw CLI::ValidationError("--compare", "there is no picture to compare without `-o`");
    if (!options.output.empty())
      tool::checkPictureName(options.output, options.format);
    tool::checkToneOptions(app, options.output, options.format);
    tool::checkOutputFiles(options.outputs, options.output);
    if (options.json && options.output == "-")
      throw CLI::ValidationError("--json", "standard output is the picture; give a file to `-o`");
  });
}

} // namespace

int main(int argc, char **argv) {
  CLI::App app("renders packages of rtslc, without the compiler", "rtsl-run");
  Options options;
  addOptions(app, options);
  tool::reportFileSizeLimit();
  tool::nameOutOfMemory("rtsl-run");
  try {
    int status = Fine;
    try {
      app.parse(argc, argv);
      status = tool::statusAfterInterruption(render(options));
    } catch (const CLI::ParseError &error) {
      std::ostringstream help;
      status = app.exit(error, help, std::cerr) == 0 ? Fine : Usage;
      tool::printOut(help.str());
    }
    return tool::finishOutput("rtsl-run") || status != Fine ? status : Refused;
  } catch (const Error &error) {
    fmt::print(stderr, "rtsl-run: {}\n", error.what());
    if (error.code == ErrorCode::NoDevice)
      fmt::print(stderr, "{}\n", message::hostNeedsNoDevice());
    return tool::statusAfterInterruption(error.code == ErrorCode::Internal ? InternalError
                                                                           : Refused);
  } catch (const std::exception &error) {
    if (tool::isOutOfMemory(error)) {
      tool::sayOutOfMemory("rtsl-run");
      return Refused;
    }
    fmt::print(stderr, "rtsl-run: {}\n", error.what());
  }
  return InternalError;
}
