//===- RenderReader.cpp - `render` of a scene file ------------------------===//
#include "scenefile/sections/RenderReader.h"

#include "scenefile/LibraryEngines.h"
#include "scenefile/json/Choices.h"
#include "scenefile/sections/SettingsReader.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace rtsl::scene {

using Kind = JsonValue::Kind;

/// When the shutter opens and closes.
static void readShutter(const JsonValue &value, SceneDescription &scene) {
  const std::vector<double> times = readNumbers(value, 2, "`shutter`");
  if (!(0 <= times[0] && times[0] <= times[1] && times[1] <= 1))
    throw Error(message::badShutter(), value.place());
  scene.shutter = {float(times[0]), float(times[1])};
}

/// How surfaces that shine are chosen to light a point.
constexpr Choice<runtime::LampChoice> lightSamplers[] = {{"auto", runtime::LampChoice::Automatic},
                                                         {"power", runtime::LampChoice::ByPower},
                                                         {"tree", runtime::LampChoice::ByTree}};

static void readEditable(const JsonValue &value, SceneDescription &scene) {
  expect(value, Kind::Array, "`editable`");
  for (const JsonValue &name : value.elements) {
    expect(name, Kind::String, "a name of `editable`");
    scene.editable.push_back({name.string, name.place()});
  }
}

/// Gives the value, if it is an engine of the library.
static const JsonValue *readEngine(const JsonValue &engine, SceneDescription &scene) {
  expect(engine, Kind::String, "`engine`");
  const std::vector<std::string> &ofLibrary = libraryEngines();
  const bool isOfLibrary =
      std::find(ofLibrary.begin(), ofLibrary.end(), engine.string) != ofLibrary.end();
  if (!isOfLibrary && engine.string != "classic" && engine.string != "programs") {
    Error error(message::noSuchEngine(engine.string, fmt::join(ofLibrary, "`, `")), engine.place());
    std::vector<std::string> all = ofLibrary;
    all.insert(all.end(), {"classic", "programs"});
    if (const std::string near = closestName(engine.string, all); !near.empty())
      error.fix(near);
    throw error;
  }
  if (engine.string != "classic")
    scene.render.engine = runtime::Engine::Programs;
  return isOfLibrary ? &engine : nullptr;
}

const JsonValue *readRender(const JsonValue &value, const JsonValue *rayGeneration,
                            SceneDescription &scene, ErrorCollector &errors) {
  expect(value, Kind::Object, "`render`");
  errors.attempt([&] {
    checkKeys(value,
              {"engine", "size", "spp", "depth", "seed", "sampler", "shutter", "lightSampler",
               "editable"},
              "`render`");
  });
  const JsonValue *libraryEngine = nullptr;
  if (const JsonValue *shutter = value.find("shutter"))
    errors.attempt([&] { readShutter(*shutter, scene); });
  if (const JsonValue *sampler = value.find("sampler"))
    errors.attempt([&] { scene.sampler = choose(*sampler, runtime::samplerNames, "`sampler`"); });
  if (const JsonValue *sampler = value.find("lightSampler"))
    errors.attempt([&] { scene.lampChoice = choose(*sampler, lightSamplers, "`lightSampler`"); });
  if (const JsonValue *editable = value.find("editable"))
    errors.attempt([&] { readEditable(*editable, scene); });
  if (const JsonValue *engine = value.find("engine"))
    errors.attempt([&] { libraryEngine = readEngine(*engine, scene); });
  readSettings(value, scene.render, scene, rayGeneration, errors);
  return libraryEngine;
}

} // namespace rtsl::scene
