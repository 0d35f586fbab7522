#include "scenefile/PathEngine.h"

#include <algorithm>

namespace rtsl::scene {

// The names of library/std that this file knows.
static const char *const rayGenerationClass = "PathTracer";
static const char *const rayGenerationModule = "std.engines.PathTracer";
static const char *const limitOfRays = "bounces";
static const char *const backgroundClass = "UniformSky";
static const char *const backgroundModule = "std.backgrounds.UniformSky";
static const char *const radianceOfBackground = "radiance";

static ObjectDescription objectOf(const char *className, const Place &place) {
  ObjectDescription object;
  object.className = {className, place};
  object.place = place;
  return object;
}

static void import(SceneDescription &scene, const char *module, const Place &place) {
  scene.imports.push_back({{module, place}, ""});
}

void usePathTracer(SceneDescription &scene) {
  const JsonValue &render = *scene.root->find("render"), &engine = *render.find("engine");
  import(scene, rayGenerationModule, engine.place());
  if (!scene.rayGeneration || scene.rayGeneration->className.text != rayGenerationClass)
    scene.rayGeneration = objectOf(rayGenerationClass, engine.place());
  auto &members = scene.rayGeneration->members;
  const bool isLimited = std::any_of(members.begin(), members.end(), [](const auto &member) {
    return member.first.text == limitOfRays;
  });
  if (const JsonValue *depth = render.find("depth"); depth && !isLimited)
    members.push_back({{limitOfRays, depth->place()}, depth});
  if (scene.background || !scene.backgroundColor)
    return;
  const Place place = scene.backgroundColor->place();
  import(scene, backgroundModule, place);
  scene.background = objectOf(backgroundClass, place);
  scene.background->members.push_back({{radianceOfBackground, place}, scene.backgroundColor});
  scene.backgroundColor = nullptr;
}

} // namespace rtsl::scene
