#include "runtime/embree/EmbreeScene.h"

#include "runtime/embree/EmbreeRay.h"
#include "runtime/embree/HostScene.h"
#include "runtime/program/ProgramHost.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <atomic>
#include <string>

namespace rtsl::runtime {

namespace {

using Implementation = EmbreeScene::Implementation;

void noteError(void *self, RTCError code, const char *text) {
  auto &implementation = *static_cast<Implementation *>(self);
  if (implementation.error == RTC_ERROR_NONE) {
    implementation.error = code;
    implementation.errorText = text ? text : "";
  }
}

std::uint64_t newNumber() {
  static std::atomic<std::uint64_t> scenes = 0;
  return ++scenes;
}

} // namespace

EmbreeScene::Implementation::~Implementation() {
  releaseLevels(world);
  for (const auto &space : spaces)
    releaseLevels(*space.second);
  if (device)
    rtcReleaseDevice(device);
}

EmbreeScene::EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads)
    : self(std::make_unique<Implementation>()) {
  self->number = newNumber();
  // With AVX-512 Embree orders the children of a node by instructions with a latency that a single
  // ray cannot hide: its code for AVX2 takes 0.92 to 0.98 of the time (Zen 5).
  std::string config = "max_isa=avx2";
  if (threads)
    config += fmt::format(",threads={}", threads);
  self->device = rtcNewDevice(config.c_str());
  if (!self->device) {
    const RTCError error = rtcGetDeviceError(nullptr);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(message::noMemoryForEmbree());
    throw Error(message::embreeDoesNotStart(int(error)));
  }
  rtcSetDeviceErrorFunction(self->device, noteError, self.get());

  self->setLaunch(scene.launch());
  self->contents = treeContents(self->launch);
  self->slots = &slots;
  self->world.scene = self.get();
  const RtslLaunch &launch = self->launch;
  const auto addPrimitives = [&](EmbreeSpace &space, std::uint32_t number) {
    auto *const intersect = intersectOf(scene, slots, launch.instances[number].primitive);
    for (std::uint32_t i = 0; i < scene.primitiveCount(number); ++i)
      space.primitives.push_back({intersect, number, i});
  };
  // Blocks hold vertices, so triangles that move are items of their own.
  const auto addMesh = [&](EmbreeSpace &space, std::uint32_t number, std::uint32_t asInstance) {
    const RtslMesh &mesh = launch.meshes[launch.instances[number].mesh];
    if (!mesh.keyTimes) {
      space.meshes.push_back({asInstance, &mesh});
      return;
    }
    for (std::uint32_t i = 0; i < mesh.triangleCount; ++i)
      space.primitives.push_back({nullptr, number, i});
  };
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    const bool isMesh = instance.primitive == 0;
    if (device::hasOwnSpace(launch, instance)) {
      std::unique_ptr<EmbreeSpace> &inside = self->spaces[device::treeNumber(launch, instance)];
      if (!inside) {
        inside = std::make_unique<EmbreeSpace>();
        inside->scene = self.get();
        inside->isWorld = false;
        inside->moves = isMesh ? scene.movesOfMesh(instance.mesh) : 0;
        if (isMesh)
          addMesh(*inside, i, 0);
        else
          addPrimitives(*inside, i);
        buildSpace(*inside, threads);
      }
      self->world.instances.emplace_back(launch, i, inside.get());
    } else if (isMesh) {
      addMesh(self->world, i, i);
    } else {
      addPrimitives(self->world, i);
    }
  }
  buildSpace(self->world, threads);
}

void EmbreeScene::update(const Scene &scene, unsigned threads) {
  self->setLaunch(scene.launch());
  bool isNew = false;
  for (const auto &[number, space] : self->spaces)
    if (number < self->launch.meshCount && space->moves != scene.movesOfMesh(number)) {
      isNew |= updateSpace(*space, number, threads);
      space->moves = scene.movesOfMesh(number);
    }
  isNew |= updateSpace(self->world, 0, threads);
  if (isNew)
    self->number = newNumber(); // blocks that occluded a ray may be no more
}

/// In smaller trees, which the caches hold, the pauses cost more time than they save
/// (docs/benchmarks.md).
unsigned EmbreeScene::raysInTurns() const {
  constexpr std::size_t large = 96 << 20;
  std::size_t bytes = self->world.triangles.bytes();
  for (const auto &[number, space] : self->spaces)
    bytes += space->triangles.bytes();
  return bytes >= large ? 3 : 1;
}

void EmbreeScene::rememberBoxes() {
  self->world.boxes = boxesOf(self->world);
  for (const auto &[number, space] : self->spaces)
    space->boxes = boxesOf(*space);
}

bool EmbreeScene::follow(const Scene &scene, const Program::Slots &slots, unsigned threads) {
  self->setLaunch(scene.launch());
  self->slots = &slots;
  if (treeContents(self->launch) != self->contents)
    return false;
  for (const auto &[number, space] : self->spaces) {
    followSpace(*space, number, scene, slots, threads);
    space->moves = number < self->launch.meshCount ? scene.movesOfMesh(number) : 0;
  }
  followSpace(self->world, 0, scene, slots, threads);
  self->number = newNumber(); // blocks that occluded a ray may be no more, or elsewhere
  return true;
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::canFollow(const RtslState &state) {
  return isEasy(state) ||
         canFollow(device::load(state.RayOrigin), device::load(state.RayDirection));
}

bool EmbreeScene::canFollow(device::Vec3 origin, device::Vec3 direction) {
  const int exponent = device::exponentOf(device::largest(direction));
  return device::largest(origin) < largestOrigin && exponent >= -largestExponent &&
         exponent <= largestExponent;
}

std::uint32_t EmbreeScene::traverse(RtslState &state, std::uint32_t how) const {
  if (isEasy(state))
    return traverseEasy(state, how);
  ++rayCounters().rescaledRays;
  const int exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  return self->query(state, how, device::powerOfTwo(exponent));
}

void EmbreeScene::visit(RtslState &state, const device::TriangleRay &ray,
                        const EmbreeVisitor &visitor) const {
  int exponent = 0;
  if (!isEasy(state)) {
    ++rayCounters().rescaledRays;
    exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  }
  EmbreeContext context;
  rtcInitIntersectContext(&context.embree);
  context.state = &state;
  context.ray = &ray;
  context.space = &self->world;
  context.visitor = &visitor;
  context.seesAll = false;
  context.endsIfHidden = false;
  context.toEmbree = device::powerOfTwo(exponent);
  if (!self->world.list.isEmpty() && Implementation::searchList(context, false))
    return;
  if (!searchTriangles<device::TriangleRay>(context, false) && self->world.hasTree())
    Implementation::searchTree(context, false);
}

} // namespace rtsl::runtime
