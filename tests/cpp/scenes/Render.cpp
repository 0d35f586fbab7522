// Renders a scene file with shaders that were compiled to C++ ahead: cpp-render SHADERS.so
// SCENE.json PICTURE.exr. The picture is that of the last of its passes. What they print, what
// samples met, and the bytes of output buffers go to standard output as JSON.
#include "scenefile/SceneFile.h"

#include <rtsl/runtime.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <dlfcn.h>

using namespace rtsl;

int main(int argc, char **argv) try {
  if (argc != 4)
    return std::fprintf(stderr, "usage: %s SHADERS.so SCENE.json PICTURE.exr\n", argv[0]), 2;
  void *library = dlopen(argv[1], RTLD_NOW);
  auto *shaders =
      library ? reinterpret_cast<const RtslShaders *(*)()>(dlsym(library, "shaders_shaders"))
              : nullptr;
  if (!shaders)
    return std::fprintf(stderr, "%s\n", dlerror()), 1;
  const scene::SceneDescription description = scene::readSceneFile(argv[2]);
  runtime::Scene built = scene::buildScene(description, rtsl::program(shaders()));
  runtime::RenderStatistics statistics;
  const std::size_t launches = scene::launchCount(description);
  for (std::size_t i = 0; i < launches; ++i) {
    if (launches > 1)
      built.setRayGeneration(built.find(scene::nameOfPass(i)));
    scene::RenderSettings settings = scene::launchOf(description, i).render;
    if (launches > 1 && !settings.hasSamples)
      settings.samplesPerPixel = 1;
    const runtime::RenderOptions options = scene::renderOptions(settings);
    const runtime::Image picture = runtime::render(built, options, &statistics);
    if (i + 1 == launches)
      runtime::writeImage(argv[3], picture);
  }
  nlohmann::ordered_json said = {
      {"printed", runtime::takePrintLog().texts(built.program().prints)}};
  const char *names[RTSL_EXCEPTIONS] = {"", "stackOverflow", "badRay", "index"};
  for (unsigned i = 1; i < RTSL_EXCEPTIONS; ++i)
    if (statistics.exceptions[i])
      said["exceptions"][names[i]] = statistics.exceptions[i];
  for (const runtime::OutputBuffer &output : built.outputs())
    said["outputs"][output.member] =
        std::vector<std::uint8_t>(output.elements, output.elements + output.bytes);
  std::printf("%s\n", said.dump().c_str());
} catch (const Error &error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
