#include "runtime/scene/Scene.h"

#include "runtime/scene/Geometry.h"
#include "runtime/scene/Objects.h"
#include "runtime/scene/lights/CameraAndLights.h"
#include "runtime/scene/lights/Emitters.h"

#include <algorithm>
#include <optional>
#include <unordered_set>

namespace rtsl::runtime {

struct Scene::Implementation {
  explicit Implementation(std::shared_ptr<const Program> program) : objects(std::move(program)) {}

  Objects objects;
  Geometry geometry;
  CameraAndLights cameraAndLights;
  std::vector<Warning> warnings;
  LampChoice lampChoice = LampChoice::Automatic;
  std::optional<Emitters> emitters; // found with the first program that can, when all are there

  void fillEmitters(RtslLaunch &launch) {
    const Program &program = objects.program();
    if (!emitters && program.emittedPower && program.needs & RTSL_NEEDS_EMITTERS)
      emitters.emplace(objects, launch, lampChoice);
    if (emitters)
      emitters->fill(launch);
  }

  /// The current launch, complete or not.
  RtslLaunch launch() {
    RtslLaunch launch{};
    objects.fill(launch);
    geometry.fill(launch);
    cameraAndLights.fill(launch);
    return launch;
  }
};

Scene::Scene(std::shared_ptr<const Program> program)
    : self(std::make_unique<Implementation>(std::move(program))) {}
Scene::~Scene() = default;
Scene::Scene(Scene &&) noexcept = default;
Scene &Scene::operator=(Scene &&) noexcept = default;

const Program &Scene::program() const {
  return self->objects.program();
}

void Scene::useProgram(std::shared_ptr<const Program> program) {
  self->objects.useProgram(std::move(program));
  self->geometry.useProgram(self->objects);
}

const std::vector<Warning> &Scene::warnings() const {
  return self->warnings;
}
void Scene::addWarning(Warning warning) {
  self->warnings.push_back(std::move(warning));
}

//===----------------------------------------------------------------------===//
// Objects
//===----------------------------------------------------------------------===//

RtslRef Scene::addObject(const std::string &className, const ObjectValues &values,
                         const std::string &name) {
  return self->objects.add(className, values, name, [this] { return self->launch(); });
}

RtslRef Scene::addObject(const std::string &className, std::vector<Value> arguments,
                         const std::string &name) {
  ObjectValues values;
  values.constructor = std::move(arguments);
  return addObject(className, values, name);
}

const std::uint8_t *Scene::record(RtslRef object) const {
  return self->objects.record(object);
}
const ClassInfo &Scene::classOf(RtslRef object) const {
  return *self->objects.at(object).classInfo;
}
const std::string &Scene::nameOf(RtslRef object) const {
  return self->objects.at(object).name;
}

RtslRef Scene::find(const std::string &name) const {
  const std::vector<Objects::Object> &all = self->objects.all();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Objects::Object &one) { return one.name == name; });
  return found == all.end() ? 0 : found->reference;
}

std::size_t Scene::recordBytes() const {
  return self->objects.recordBytes();
}
std::vector<BufferPlace> Scene::buffers() const {
  return self->objects.buffers();
}

std::vector<OutputBuffer> Scene::outputs() const {
  const RtslRef rayGeneration = self->cameraAndLights.rayGenerationObject();
  return rayGeneration ? self->objects.outputs(rayGeneration) : std::vector<OutputBuffer>();
}

//===----------------------------------------------------------------------===//
// Geometry
//===----------------------------------------------------------------------===//

void Scene::setShutter(float open, float close) {
  self->geometry.setShutter(open, close);
}

std::uint32_t Scene::addPrimitive(RtslRef primitive, RtslRef material, const Placement &placement,
                                  std::uint32_t count) {
  self->emitters.reset();
  return self->geometry.addPrimitive(
      self->objects, primitive, material, placement, count, [this] { return self->launch(); },
      self->warnings);
}

std::uint32_t Scene::addSelector(RtslRef selector, std::uint32_t children,
                                 const MovingTransform &transform, std::uint32_t above) {
  return self->geometry.addSelector(self->objects, selector, children, transform, above);
}

std::uint32_t Scene::addMesh(Mesh mesh, const std::string &name, const Transform &applied) {
  return self->geometry.addMesh(std::move(mesh), name, applied);
}

std::uint32_t Scene::addMeshInstance(std::uint32_t mesh, RtslRef material,
                                     const Placement &placement) {
  self->emitters.reset();
  return self->geometry.addMeshInstance(self->objects, mesh, material, placement);
}

void Scene::setMember(RtslRef object, const NamedValue &value) {
  self->emitters.reset();
  const std::vector<std::uint8_t> before = self->objects.setMember(object, value);
  const bool isReference = value.value.kind == Value::Kind::Reference;
  try {
    if (classOf(object).root == "rt_Primitive")
      self->geometry.updatePrimitive(
          self->objects, object, [this] { return self->launch(); }, self->warnings);
    if (isReference)
      self->geometry.useProgram(self->objects);
    else if (self->objects.isConditionOfOpacity(object, value.name))
      self->geometry.updateNeeds(self->objects);
  } catch (...) {
    self->objects.setRecord(object, before);
    if (isReference)
      self->geometry.useProgram(self->objects);
    throw;
  }
}

