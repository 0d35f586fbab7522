//===- Program.h - what programs by hand have in common -------------------===//
//
// Arguments, threads, and times, which go to standard output as JSON, named as `rtslc render
// --json` names them. Meshes and images go through the runtime, for they are not what is compared.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "Picture.h"

#include "runtime/image/Image.h"
#include "support/ProcessorTime.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace handwritten {

constexpr std::uint32_t tileSize = 16;

template <typename Sample>
void renderTile(const Picture &picture, std::uint32_t tile, rtsl::runtime::Image &image,
                Sample sample) {
  const std::uint32_t tilesAcross = (picture.width + tileSize - 1) / tileSize;
  const std::uint32_t left = tile % tilesAcross * tileSize, top = tile / tilesAcross * tileSize;
  const std::uint32_t right = std::min(left + tileSize, picture.width);
  const std::uint32_t bottom = std::min(top + tileSize, picture.height);
  for (std::uint32_t y = top; y < bottom; ++y)
    for (std::uint32_t x = left; x < right; ++x) {
      vec3 sum(0);
      for (std::uint32_t i = 0; i < picture.samplesPerPixel; ++i) {
        const vec3 color = sample(x, y, i);
        if (std::isfinite(color.x + color.y + color.z))
          sum += color;
      }
      float *pixel = image.at(x, y);
      for (int channel = 0; channel < 3; ++channel)
        pixel[channel] = sum[channel] / float(picture.samplesPerPixel);
    }
}

/// Threads take one tile after the other until none is left. sample(x, y, index) is a color.
template <typename Sample>
void render(const Picture &picture, unsigned threadCount, rtsl::runtime::Image &image,
            Sample sample) {
  const std::uint32_t tiles =
      ((picture.width + tileSize - 1) / tileSize) * ((picture.height + tileSize - 1) / tileSize);
  std::atomic<std::uint32_t> next{0};
  auto work = [&] {
    // As Embree's manual advises: denormals cost time and show nowhere.
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    for (std::uint32_t tile = next++; tile < tiles; tile = next++)
      renderTile(picture, tile, image, sample);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < threadCount; ++i)
    threads.emplace_back(work);
  work();
  for (std::thread &thread : threads)
    thread.join();
}

class Stopwatch {
public:
  /// Seconds since the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last, now)).count();
  }

private:
  std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();
};

inline void parseSize(const std::string &text, Picture &picture) {
  int used = 0;
  const bool isSize =
      std::sscanf(text.c_str(), "%5ux%5u%n", &picture.width, &picture.height, &used) == 2 &&
      std::size_t(used) == text.size();
  if (!isSize || !picture.width || !picture.height)
    throw CLI::ValidationError("--size", "give WIDTHxHEIGHT in pixels, such as 960x540");
}

/// What is special of a program.
struct Description {
  const char *name, *about;
  const char *inputs; // what files it takes
  const char *flags;  // of the compiler, for the code of `sample`
};

/// The whole program: read(paths) gives meshes, build(meshes) a pointer to a scene, and
/// sample(scene, picture, x, y, index) a color.
template <typename Read, typename Build, typename Sample>
int runProgram(const Description &description, int argc, char **argv, Read read, Build build,
               Sample sample) {
  CLI::App app(description.about);
  std::vector<std::string> inputs;
  std::string output;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  Picture picture;
  app.add_option("FILE", inputs, description.inputs)->required();
  app.add_option("-o,--output", output, "the picture: .png or .exr")->required();
  app.add_option("--spp", picture.samplesPerPixel, "samples a pixel")
      ->check(CLI::Range(1u, 1u << 24));
  app.add_option_function<std::string>(
         "--size", [&](const std::string &text) { parseSize(text, picture); }, "size in pixels")
      ->type_name("WxH");
  app.add_option("--threads", threads, "all cores if not given")->check(CLI::Range(1u, 4096u));
  app.add_option("--depth", picture.maxDepth, "0: camera rays only");
  app.add_option("--seed", picture.seed, "seed of the random numbers");
  CLI11_PARSE(app, argc, argv);

  try {
    rtsl::runtime::checkWritable(output);
    Stopwatch watch;
    auto meshes = read(inputs);
    const double sceneSeconds = watch.lap();
    const auto scene = build(std::move(meshes));
    const double buildSeconds = watch.lap();
    rtsl::runtime::Image image(picture.width, picture.height, 3);
    const double processorStart = rtsl::processorSeconds();
    render(picture, threads, image, [&](std::uint32_t x, std::uint32_t y, std::uint32_t index) {
      return sample(*scene, picture, x, y, index);
    });
    const double processorSeconds = rtsl::processorSeconds() - processorStart;
    const double renderSeconds = watch.lap();
    rtsl::runtime::writeImage(output, image);
    const nlohmann::ordered_json document = {
        {"version", 1},
        {"output", output},
        {"flags", description.flags},
        {"size", {picture.width, picture.height}},
        {"spp", picture.samplesPerPixel},
        {"seed", picture.seed},
        {"seconds",
         {{"scene", sceneSeconds},
          {"build", buildSeconds},
          {"render", renderSeconds},
          {"image", watch.lap()}}},
        {"processorSeconds", processorSeconds},
        {"samples", std::uint64_t(picture.width) * picture.height * picture.samplesPerPixel}};
    fmt::print("{}\n", document.dump(2));
    return 0;
  } catch (const std::exception &error) {
    fmt::print(stderr, "{}: {}\n", description.name, error.what());
    return 1;
  }
}

} // namespace handwritten
