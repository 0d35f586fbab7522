#include "tests/unit/runtime/FakeProgram.h"

#include "runtime/device/ray/Sampler.h"
#include "runtime/device/ray/Vector.h"

#include <cmath>
#include <cstddef>

using namespace rtsl::device;
namespace test = rtsl::runtime::test;

namespace {

template <typename Record>
const Record &record(const RtslState *state, RtslRef object) {
  return *reinterpret_cast<const Record *>(state->launch->records + object);
}

std::uint32_t classOf(const RtslState *state, RtslRef object) {
  return *reinterpret_cast<const std::uint32_t *>(state->launch->records + object);
}

/// Of the primitive that the state is about.
Vec3 centerOf(const RtslState *state, const test::SphereRecord &sphere) {
  return load(sphere.center) + Vec3{1.1f, -0.6f, 0.4f} * float(state->PrimitiveIndex);
}

} // namespace

//===----------------------------------------------------------------------===//
// The slots, as a compiled program has them
//===----------------------------------------------------------------------===//

extern "C" {

void rtsl_rt_Camera_generateRay(RtslState *state, RtslRef object) {
  const auto &camera = record<test::CameraRecord>(state, object);
  Vec3 gaze = load(camera.gaze), up = load(camera.up), right = cross(gaze, up);
  right = right * (1.0f / std::sqrt(dot(right, right)));
  float aspect = float(state->LaunchSize[0]) / float(state->LaunchSize[1]);
  float s = (2 * state->ScreenCoord[0] - 1) * aspect, t = 2 * state->ScreenCoord[1] - 1;
  store(state->RayOrigin, load(camera.eye));
  store(state->RayDirection, gaze + right * s + up * t);
}

// r^2 - |f - (f.d) d|^2: the distance of the centre from the ray, without cancellation.
void rtsl_rt_Primitive_intersect(RtslState *state, RtslRef object) {
  if (classOf(state, object) != test::sphereId)
    return;
  const auto &sphere = record<test::SphereRecord>(state, object);
  Vec3 d = load(state->RayDirection), f = centerOf(state, sphere) - load(state->RayOrigin);
  float dd = dot(d, d), b = dot(f, d) / dd;
  Vec3 away = f - d * b;
  float h = sphere.radius * sphere.radius - dot(away, away);
  if (h < 0)
    return;
  float q = std::sqrt(h / dd);
  if (!rtsl_hit(state, b - q))
    rtsl_hit(state, b + q);
}

void rtsl_rt_Primitive_computeBounds(RtslState *state, RtslRef object) {
  if (classOf(state, object) == test::boxedId) {
    const auto &boxed = record<test::BoxedRecord>(state, object);
    store(state->BoundMin, load(boxed.lower));
    store(state->BoundMax, load(boxed.upper));
    return;
  }
  const auto &sphere = record<test::SphereRecord>(state, object);
  Vec3 r = {sphere.radius, sphere.radius, sphere.radius};
  store(state->BoundMin, centerOf(state, sphere) - r);
  store(state->BoundMax, centerOf(state, sphere) + r);
}

void rtsl_rt_Primitive_computeNormal(RtslState *state, RtslRef object) {
  const auto &sphere = record<test::SphereRecord>(state, object);
  store(state->GeometricNormal,
        (load(state->HitPoint) - centerOf(state, sphere)) * (1.0f / sphere.radius));
}

void rtsl_rt_Primitive_computeTextureCoordinates(RtslState *, RtslRef) {}
void rtsl_rt_Primitive_computeDerivatives(RtslState *, RtslRef) {}
void rtsl_rt_Primitive_rt_boundHitError(RtslState *, RtslRef) {}
void rtsl_rt_Primitive_rt_computeChanges(RtslState *, RtslRef) {}
void rtsl_rt_Texture_lookup(RtslState *, RtslRef) {}
void rtsl_rt_RayGeneration_generate(RtslState *state, RtslRef) {
  const float drawn[3] = {drawNumber(*state, 0), 3 * drawNumber(*state, 1), 0.1f};
  for (int i = 0; i < 3; ++i)
    state->SampleColor[i] = drawn[i] + float(state->LaunchIndex[0]) + 1e5f * float(i);
}
void rtsl_rt_Exception_exception(RtslState *, RtslRef) {}
void rtsl_rt_Selector_visit(RtslState *state, RtslRef) {
  const float sum = state->RayOrigin[0] + 0.7f * state->RayOrigin[1] + state->RayDirection[2];
  if (sum < 0.5f)
    rtsl_visit_child(state, 0);
  if (sum > -0.5f && rtsl_rand(state) < 0.75f)
    rtsl_visit_child(state, 1);
}

static void shadeLambert(RtslState *state, const test::LambertRecord &lambert) {
  Vec3 n = load(state->ShadingNormal);
  if (dot(n, load(state->RayDirection)) > 0)
    n = n * -1.0f;
  Vec3 p = load(state->HitPoint);
  for (int c = 0; c < 3; ++c)
    state->SampleColor[c] = lambert.albedo[c] * state->launch->ambient[c];
  for (std::uint32_t i = 0; i < state->launch->lightCount; ++i)
    if (rtsl_illuminance(state, i, p.x, p.y, p.z, n.x, n.y, n.z, 0)) {
      Vec3 l = load(state->LightDirection);
      float cosine = dot(n, l) / std::sqrt(dot(l, l));
      for (int c = 0; c < 3; ++c)
        state->SampleColor[c] += lambert.albedo[c] * state->LightColor[c] * cosine;
    }
}

static void shadeMirror(RtslState *state) {
  Vec3 n = load(state->ShadingNormal), d = load(state->RayDirection), p = load(state->HitPoint);
  Vec3 r = d - n * (2 * dot(n, d) / dot(n, n));
  rtsl_trace(state, p.x, p.y, p.z, r.x, r.y, r.z, state->SampleColor);
}

void rtsl_rt_Material_shade(RtslState *state, RtslRef object) {
  switch (classOf(state, object)) {
  case test::lambertId:
    return shadeLambert(state, record<test::LambertRecord>(state, object));
  case test::mirrorId:
    return shadeMirror(state);
  case test::noiseId:
    for (int c = 0; c < 3; ++c)
      state->SampleColor[c] = rtsl_rand(state);
    return;
  case test::normalId:
    for (int c = 0; c < 3; ++c)
      state->SampleColor[c] = state->GeometricNormal[c];
    return;
  }
}

void rtsl_rt_Light_illumination(RtslState *state, RtslRef object) {
  const auto &light = record<test::LightRecord>(state, object);
  Vec3 l = load(light.position) - load(state->HitPoint);
  store(state->LightDirection, l);
  state->LightDistance = 1;
  for (int c = 0; c < 3; ++c)
    state->LightColor[c] = light.intensity[c] / dot(l, l);
}

void rtsl_rt_Miss_miss(RtslState *state, RtslRef object) {
  const auto &sky = record<test::SkyRecord>(state, object);
  Vec3 d = load(state->RayDirection);
  float w = 0.5f + 0.5f * d.y / std::sqrt(dot(d, d));
  for (int c = 0; c < 3; ++c)
    state->SampleColor[c] = sky.low[c] * (1 - w) + sky.high[c] * w;
}

} // extern "C"

