//===- Launch.cpp - buffers, changes and renderings, for C ----------------===//
#include "runtime/c/Handle.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace runtime = rtsl::runtime;
using rtsl::c::guarded;

namespace {

runtime::RenderOptions optionsOf(const RtslRenderSettings &settings, bool wantsPicture) {
  runtime::RenderOptions options;
  options.width = settings.width;
  options.slices = std::max(settings.slices, 1u);
  const std::uint64_t rows = std::uint64_t(settings.height) * options.slices;
  options.height = rows > 0xffffffffu ? 0xffffffffu : std::uint32_t(rows); // which is refused
  options.samplesPerPixel = settings.samplesPerPixel;
  options.maxDepth = settings.maxDepth;
  options.seed = settings.seed;
  options.threads = settings.threads;
  options.wantsPicture = wantsPicture;
  return options;
}

RtslRenderFacts &lastRendering() {
  static thread_local RtslRenderFacts facts{};
  return facts;
}

bool areSame(const RtslRenderSettings &a, const RtslRenderSettings &b) {
  return std::memcmp(&a, &b, sizeof a) == 0; // all of them 32-bit numbers
}

/// Renders with the trees of the last rendering, which are updated to what has changed since.
runtime::Image render(const RtslScene *scene, const RtslRenderSettings *settings,
                      bool wantsPicture) {
  lastRendering() = {};
  if (!scene->mappedVertices.empty())
    throw rtsl::Error(rtsl::message::meshIsMapped(scene->mappedVertices.begin()->first));
  const RtslRenderSettings wanted = settings ? *settings : rtslRenderDefaults();
  if (scene->renderer && areSame(scene->settings, wanted) && scene->hadPicture == wantsPicture) {
    try {
      scene->renderer->update();
    } catch (...) { // its trees are in no known state
      scene->renderer.reset();
      throw;
    }
  } else {
    const runtime::RenderOptions options = optionsOf(wanted, wantsPicture);
    scene->renderer =
        scene->renderer ? std::make_unique<runtime::Renderer>(scene->scene, options,
                                                              scene->renderer->hostScene())
                        : std::make_unique<runtime::Renderer>(scene->scene, options,
                                                              std::exchange(scene->kept, nullptr));
    scene->settings = wanted;
    scene->hadPicture = wantsPicture;
  }
  runtime::RenderStatistics statistics;
  runtime::Image image = scene->renderer->render(&statistics);
  lastRendering() = {statistics.samples, statistics.samplesNotFinite,
                     statistics.pixelsWithoutSample, statistics.raysTooDeep, statistics.badRays};
  return image;
}

const runtime::Value::Words &bufferOf(const RtslScene *scene, RtslBufferNumber number) {
  if (number == 0 || number > scene->buffers.size())
    throw rtsl::Error(rtsl::message::noSuchMemory(number));
  return *scene->buffers[number - 1];
}

} // namespace

void RtslScene::stopRendering() {
  if (!renderer)
    return;
  kept = renderer->takeTrees();
  renderer.reset();
}

