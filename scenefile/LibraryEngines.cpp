#include "scenefile/LibraryEngines.h"

#include <algorithm>

namespace rtsl::scene {

namespace {

/// A class of library/std/engines.
struct LibraryEngine {
  const char *name;
  const char *className;
  const char *limit;        // the member that limits the rays of a path; null: it is a view
  std::uint32_t beyond = 0; // rays that may follow the last one of a path, one after the other
};
constexpr LibraryEngine engines[] = {
    {"path", "PathTracer", "bounces"},       {"volume", "VolumeTracer", "bounces", 65},
    {"occlusion", "OcclusionView", nullptr}, {"normals", "NormalsView", nullptr},
    {"depth", "DepthView", nullptr},         {"id", "IdView", nullptr},
    {"albedo", "AlbedoView", nullptr},
};

// And of library/std/backgrounds.
const char *const backgroundClass = "UniformSky";
const char *const radianceOfBackground = "radiance";

ObjectDescription objectOf(const char *className, const Place &place) {
  ObjectDescription object;
  object.className = {className, place, true};
  object.place = place;
  return object;
}

void import(SceneDescription &scene, const std::string &module, const Place &place) {
  scene.imports.push_back({{module, place}, "", false});
}

/// Makes a background color an object that rays with a payload can meet.
void useBackgroundObject(SceneDescription &scene) {
  if (scene.background || !scene.backgroundColor)
    return;
  const Place where = scene.backgroundColor->place();
  import(scene, std::string("std.backgrounds.") + backgroundClass, where);
  scene.background = objectOf(backgroundClass, where);
  scene.background->members.push_back({{radianceOfBackground, where}, scene.backgroundColor});
  scene.backgroundColor = nullptr;
}

} // namespace

static std::vector<std::string> namesOfEngines(bool areViews) {
  std::vector<std::string> names;
  for (const LibraryEngine &engine : engines)
    if (!areViews || !engine.limit)
      names.emplace_back(engine.name);
  return names;
}

const std::vector<std::string> &libraryEngines() {
  static const std::vector<std::string> names = namesOfEngines(false);
  return names;
}

const std::vector<std::string> &libraryViews() {
  static const std::vector<std::string> names = namesOfEngines(true);
  return names;
}

void useLibraryEngine(SceneDescription &scene, const JsonValue &engine) {
  const LibraryEngine &chosen =
      *std::find_if(std::begin(engines), std::end(engines),
                    [&](const LibraryEngine &one) { return engine.string == one.name; });
  const Place place = engine.place();
  import(scene, std::string("std.engines.") + chosen.className, place);
  if (!scene.rayGeneration || scene.rayGeneration->className.text != chosen.className)
    scene.rayGeneration = objectOf(chosen.className, place);
  auto &members = scene.rayGeneration->members;
  const auto isLimit = [&](const auto &member) { return member.first.text == chosen.limit; };
  const JsonValue *depth = scene.root->find("render")->find("depth");
  if (chosen.limit && depth && std::none_of(members.begin(), members.end(), isLimit))
    members.push_back({{chosen.limit, depth->place()}, depth});
  scene.render.depth = std::min(scene.render.depth + chosen.beyond, runtime::maxRayDepth);
  useBackgroundObject(scene);
}

void useRayGeneration(SceneDescription &scene) {
  if (scene.rayGeneration &&
      std::any_of(std::begin(engines), std::end(engines), [&](const LibraryEngine &one) {
        return scene.rayGeneration->className.text == one.className;
      }))
    useBackgroundObject(scene);
}

} // namespace rtsl::scene
