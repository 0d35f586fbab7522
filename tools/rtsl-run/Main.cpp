//===- Main.cpp - rtsl-run, which renders packages ------------------------===//
//
// A program without a compiler in it: it renders what `rtslc pack` wrote, on a GPU or on the CPU.
// Exit status: 0 fine, 1 the package, the device or the picture is not as it must be, 2 wrong
// arguments, 3 a fault of rtsl-run or of the code in the package.
//
//===----------------------------------------------------------------------===//
#include "runtime/HostMegakernel.h"
#include "runtime/gpu/GpuRenderer.h"
#include "runtime/package/NativeCode.h"
#include "runtime/package/Package.h"
#include "tools/rtslc/PictureSize.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <map>
#include <new>
#include <optional>

using namespace rtsl;

namespace {

enum ExitStatus : int { Fine = 0, Refused = 1, Usage = 2, InternalError = 3 };
enum class Target : std::uint8_t { Gpu, Host };

struct Options {
  std::string package, output, reference;
  Target target = Target::Gpu;
  std::optional<std::uint32_t> samples, depth, seed;
  std::optional<tool::PictureSize> size;
  std::uint32_t threads = 0, registers = 0;
  bool quiet = false, json = false;
};

std::atomic<bool> interrupted{false};

runtime::RenderOptions renderOptions(const Options &options, const runtime::Package &package) {
  runtime::RenderOptions render = package.options;
  if (options.size) {
    render.width = options.size->width;
    render.height = options.size->height;
  }
  render.samplesPerPixel = options.samples.value_or(render.samplesPerPixel);
  render.maxDepth = options.depth.value_or(render.maxDepth);
  render.seed = options.seed.value_or(render.seed);
  render.threads = options.threads;
  render.cancel = &interrupted;
  return render;
}

void report(const Options &options, const runtime::Package &package, const runtime::RenderOptions &render,
            const runtime::RenderStatistics &statistics, const std::optional<runtime::GpuStatistics> &gpu) {
  const double rate = double(statistics.samples) / statistics.renderSeconds;
  if (options.json) {
    fmt::print("{{\"version\": 1, \"size\": [{}, {}], \"spp\": {}, \"seed\": {}, \"depth\": {},\n"
               " \"renderSeconds\": {}, \"samplesPerSecond\": {}, \"badRays\": {}, \"samplesNotFinite\": {},\n"
               " \"states\": {}, \"frameBytes\": {}, \"laneBytes\": {}",
               render.width, render.height, render.samplesPerPixel, render.seed, render.maxDepth,
               statistics.renderSeconds, rate, statistics.badRays, statistics.samplesNotFinite, package.stateCount,
               package.frameBytes, package.laneBytes[render.maxDepth]);
    if (gpu)
      fmt::print(",\n \"registers\": {}, \"localBytes\": {}, \"blocks\": {}, \"threadsPerBlock\": {},\n"
                 " \"loadSeconds\": {}, \"uploadSeconds\": {}",
                 gpu->registers, gpu->localBytes, gpu->blocks, gpu->threadsPerBlock, gpu->loadSeconds,
                 gpu->uploadSeconds);
    fmt::print("}}\n");
    return;
  }
  if (options.quiet)
    return;
  fmt::print(stderr, "{}: {}x{}, {} spp; rendered in {:.3f} s ({:.2f} million samples/s)\n", options.output,
             render.width, render.height, render.samplesPerPixel, statistics.renderSeconds, rate * 1e-6);
  if (gpu)
    fmt::print(stderr,
               "{}: {} registers and {} local bytes a thread, {} blocks of {} threads, {} bytes for the rays of "
               "each; code loaded in {:.0f} ms, scene in {:.0f} ms\n",
               gpu->device, gpu->registers, gpu->localBytes, gpu->blocks, gpu->threadsPerBlock, gpu->laneBytes,
               gpu->loadSeconds * 1e3, gpu->uploadSeconds * 1e3);
  if (statistics.samplesNotFinite)
    fmt::print(stderr, "{} samples were infinite or not a number, and count as black\n",
               statistics.samplesNotFinite);
  if (statistics.badRays)
    fmt::print(stderr, "{} rays had no direction or were not finite, and saw black\n", statistics.badRays);
}

/// Whether two pictures have the same bits; says so.
bool compare(const runtime::Image &image, const Options &options) {
  const runtime::Image reference = runtime::readImage(options.reference);
  if (image.width != reference.width || image.height != reference.height || image.channels != reference.channels) {
    fmt::print(stderr, "`{}` has {}x{} pixels of {} channels, not {}x{} of {}\n", options.reference,
               reference.width, reference.height, reference.channels, image.width, image.height, image.channels);
    return false;
  }
  std::size_t different = 0;
  const std::size_t channels = image.channels, count = image.pixels.size() / channels;
  for (std::size_t i = 0; i < count; ++i)
    different += std::memcmp(&image.pixels[i * channels], &reference.pixels[i * channels], 4 * channels) != 0;
  if (different == 0)
    fmt::print(stderr, "the bits of `{}`, all {} pixels\n", options.reference, count);
  else
    fmt::print(stderr, "{} of {} pixels differ from `{}`\n", different, count, options.reference);
  return different == 0;
}

int render(const Options &options) {
  runtime::checkWritable(options.output);
  const runtime::Package package = runtime::readPackage(options.package);
  const runtime::RenderOptions render = renderOptions(options, package);
  runtime::RenderStatistics statistics;
  std::optional<runtime::GpuStatistics> gpu;
  runtime::Image image;
  if (options.target == Target::Gpu) {
    image = runtime::renderOnGpu(package, render, options.registers, statistics, gpu.emplace());
  } else {
    const runtime::NativeCode code(package.host);
    image = runtime::renderOnHost(code.entries(), package.scene, render, &statistics);
  }
  runtime::writeImage(options.output, image);
  report(options, package, render, statistics, gpu);
  return options.reference.empty() || compare(image, options) ? Fine : Refused;
}

void addOptions(CLI::App &app, Options &options) {
  app.set_version_flag("--version", "rtsl-run " RTSL_VERSION);
  app.add_option("PACKAGE", options.package, "what `rtslc pack` wrote")->required();
  app.add_option("-o,--output", options.output, "the picture: .png or .exr")->required()->type_name("IMAGE");
  app.add_option("--target", options.target, "where to render: gpu, the first CUDA device; host, all cores")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Target>{{"gpu", Target::Gpu}, {"host", Target::Host}})
                      .description(""))
      ->type_name("gpu|host");
  app.add_option("--spp", options.samples, "samples a pixel")->check(CLI::Range(1u, 1u << 24))->type_name("N");
  tool::addSizeOption(app, options.size);
  app.add_option("--depth", options.depth, "how often a ray may lead to another; 0: camera rays only")
      ->type_name("N");
  app.add_option("--seed", options.seed, "seed of the random numbers")->type_name("N");
  app.add_option("--threads", options.threads, "threads of the host; all cores if not given")
      ->check(CLI::Range(1u, 4096u))
      ->type_name("N");
  app.add_option("--registers", options.registers, "let the GPU's driver use no more registers a thread than this")
      ->check(CLI::Range(16u, 255u))
      ->type_name("N");
  app.add_option("--compare", options.reference, "a picture that must have the same bits; exit status 1: it has not")
      ->type_name("IMAGE");
  app.add_flag("--json", options.json, "write times and counts to standard output as JSON");
  app.add_flag("-q,--quiet", options.quiet, "no summary");
  app.footer("example:\n  rtsl-run glass.rtslpkg -o glass.png --target=host --spp 64\n"
             "Exit status: 0 fine, 1 the package, the device or a file is not as it must be, 2 wrong arguments,\n"
             "3 a fault of the program.");
}

} // namespace

int main(int argc, char **argv) {
  CLI::App app("renders packages of rtslc, without the compiler", "rtsl-run");
  Options options;
  addOptions(app, options);
  std::signal(SIGINT, [](int) { interrupted = true; });
  try {
    app.parse(argc, argv);
    return render(options);
  } catch (const CLI::ParseError &error) {
    return app.exit(error) == 0 ? Fine : Usage;
  } catch (const runtime::Error &error) {
    fmt::print(stderr, "rtsl-run: {}\n", error.what());
    if (error.code == runtime::ErrorCode::NoDevice)
      fmt::print(stderr, "`--target=host` renders on the CPU\n");
    return error.code == runtime::ErrorCode::Internal ? InternalError : Refused;
  } catch (const std::bad_alloc &) {
    fmt::print(stderr, "rtsl-run: out of memory\n");
    return Refused;
  } catch (const std::exception &error) {
    fmt::print(stderr, "rtsl-run: {}\n", error.what());
  }
  return InternalError;
}
