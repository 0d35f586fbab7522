#include "tools/rtslc/common/MaterialCheck.h"

#include "codegen/driver/sources/StandardLibrary.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/scene/Objects.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>

namespace rtsl::tool {

namespace {

using device::Vec3;

/// Directions that are drawn for each object, from both sides of a surface.
constexpr unsigned directions = 512;

/// How often a method wrote what it should not.
struct Faults {
  unsigned drawn = 0, negative = 0, notFinite = 0, withoutDensity = 0, otherLength = 0;
  float length = 1; // of one of these

  void add(const float *value, std::uint32_t components) {
    const float *end = value + components;
    notFinite += std::any_of(value, end, [](float one) { return !std::isfinite(one); });
    negative += std::any_of(value, end, [](float one) { return one < 0; });
  }
};

/// How far the length of a direction may be from 1.
constexpr float lengthTolerance = 1e-3f;

/// The faults by class and method.
using FaultsByMethod = std::map<std::pair<std::string, std::string>, Faults>;

/// A hit of a ray from a random direction with a surface in the plane z = 0.
RtslState randomHit(const RtslLaunch &launch, std::mt19937 &random, unsigned number) {
  std::uniform_real_distribution<float> uniform(0.0f, 0.9999999f);
  const float z = 2 * uniform(random) - 1, turn = 6.2831853f * uniform(random),
              sine = std::sqrt(std::max(1 - z * z, 0.0f));
  RtslState state{};
  state.launch = &launch;
  state.instance = state.primitive = RTSL_NO_HIT;
  state.randomKey[0] = number;
  state.HitDistance = 1;
  device::store(state.RayDirection, Vec3{sine * std::cos(turn), sine * std::sin(turn), z});
  device::store(state.RayOrigin, device::load(state.RayDirection) * -1.0f);
  device::store(state.GeometricNormal, Vec3{0, 0, 1});
  device::store(state.ShadingNormal, Vec3{0, 0, 1});
  device::store(state.dPdu, Vec3{1, 0, 0});
  device::store(state.dPdv, Vec3{0, 1, 0});
  for (float &one : state.TextureUV)
    one = uniform(random);
  for (float &one : state.BSDFSeed)
    one = uniform(random);
  return state;
}

void draw(const runtime::Scene &scene, RtslRef material, FaultsByMethod &found) {
  const runtime::Program &program = scene.program();
  const runtime::ClassInfo &info = scene.classOf(material);
  const RtslLaunch launch = scene.launch();
  const bool isDrawn = runtime::hasMethod(info, "sampleBSDF"),
             isEvaluated = runtime::hasMethod(info, "BSDF"),
             emits = runtime::hasMethod(info, "emission");
  Faults &ofDrawn = found[{info.name, "sampleBSDF"}], &ofValue = found[{info.name, "BSDF"}],
         &ofEmission = found[{info.name, "emission"}];
  std::mt19937 random(1);
  for (unsigned i = 0; i < directions; ++i) {
    RtslState state = randomHit(launch, random, i);
    if (emits) {
      program.slots.rt_Material_emission(&state, material);
      ++ofEmission.drawn;
      ofEmission.add(state.EmissionColor, program.colorComponents);
    }
    if (isDrawn) {
      program.slots.rt_Material_sampleBSDF(&state, material);
      ++ofDrawn.drawn;
      ofDrawn.add(state.BSDFValue, program.colorComponents);
      ofDrawn.notFinite += !std::isfinite(state.PDF);
      ofDrawn.withoutDensity +=
          state.PDF == 0 && std::any_of(state.BSDFValue, state.BSDFValue + program.colorComponents,
                                        [](float one) { return one > 0; });
      // Light that counts by the cosine, for which the direction has to have length 1.
      const Vec3 direction = device::load(state.LightDirection);
      const float length = std::sqrt(device::dot(direction, direction));
      if (state.PDF > 0 && std::isfinite(length) && std::abs(length - 1) > lengthTolerance) {
        ++ofDrawn.otherLength;
        ofDrawn.length = length;
      }
    } else { // any direction
      const RtslState other = randomHit(launch, random, i);
      device::store(state.LightDirection, device::load(other.RayDirection));
    }
    if (!isEvaluated || (isDrawn && state.PDF <= 0))
      continue;
    std::fill_n(state.BSDFValue, program.colorComponents, 0.0f);
    program.slots.rt_Material_BSDF(&state, material);
    ++ofValue.drawn;
    ofValue.add(state.BSDFValue, program.colorComponents);
  }
}

/// Draws directions of all materials, in the scene's program with SamplingSlots.def.
FaultsByMethod drawAll(const runtime::Scene &scene) {
  const RtslLaunch launch = scene.launch();
  std::set<RtslRef> materials;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i)
    materials.insert(launch.instances[i].material);
  FaultsByMethod found;
  for (const RtslRef material : materials)
    if (material && scene.classOf(material).root == "rt_Material")
      draw(scene, material, found);
  return found;
}

} // namespace

bool hasSurfaceMethods(const LinkRequest &request, const runtime::Program &program) {
  return request.engine != runtime::Engine::Classic &&
         std::any_of(program.classes.begin(), program.classes.end(), [](const auto &info) {
           return info.root == "rt_Material" &&
                  (runtime::hasMethod(info, "sampleBSDF") || runtime::hasMethod(info, "BSDF") ||
                   runtime::hasMethod(info, "emission"));
         });
}

bool drawsByAuthors(const LinkRequest &request, const typed::Module &module,
                    const SourceManager &sources) {
  return std::any_of(request.classes.begin(), request.classes.end(), [&](const auto &name) {
    const typed::Class *const used = module.findClass(name);
    const typed::Function *const drawn = used ? used->findMethod("sampleBSDF") : nullptr;
    return drawn && !isLibraryFile(sources.name(drawn->owner->range.file));
  });
}

std::vector<Warning> tryMaterials(runtime::Scene &scene, const typed::Module &module,
                                  const SourceManager &sources, LinkRequest request,
                                  CompileOptions compile) {
  request.isSampled = true;
  request.isOnlySampled = true;
  request.keep.add(ItemSet::ofMembers()); // the records of the objects stay as they are
  compile.target = Target::Host;
  compile.trace = TraceMode::Recurse;
  compile.optimization = 0;
  Diagnostics unheard(sources); // all of these have been reported already
  const auto program = compileProgram(module, request, compile, unheard,
                                      [&](const auto &) { return scene.facts(); });
  if (!program)
    return {};
  scene.useProgram(program);
  const FaultsByMethod found = drawAll(scene);

  std::vector<Warning> warnings;
  for (const auto &[name, faults] : found) {
    const auto &[className, method] = name;
    std::optional<Place> place;
    if (const auto known = request.places.find(className); known != request.places.end())
      place = Place{known->second.file, known->second.line, known->second.column};
    if (faults.negative)
      warnings.push_back(
          {message::methodNegative(method, className, faults.negative, faults.drawn), place});
    if (faults.notFinite)
      warnings.push_back(
          {message::methodNotFinite(method, className, faults.notFinite, faults.drawn), place});
    if (faults.withoutDensity)
      warnings.push_back(
          {message::sampleWithoutDensity(className, faults.withoutDensity, faults.drawn), place});
    if (faults.otherLength)
      warnings.push_back(
          {message::sampleOfOtherLength(className, faults.otherLength, faults.drawn, faults.length),
           place});
  }
  return warnings;
}

} // namespace rtsl::tool