extern "C" {

//===----------------------------------------------------------------------===//
// Buffers
//===----------------------------------------------------------------------===//

RtslBufferNumber rtslSceneAddBuffer(RtslScene *scene, size_t words) {
  return guarded<RtslBufferNumber>(0, {{scene, "scene"}}, [&] {
    try {
      scene->buffers.push_back(std::make_shared<runtime::Value::Words>(words));
    } catch (const std::bad_alloc &) {
      throw rtsl::Error(rtsl::message::bufferTooLarge(words));
    }
    return RtslBufferNumber(scene->buffers.size());
  });
}

int rtslMemberBuffer(RtslScene *scene, const char *member, RtslBufferNumber buffer,
                     const uint32_t *sizes, uint32_t dimensions) {
  return guarded(0, {{scene, "scene"}, {member, "member"}, {sizes, "sizes", dimensions}}, [&] {
    bufferOf(scene, buffer);
    if (dimensions < 1 || dimensions > 3)
      throw rtsl::Error(rtsl::message::bufferRank(dimensions));
    scene->members.push_back(
        {member, runtime::Value::block(scene->buffers[buffer - 1], {sizes, sizes + dimensions})});
    return 1;
  });
}

void *rtslMapBuffer(RtslScene *scene, RtslBufferNumber buffer) {
  return guarded<void *>(nullptr, {{scene, "scene"}}, [&]() -> void * {
    bufferOf(scene, buffer);
    return scene->buffers[buffer - 1]->data();
  });
}

int rtslUnmapBuffer(RtslScene *scene, RtslBufferNumber buffer) {
  return guarded(0, {{scene, "scene"}}, [&] {
    bufferOf(scene, buffer); // on this machine launches read and write it where it is
    return 1;
  });
}

//===----------------------------------------------------------------------===//
// Changes
//===----------------------------------------------------------------------===//

int rtslSetMember(RtslScene *scene, RtslObject object, const char *member, const double *numbers,
                  size_t count) {
  return guarded(0, {{scene, "scene"}, {member, "member"}, {numbers, "numbers", count}}, [&] {
    scene->scene.setMember(object, {member, rtsl::c::valueOf(numbers, count)});
    return 1;
  });
}

int rtslSetMemberObject(RtslScene *scene, RtslObject object, const char *member, RtslObject value) {
  return guarded(0, {{scene, "scene"}, {member, "member"}}, [&] {
    scene->scene.setMember(object, {member, runtime::Value::reference(value)});
    return 1;
  });
}

float *rtslMapVertices(RtslScene *scene, int32_t mesh) {
  return guarded<float *>(nullptr, {{scene, "scene"}}, [&] {
    const std::vector<float> &positions = scene->scene.positions(std::uint32_t(mesh));
    return scene->mappedVertices.try_emplace(std::uint32_t(mesh), positions).first->second.data();
  });
}

int rtslUnmapVertices(RtslScene *scene, int32_t mesh) {
  return guarded(0, {{scene, "scene"}}, [&] {
    const auto mapped = scene->mappedVertices.find(std::uint32_t(mesh));
    if (mapped == scene->mappedVertices.end())
      throw rtsl::Error(rtsl::message::noSuchMesh(mesh));
    std::vector<float> positions = std::move(mapped->second);
    scene->mappedVertices.erase(mapped);
    scene->scene.moveMesh(std::uint32_t(mesh), std::move(positions));
    return 1;
  });
}

//===----------------------------------------------------------------------===//
// Renderings
//===----------------------------------------------------------------------===//

RtslRenderSettings rtslRenderDefaults(void) {
  const runtime::RenderOptions defaults;
  return {defaults.width, defaults.height,  defaults.samplesPerPixel, defaults.maxDepth,
          defaults.seed,  defaults.threads, defaults.slices};
}

uint32_t rtslSceneChannels(const RtslScene *scene) {
  return guarded<std::uint32_t>(0, {{scene, "scene"}},
                                [&] { return scene->scene.program().colorComponents; });
}

int rtslRender(const RtslScene *scene, const RtslRenderSettings *settings, float *pixels) {
  return guarded(0, {{scene, "scene"}, {pixels, "pixels"}}, [&] {
    const runtime::Image image = render(scene, settings, true);
    std::copy(image.pixels.begin(), image.pixels.end(), pixels);
    return 1;
  });
}

int rtslLaunch(const RtslScene *scene, const RtslRenderSettings *settings) {
  return guarded(0, {{scene, "scene"}}, [&] {
    render(scene, settings, false);
    return 1;
  });
}

int rtslRenderToFile(const RtslScene *scene, const RtslRenderSettings *settings, const char *path) {
  return guarded(0, {{scene, "scene"}, {path, "path"}}, [&] {
    runtime::checkWritable(path);
    runtime::writeImage(path, render(scene, settings, true));
    return 1;
  });
}

RtslRenderFacts rtslLastRendering(void) {
  return lastRendering();
}

int rtslTakePrinted(const RtslScene *scene, void (*take)(const char *line, void *context),
                    void *context) {
  return guarded(0, {{scene, "scene"}, {reinterpret_cast<const void *>(take), "take"}}, [&] {
    for (const std::string &line : runtime::takePrintLog().texts(scene->scene.program().prints))
      take(line.c_str(), context);
    return 1;
  });
}

} // extern "C"