//===----------------------------------------------------------------------===//
// Its description
//===----------------------------------------------------------------------===//

namespace rtsl::runtime::test {

namespace {

ValueType floatType() {
  ValueType type;
  type.name = "float";
  return type;
}

ValueType vec3Type() {
  ValueType type;
  type.rows = 3;
  type.size = 12;
  type.name = "vec3";
  return type;
}

ValueType colorType() {
  ValueType type;
  type.kind = ValueType::Kind::Color;
  type.size = 12;
  type.name = "color";
  return type;
}

ValueType scalarType(ValueType::Kind kind, const char *name) {
  ValueType type;
  type.kind = kind;
  type.name = name;
  return type;
}

ValueType referenceType(const char *className) {
  ValueType type = scalarType(ValueType::Kind::Reference, className);
  type.className = className;
  return type;
}

ValueType matrixType() {
  ValueType type;
  type.rows = 3;
  type.columns = 2;
  type.size = 24;
  type.name = "mat2x3";
  return type;
}

ValueType arrayType() {
  ValueType type;
  type.arraySizes = {2, 3};
  type.size = 24;
  type.name = "float[2][3]";
  return type;
}

ValueType bufferType(std::uint8_t rank) {
  ValueType type = vec3Type();
  type.bufferRank = rank;
  type.size = sizeof(RtslBuffer);
  type.elementSize = 12;
  type.name = rank == 1 ? "vec3[]" : "vec3[][]";
  return type;
}

MemberInfo member(const char *name, ValueType type, std::size_t offset, bool hasDefault = false) {
  MemberInfo info;
  info.name = name;
  info.type = std::move(type);
  info.offset = std::uint32_t(offset);
  info.isPublic = true;
  info.hasDefault = hasDefault;
  return info;
}

ClassInfo describe(const char *name, const char *base, ClassId id, std::size_t size,
                   std::vector<MemberInfo> members, std::vector<std::string> methods) {
  ClassInfo info;
  info.name = name;
  info.base = info.root = base;
  info.id = id;
  info.recordSize = std::uint32_t(size);
  info.members = std::move(members);
  info.methods = std::move(methods);
  return info;
}

void constructSphere(RtslState *state, RtslRef object, const void *arguments) {
  auto &sphere = *reinterpret_cast<SphereRecord *>(state->launch->records + object);
  const float *values = static_cast<const float *>(arguments);
  store(sphere.center, load(values));
  sphere.radius = values[3];
}

void initializeLambert(RtslState *state, RtslRef object) {
  auto &lambert = *reinterpret_cast<LambertRecord *>(state->launch->records + object);
  store(lambert.albedo, {0.5f, 0.5f, 0.5f});
}

/// One member of each type that a scene can set.
ClassInfo everything() {
  ClassInfo info = describe(
      "Everything", "rt_Material", ClassId(100), 256,
      {member("f", floatType(), 4), member("i", scalarType(ValueType::Kind::Int, "int"), 8),
       member("u", scalarType(ValueType::Kind::UInt, "uint"), 12),
       member("b", scalarType(ValueType::Kind::Bool, "bool"), 16), member("v", vec3Type(), 20),
       member("m", matrixType(), 32), member("c", colorType(), 56), member("a", arrayType(), 68),
       member("buffer", bufferType(1), 92), member("grid", bufferType(2), 112),
       member("other", referenceType("rt_Material"), 132, true)},
      {"shade"});
  MemberInfo hidden = member("hidden", floatType(), 136);
  hidden.isPublic = false;
  info.members.push_back(hidden);
  return info;
}

} // namespace

std::shared_ptr<Program> fakeProgram() {
  auto program = std::make_shared<Program>();
  program->classes.push_back(describe("Camera", "rt_Camera", cameraId, sizeof(CameraRecord),
                                      {member("eye", vec3Type(), offsetof(CameraRecord, eye)),
                                       member("gaze", vec3Type(), offsetof(CameraRecord, gaze)),
                                       member("up", vec3Type(), offsetof(CameraRecord, up))},
                                      {"generateRay"}));
  ClassInfo sphere = describe("Sphere", "rt_Primitive", sphereId, sizeof(SphereRecord),
                              {member("center", vec3Type(), offsetof(SphereRecord, center)),
                               member("radius", floatType(), offsetof(SphereRecord, radius))},
                              {"constructor", "intersect", "computeBounds", "computeNormal"});
  sphere.hasConstructor = true;
  sphere.parameters = {member("center", vec3Type(), 0), member("radius", floatType(), 12)};
  sphere.parameterSize = 16;
  sphere.construct = constructSphere;
  program->classes.push_back(sphere);
  ClassInfo lambert =
      describe("Lambert", "rt_Material", lambertId, sizeof(LambertRecord),
               {member("albedo", colorType(), offsetof(LambertRecord, albedo), true)}, {"shade"});
  lambert.initialize = initializeLambert;
  program->classes.push_back(lambert);
  program->classes.push_back(describe("Mirror", "rt_Material", mirrorId, 4, {}, {"shade"}));
  program->classes.push_back(describe("Noise", "rt_Material", noiseId, 4, {}, {"shade"}));
  program->classes.push_back(describe("Normal", "rt_Material", normalId, 4, {}, {"shade"}));
  program->classes.push_back(
      describe("Light", "rt_Light", lightId, sizeof(LightRecord),
               {member("position", vec3Type(), offsetof(LightRecord, position)),
                member("intensity", colorType(), offsetof(LightRecord, intensity))},
               {"illumination"}));
  program->classes.push_back(describe("Sky", "rt_Miss", skyId, sizeof(SkyRecord),
                                      {member("low", colorType(), offsetof(SkyRecord, low)),
                                       member("high", colorType(), offsetof(SkyRecord, high))},
                                      {"miss"}));
  program->classes.back().members.back().isRequired = true;
  program->classes.push_back(describe("Boxed", "rt_Primitive", boxedId, sizeof(BoxedRecord),
                                      {member("lower", vec3Type(), offsetof(BoxedRecord, lower)),
                                       member("upper", vec3Type(), offsetof(BoxedRecord, upper))},
                                      {"intersect", "computeBounds"}));
  program->classes.push_back(describe("Chooser", "rt_Selector", chooserId, 4, {}, {"visit"}));
  program->classes.push_back(everything());
#define RTSL_SLOT(base, method) program->slots.base##_##method = rtsl_##base##_##method;
#include "language/Slots.def"
  program->sample = rtsl_sample;
  return program;
}

Value vector(double x, double y, double z) {
  return Value{x, y, z};
}

ObjectValues members(std::vector<NamedValue> values) {
  ObjectValues result;
  result.members = std::move(values);
  return result;
}

void setCameraAtOrigin(Scene &scene) {
  scene.setCamera(scene.addObject(
      "Camera",
      members({{"eye", vector(0, 0, 0)}, {"gaze", vector(0, 0, 1)}, {"up", vector(0, 1, 0)}})));
}

} // namespace rtsl::runtime::test
