//===- SceneFile.cpp - scenes of scene files, for C -----------------------===//
#include "runtime/c/SceneFile.h"
#include "runtime/c/Handle.h"
#include "scenefile/LaunchSizes.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace runtime = rtsl::runtime;
namespace scene = rtsl::scene;
using rtsl::c::guarded;

namespace rtsl::c {

Error inLines(const Error &error) {
  std::string lines;
  const auto add = [&](const Error &one) {
    const bool hasLine = one.place && one.place->line != 0;
    lines += lines.empty() ? "" : "\n";
    lines += hasLine ? fmt::format("{}:{}:{}: {}", one.place->file, one.place->line,
                                   one.place->column, one.what())
                     : one.what();
  };
  add(error);
  for (const Error &further : error.further)
    add(further);
  return Error(Message{error.code, lines});
}

void requireLibraryClasses(const scene::SceneDescription &description,
                           const runtime::Program &program) {
  std::vector<std::string> missing;
  for (const std::string &name : scene::classesUsed(description))
    if (!program.find(name))
      for (const scene::ImportDescription &import : description.imports) {
        const std::string &module = import.name.text;
        if (import.path.empty() && module.substr(module.rfind('.') + 1) == name)
          missing.push_back(module);
      }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  if (!missing.empty())
    throw Error(message::libraryClassesMissing(fmt::join(missing, "`, `")));
}

} // namespace rtsl::c

namespace {

RtslRenderSettings settingsOf(const scene::RenderSettings &render) {
  return {render.width,
          render.height / render.slices,
          render.samplesPerPixel,
          render.depth,
          render.seed,
          0,
          render.slices};
}

scene::BufferMember findBuffer(const runtime::ClassInfo *one, const std::string &name) {
  if (one)
    for (const runtime::MemberInfo &member : one->members)
      if (member.name == name)
        return {member.type.bufferRank, member.type.elementSize};
  return {};
}

/// The scene of a file with these settings.
RtslScene load(const std::shared_ptr<const runtime::Program> &program, const std::string &file,
               const char *const *settings, std::size_t count) {
  try {
    scene::SceneDescription description =
        scene::readSceneFile(file, std::vector<std::string>(settings, settings + count));
    description.placesMeshes = false; // rtslMoveInstance
    rtsl::c::requireLibraryClasses(description, *program);
    scene::setLaunchSizes(description, [&](const std::string &name, const std::string &member) {
      return findBuffer(program->find(name), member);
    });
    RtslScene made(scene::buildScene(description, program));
    if (description.sampler)
      made.scene.setSampler(*description.sampler);
    made.file = file;
    made.program = program;
    made.hasShutter = description.shutter.has_value();
    const std::size_t launches = scene::launchCount(description);
    for (std::size_t i = 0; i < launches; ++i) {
      scene::RenderSettings render = scene::launchOf(description, i).render;
      if (launches > 1 && !render.hasSamples)
        render.samplesPerPixel = 1; // as for `rtslc run`: a pass need not make a picture
      made.passes.push_back(settingsOf(render));
    }
    made.ofFile = made.passes.front();
    return made;
  } catch (const rtsl::Error &error) {
    throw rtsl::c::inLines(error);
  }
}

} // namespace

extern "C" {

RtslScene *rtslSceneLoad(const RtslShaders *shaders, const char *file, const char *const *settings,
                         size_t count) {
  return guarded<RtslScene *>(nullptr, {{file, "file"}, {settings, "settings", count}}, [&] {
    if (!shaders)
      throw rtsl::Error(rtsl::message::noShaders());
    return new RtslScene(load(rtsl::program(shaders), file, settings, count));
  });
}

int rtslSceneReload(RtslScene *scene, const char *const *settings, size_t count) {
  return guarded(0, {{scene, "scene"}, {settings, "settings", count}}, [&] {
    if (scene->file.empty())
      throw rtsl::Error(rtsl::message::sceneHasNoFile());
    RtslScene next = load(scene->program, scene->file, settings, count);
    scene->stopRendering();
    next.kept = scene->kept;
    *scene = std::move(next);
    return 1;
  });
}

RtslRenderSettings rtslSceneSettings(const RtslScene *scene) {
  return guarded(rtslRenderDefaults(), {{scene, "scene"}}, [&] { return scene->ofFile; });
}

uint32_t rtslScenePasses(const RtslScene *scene) {
  return guarded<std::uint32_t>(0, {{scene, "scene"}},
                                [&] { return std::uint32_t(scene->passes.size()); });
}

int rtslSceneSetPass(RtslScene *scene, uint32_t pass) {
  return guarded(0, {{scene, "scene"}}, [&] {
    if (pass >= scene->passes.size())
      throw rtsl::Error(rtsl::message::noSuchPass(pass, scene->passes.size()));
    if (scene->passes.size() > 1)
      scene->scene.setRayGeneration(scene->scene.find(scene::nameOfPass(pass)));
    scene->ofFile = scene->passes[pass];
    return 1;
  });
}

RtslObject rtslSceneFind(const RtslScene *scene, const char *name) {
  return guarded<RtslObject>(0, {{scene, "scene"}, {name, "name"}}, [&] {
    const RtslRef found = scene->scene.find(name);
    if (found == 0)
      throw rtsl::Error(rtsl::message::noObjectNamed(name));
    return found;
  });
}

void *rtslSceneOutput(RtslScene *scene, const char *member, uint32_t sizes[3]) {
  return guarded<void *>(nullptr, {{scene, "scene"}, {member, "member"}, {sizes, "sizes"}},
                         [&]() -> void * {
                           for (const runtime::OutputBuffer &output : scene->scene.outputs()) {
                             if (output.member != member)
                               continue;
                             if (output.bytes == 0)
                               throw rtsl::Error(rtsl::message::outputIsEmpty(member));
                             std::fill_n(sizes, 3, 1u);
                             std::copy(output.sizes.begin(), output.sizes.end(), sizes);
                             return output.elements;
                           }
                           throw rtsl::Error(rtsl::message::noOutputMember(member));
                         });
}

} // extern "C"
