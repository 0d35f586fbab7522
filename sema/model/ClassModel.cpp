//===- ClassModel.cpp - who may define, read, write and call what ---------===//
#include "sema/model/ClassModel.h"

#include <algorithm>

namespace rtsl {

using S = typed::StateVariable;
using A = Ability;
using Payload = MethodModel::Payload;

//===----------------------------------------------------------------------===//
// The table
//===----------------------------------------------------------------------===//

/// The groups of StateVariables.def.
enum class Group : std::uint8_t {
  EveryRay,  // what every method that runs for a ray can read, in any class
  Placement, // the transforms and ids of the object that is hit
  Ray,
  Normals,
  TextureCoordinates,
  TextureDerivatives,
  SurfaceDerivatives,
  Footprint, // of the ray, where it hits
  Single,    // no group
};

static constexpr StateSet variablesOf(Group wanted) {
  StateSet set;
#define RTSL_STATE_VARIABLE(name, type, writer, need, group)                                       \
  if (Group::group == wanted)                                                                      \
    set = set | StateSet{S::name};
#include "language/StateVariables.def"
  return set;
}

static constexpr StateSet everyRay = variablesOf(Group::EveryRay);
static constexpr StateSet placement = variablesOf(Group::Placement);
static constexpr StateSet ray = variablesOf(Group::Ray);
static constexpr StateSet normals = variablesOf(Group::Normals);
static constexpr StateSet textureCoordinates = variablesOf(Group::TextureCoordinates);
static constexpr StateSet textureDerivatives = variablesOf(Group::TextureDerivatives);
static constexpr StateSet surfaceDerivatives = variablesOf(Group::SurfaceDerivatives);
static constexpr StateSet footprint = variablesOf(Group::Footprint);

static RootModel cameraModel() {
  const StateSet known =
      everyRay | StateSet{S::RayOrigin,   S::RayDirection, S::Epsilon, S::HitDistance,
                          S::ScreenCoord, S::LensCoord,    S::du,      S::dv};
  return {"rt_Camera",
          known | ray,
          {{"generateRay", known, {S::RayOrigin, S::RayDirection}, {A::Random}}},
          false};
}

static RootModel primitiveModel() {
  const StateSet bounds = {S::BoundMin, S::BoundMax};
  // Each method sees the results of the previous ones.
  const StateSet candidate = everyRay | placement | ray | bounds;
  const StateSet withNormals = candidate | StateSet{S::HitPoint} | normals;
  const StateSet withCoordinates = withNormals | textureCoordinates;
  const StateSet withDerivatives = withCoordinates | surfaceDerivatives | textureDerivatives;
  const StateSet sees = withDerivatives | StateSet{S::PDF};
  const AbilitySet ofAHit = {A::Random, A::ReadScratch, A::Spaces};
  return {
      "rt_Primitive",
      sees,
      {
          {"intersect", candidate, {}, ofAHit | AbilitySet{A::Hit, A::WriteScratch}},
          // Runs while the acceleration structure is built: there is no ray.
          {"computeBounds", bounds | StateSet{S::PrimitiveIndex}, bounds, {}},
          {"computeNormal", withNormals, normals, ofAHit},
          {"computeTextureCoordinates", withCoordinates, textureCoordinates, ofAHit},
          {"computeDerivatives", withDerivatives, surfaceDerivatives | textureDerivatives, ofAHit},
          // These two choose and weigh a point on the primitive: there is no hit that could
          // have left scratch values.
          {"generateSample", sees, {S::HitPoint, S::GeometricNormal, S::PDF}, {A::Random}},
          {"samplePDF", sees, {S::PDF}, {A::Random}},
      },
      true};
}

static RootModel textureModel() {
  const StateSet sees = everyRay | textureCoordinates | surfaceDerivatives | textureDerivatives |
                        footprint | StateSet{S::TextureColor,  S::FloatTextureValue, S::du, S::dv,
                                             S::ObjectToWorld, S::WorldToObject};
  return {"rt_Texture",
          sees,
          {{"lookup",
            sees,
            {S::TextureColor, S::FloatTextureValue},
            {A::Lookup, A::Random, A::Spaces, A::Derivatives}}},
          false};
}

static RootModel materialModel() {
  const StateSet sees = everyRay | placement | ray | normals | textureCoordinates |
                        surfaceDerivatives | footprint |
                        StateSet{S::HitPoint,
                                 S::LightDirection,
                                 S::LightDistance,
                                 S::LightColor,
                                 S::EmissionColor,
                                 S::BSDFSeed,
                                 S::PDF,
                                 S::SampleColor,
                                 S::BSDFValue,
                                 S::du,
                                 S::dv};
  const AbilitySet common = {A::Lookup, A::Random, A::ReadScratch, A::Spaces, A::Derivatives};
  // What the sampling methods are given and write: methods that call them write it, too.
  const StateSet sampling = {S::LightDirection, S::BSDFSeed, S::BSDFValue, S::PDF,
                             S::EmissionColor};
  return {"rt_Material",
          sees,
          {
              {"shade", sees, sampling | StateSet{S::SampleColor},
               common | AbilitySet{A::Trace, A::Illuminance, A::CallSampling}},
              {"BSDF", sees, {S::BSDFValue}, common},
              {"sampleBSDF", sees, {S::LightDirection, S::BSDFValue, S::PDF}, common},
              {"evaluatePDF", sees, {S::PDF}, common},
              {"emission", sees, {S::EmissionColor}, common},
              {"transmittance", sees, {S::SampleColor}, common},
              {"diffuseTransmittance", sees, {S::SampleColor}, common},
              {"closestHit", sees, sampling | StateSet{S::SampleColor},
               common | AbilitySet{A::Trace, A::Illuminance, A::CallSampling, A::CallColor},
               Payload::Required},
              {"anyHit", sees, {}, common | AbilitySet{A::AnyHit}, Payload::Required},
          },
          true};
}

static RootModel lightModel() {
  const StateSet sees = everyRay | normals |
                        StateSet{S::HitPoint, S::LightDirection, S::LightDistance, S::LightColor};
  return {"rt_Light",
          sees,
          {{"illumination",
            sees,
            {S::LightDirection, S::LightColor, S::LightDistance},
            {A::Lookup, A::Random}}},
          false};
}

static RootModel rayGenerationModel() {
  const StateSet sees =
      everyRay | StateSet{S::RayOrigin,   S::RayDirection, S::ScreenCoord, S::LensCoord,
                          S::SampleColor, S::ConeWidth,    S::ConeSpread};
  return {"rt_RayGeneration",
          sees,
          {{"generate",
            sees,
            {S::SampleColor, S::ConeWidth, S::ConeSpread},
            {A::Trace, A::Random, A::WriteBuffers}}},
          false};
}

static RootModel missModel() {
  const StateSet rayOnly =
      everyRay | StateSet{S::RayOrigin, S::RayDirection, S::InverseRayDirection};
  // Texture coordinates are set by `miss`: there is no surface.
  const StateSet sees = rayOnly | textureCoordinates | StateSet{S::SampleColor, S::PDF};
  const StateSet writes = textureCoordinates | StateSet{S::SampleColor};
  const AbilitySet abilities = {A::Trace, A::Lookup, A::Random};
  return {"rt_Miss",
          sees,
          {
              {"miss", sees, writes, abilities, Payload::None},
              {"miss", sees, writes, abilities | AbilitySet{A::CallColor}, Payload::Required},
              // These two choose a direction, with its radiance, and weigh one.
              {"sampleDirection",
               sees,
               writes | StateSet{S::RayDirection, S::PDF},
               {A::Lookup, A::Random}},
              {"directionPDF", sees, {S::PDF}, {A::Lookup, A::Random}},
          },
          false};
}

static RootModel selectorModel() {
  const StateSet sees = everyRay | StateSet{S::RayOrigin, S::RayDirection, S::InverseRayDirection,
                                            S::ObjectToWorld, S::WorldToObject};
  return {"rt_Selector", sees, {{"visit", sees, {}, {A::VisitChild, A::Random, A::Spaces}}}, false};
}

static RootModel exceptionModel() {
  const StateSet sees = {S::LaunchIndex, S::LaunchSize, S::Depth, S::SampleColor, S::ExceptionCode};
  return {"rt_Exception", sees, {{"exception", sees, {S::SampleColor}, {}}}, false};
}

const std::vector<RootModel> &rootModels() {
  static const std::vector<RootModel> models = {
      cameraModel(),        primitiveModel(), textureModel(),  materialModel(), lightModel(),
      rayGenerationModel(), missModel(),      selectorModel(), exceptionModel()};
  return models;
}

const RootModel &helperModel() {
  static const RootModel model = {typed::helperRoot, {}, {}, false};
  return model;
}

const MethodModel &constructorModel() {
  static const MethodModel model = {"constructor", {}, {}, {A::WriteMembers}, Payload::None};
  return model;
}

//===----------------------------------------------------------------------===//
// Queries
//===----------------------------------------------------------------------===//

const RootModel *rootModel(const std::string &name) {
  for (const RootModel &model : rootModels())
    if (model.name == name)
      return &model;
  return nullptr;
}

std::optional<Ability> abilityNeeded(const std::string &builtin) {
  static const std::map<std::string, Ability> needed = {
#define RTSL_BUILTIN(id, name, effect, cost, where, ...) {name, Ability::where},
#include "language/Builtins.def"
  };
  const auto found = needed.find(builtin);
  if (found == needed.end() || found->second == Ability::Anywhere)
    return std::nullopt;
  return found->second;
}

std::optional<Ability> MethodModel::calledBy() const {
  if (name == "BSDF" || name == "sampleBSDF" || name == "evaluatePDF" || name == "emission" ||
      name == "transmittance" || name == "diffuseTransmittance")
    return A::CallSampling;
  if (payload == Payload::None && (name == "shade" || name == "miss"))
    return A::CallColor;
  return std::nullopt;
}

std::string MethodModel::signature() const {
  return "void " + name + (payload == Payload::Required ? "(inout P)" : "()");
}

const MethodModel *RootModel::method(const std::string &methodName) const {
  for (const MethodModel &candidate : methods)
    if (candidate.name == methodName)
      return &candidate;
  return nullptr;
}

const MethodModel *RootModel::method(const std::string &methodName, bool withPayload) const {
  for (const MethodModel &candidate : methods)
    if (candidate.name == methodName && (candidate.payload == Payload::Required) == withPayload)
      return &candidate;
  return method(methodName);
}

MethodModel unionOfMethods(const RootModel &root) {
  MethodModel all;
  all.name = root.name;
  all.reads = root.sees;
  for (const MethodModel &method : root.methods) {
    all.writes = all.writes | method.writes;
    all.abilities = all.abilities | method.abilities;
  }
  return all;
}

std::string withArticle(const std::string &noun) {
  // "rt_" is pronounced letter by letter: "are-tee".
  const bool vowel =
      noun.compare(0, 3, "rt_") == 0 ||
      (!noun.empty() && std::string("aeiouAEIOU").find(noun[0]) != std::string::npos);
  return (vowel ? "an " : "a ") + noun;
}

std::string joinWords(const std::vector<std::string> &words, const char *last) {
  std::string text;
  for (std::size_t i = 0; i != words.size(); ++i) {
    if (i != 0)
      text += i + 1 == words.size() ? " " + std::string(last) + " " : ", ";
    text += words[i];
  }
  return text;
}

std::string classesThatSee(typed::StateVariable variable) {
  std::vector<std::string> names;
  for (const RootModel &model : rootModels())
    if (model.sees.has(variable))
      names.push_back(model.name);
  return joinWords(names);
}

/// "`a` and `b` of an rt_X, `c` of an rt_Y" for the methods that `chosen` picks.
template <typename Predicate>
static std::string listMethods(const Predicate &chosen) {
  std::vector<std::string> groups;
  for (const RootModel &model : rootModels()) {
    std::vector<std::string> names;
    for (const MethodModel &method : model.methods) {
      const std::string quoted = "`" + method.name + "`";
      if (chosen(method) && std::find(names.begin(), names.end(), quoted) == names.end())
        names.push_back(quoted);
    }
    if (!names.empty())
      groups.push_back(joinWords(names) + " of " + withArticle(model.name));
  }
  return joinWords(groups);
}

std::string methodsThatWrite(typed::StateVariable variable) {
  return listMethods([&](const MethodModel &method) { return method.writes.has(variable); });
}

std::string methodsWith(Ability ability) {
  if (ability == Ability::WriteMembers)
    return "`constructor`";
  return listMethods([&](const MethodModel &method) { return method.abilities.has(ability); });
}

std::vector<std::string> classesWithMethod(const std::string &methodName) {
  std::vector<std::string> names;
  for (const RootModel &model : rootModels())
    if (model.method(methodName))
      names.push_back(model.name);
  return names;
}

bool findStateVariable(const std::string &name, typed::StateVariable &variable) {
  static const std::map<std::string, typed::StateVariable> all = {
#define RTSL_STATE_VARIABLE(name, type, ...) {#name, typed::StateVariable::name},
#include "language/StateVariables.def"
  };
  auto found = all.find(name);
  if (found == all.end())
    return false;
  variable = found->second;
  return true;
}

const Type *typeOf(typed::StateVariable variable, TypeContext &types) {
  static const char *const keywords[] = {
#define RTSL_STATE_VARIABLE(name, type, ...) #type,
#include "language/StateVariables.def"
  };
  const std::string keyword = keywords[static_cast<std::size_t>(variable)];
  return types.named(keyword == "uint3" ? "uvec3" : keyword);
}

const std::vector<std::string> &stateVariableNames() {
  static const std::vector<std::string> names = {
#define RTSL_STATE_VARIABLE(name, type, ...) "rt_" #name,
#include "language/StateVariables.def"
  };
  return names;
}

} // namespace rtsl