void Scene::moveInstance(std::uint32_t instance, const MovingTransform &transform) {
  self->emitters.reset();
  self->geometry.moveInstance(instance, transform);
}
void Scene::moveMesh(std::uint32_t mesh, std::vector<float> positions, std::vector<float> normals) {
  self->emitters.reset();
  self->geometry.moveMesh(mesh, std::move(positions), std::move(normals));
}
const std::vector<float> &Scene::positions(std::uint32_t mesh) const {
  return self->geometry.positions(mesh);
}
std::uint64_t Scene::moves() const {
  return self->geometry.allMoves();
}
std::uint64_t Scene::movesOfMesh(std::uint32_t mesh) const {
  return self->geometry.movesOfMesh(mesh);
}
std::uint64_t Scene::structure() const {
  return self->geometry.structure();
}

const std::vector<MeshAttribute> &Scene::meshAttributes() const {
  return self->geometry.meshAttributes();
}
Bounds Scene::instanceBounds(std::uint32_t instance) const {
  return self->geometry.bounds(instance);
}
std::uint32_t Scene::primitiveCount(std::uint32_t instance) const {
  return self->geometry.primitiveCount(instance);
}
const std::string &Scene::instanceName(std::uint32_t instance) const {
  return self->geometry.name(instance);
}

//===----------------------------------------------------------------------===//
// Camera and lights
//===----------------------------------------------------------------------===//

void Scene::addAllOrNothing(const std::function<void()> &add) {
  const Objects::Extent objects = self->objects.extent();
  const Geometry::Extent geometry = self->geometry.extent();
  const CameraAndLights cameraAndLights = self->cameraAndLights;
  const std::size_t warnings = self->warnings.size();
  try {
    add();
  } catch (...) {
    self->emitters.reset();
    self->cameraAndLights = cameraAndLights;
    self->geometry.cutBack(geometry);
    self->objects.cutBack(objects);
    self->warnings.erase(self->warnings.begin() + std::ptrdiff_t(warnings), self->warnings.end());
    throw;
  }
}

void Scene::addLight(RtslRef light) {
  self->cameraAndLights.addLight(self->objects, light);
}
void Scene::setCamera(RtslRef camera) {
  self->cameraAndLights.setCamera(self->objects, camera);
}
void Scene::setRayGeneration(RtslRef rayGeneration) {
  self->cameraAndLights.setRayGeneration(self->objects, rayGeneration);
}
void Scene::setBackground(RtslRef miss) {
  self->cameraAndLights.setBackground(self->objects, miss);
}
void Scene::setLampChoice(LampChoice choice) {
  self->emitters.reset();
  self->lampChoice = choice;
}
void Scene::setSampler(Sampler sampler) {
  auto changed = std::make_shared<Program>(program());
  std::uint32_t &features = changed->slots.features;
  features = (features & ~RTSL_FEATURE_SAMPLERS) | featuresOf(sampler);
  useProgram(std::move(changed));
}
void Scene::setException(RtslRef exception) {
  self->cameraAndLights.setException(self->objects, exception);
}
void Scene::setBackgroundColor(const std::vector<float> &color) {
  self->cameraAndLights.setBackgroundColor(self->objects, color);
}
void Scene::setAmbient(const std::vector<float> &color) {
  self->cameraAndLights.setAmbient(self->objects, color);
}

//===----------------------------------------------------------------------===//
// The whole scene
//===----------------------------------------------------------------------===//

SceneFacts Scene::facts() const {
  std::vector<RtslRef> roots = self->cameraAndLights.all();
  for (const RtslInstance &instance : self->geometry.all())
    for (RtslRef root : {instance.primitive, instance.material})
      if (root != 0)
        roots.push_back(root);
  for (const RtslSelection &selection : self->geometry.allSelections())
    if (selection.selector != 0)
      roots.push_back(selection.selector);
  const std::vector<RtslRef> list = self->objects.reachedFrom(std::move(roots));
  const std::unordered_set<RtslRef> reached(list.begin(), list.end());
  SceneFacts facts;
  for (const Objects::Object &object : self->objects.all())
    if (reached.count(object.reference))
      facts.objects.push_back({object.classInfo->name, self->objects.record(object.reference)});
  RtslLaunch launch = self->launch();
  self->fillEmitters(launch);
  facts.records = launch.records;
  facts.recordBytes = self->objects.recordBytes();
  facts.hasBuffers = !self->objects.buffers().empty();
  facts.instanceCount = self->geometry.all().size();
  if (facts.instanceCount <= SceneFacts::mostInstances) {
    facts.instances = self->geometry.all();
    if (self->emitters)
      facts.emitters.emplace(launch.emitters, launch.emitters + launch.emitterCount);
  }
  facts.lightCount = self->cameraAndLights.lightCount();
  const float *const ambient = self->cameraAndLights.ambientLight();
  facts.ambient.assign(ambient, ambient + program().colorComponents);
  facts.needs = launch.needs & RTSL_HAS_ALL;
  facts.referenceChain = self->objects.referenceChain();
  return facts;
}

RtslLaunch Scene::launch() const {
  self->cameraAndLights.requireCamera(program().engine);
  RtslLaunch launch = self->launch();
  self->fillEmitters(launch);
  return launch;
}

} // namespace rtsl::runtime
