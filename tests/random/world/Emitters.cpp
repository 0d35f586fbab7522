//===- Emitters.cpp - the surfaces of a world that shine ------------------===//
//
// Those that a scene would find, with chances made from the seed: how bright a surface really is
// does not matter to who chooses it. Every third world has a light tree.
//
//===----------------------------------------------------------------------===//
#include "Numbers.h"
#include "World.h"

#include "runtime/scene/Objects.h"
#include "runtime/scene/lights/LightTree.h"

#include <algorithm>

namespace rtsl::random {

const runtime::ClassInfo &World::classOf(RtslRef object) const {
  return *std::find_if(objects.begin(), objects.end(), [&](const Object &one) {
            return one.reference == object;
          })->info;
}

bool World::shines(const RtslInstance &instance) const {
  if (!runtime::hasMethod(classOf(instance.material), "emission"))
    return false;
  return instance.primitive == 0 ||
         (runtime::hasMethod(classOf(instance.primitive), "generateSample") &&
          runtime::hasMethod(classOf(instance.primitive), "samplePDF"));
}

/// 0: it is one primitive.
std::uint32_t World::partsOf(const RtslInstance &instance) const {
  return instance.primitive == 0 ? mesh.triangleCount : instance.boxCount;
}

/// Adds ascending chances to choose one of `count`, or one before it; that of some is 0.
static void addChances(std::uint32_t count, std::uint32_t key, std::vector<float> &chances) {
  std::uint32_t sum = 0;
  std::vector<std::uint32_t> sums;
  for (std::uint32_t i = 0; i != count; ++i)
    sums.push_back(sum += mix(key, i) % 4 + (i + 1 == count ? 1 : 0));
  for (const std::uint32_t one : sums)
    chances.push_back(static_cast<float>(one) / static_cast<float>(sum));
}

void World::addEmitters() {
  const std::uint32_t key = mix(program.seed, 0x656d6974u);
  for (const RtslInstance &instance : instances)
    if (shines(instance)) {
      RtslEmitter emitter{};
      emitter.instance = static_cast<std::uint32_t>(&instance - instances.data());
      emitter.firstPart = static_cast<std::uint32_t>(partChances.size());
      addChances(partsOf(instance), key + emitter.instance, partChances);
      emitters.push_back(emitter);
    }
  std::vector<float> chances;
  addChances(static_cast<std::uint32_t>(emitters.size()), key, chances);
  for (std::size_t i = 0; i != emitters.size(); ++i)
    emitters[i].chances = chances[i];
  if (!emitters.empty() && key % 3 == 0)
    addLightTree();
  launch.emitters = emitters.data();
  launch.emitterCount = static_cast<std::uint32_t>(emitters.size());
  launch.partChances = partChances.data();
  launch.partChanceCount = static_cast<std::uint32_t>(partChances.size());
}

/// A lamp with some box, and perhaps a normal.
static runtime::Lamp someLamp(std::uint32_t key, std::uint32_t emitter, std::uint32_t part) {
  runtime::Lamp lamp{};
  for (std::uint32_t axis = 0; axis != 3; ++axis) {
    lamp.lower[axis] = mix(key, axis) % 9 * 0.25 - 1;
    lamp.upper[axis] = lamp.lower[axis] + mix(key, axis + 3) % 5 * 0.25;
  }
  lamp.axis[2] = key % 3 == 0 ? 0 : key % 3 == 1 ? 1 : -1;
  lamp.isTwoSided = key / 3 % 2 == 0;
  lamp.power = 1 + key / 6 % 4;
  lamp.emitter = emitter;
  lamp.part = part;
  return lamp;
}

/// Some emitters with parts are divided into them.
void World::addLightTree() {
  std::vector<runtime::Lamp> lamps;
  for (std::uint32_t i = 0; i != emitters.size(); ++i) {
    const std::uint32_t key = mix(program.seed, 0x6c616d70u + i),
                        parts = partsOf(instances[emitters[i].instance]);
    emitters[i].firstLeaf = static_cast<std::uint32_t>(lightLeaves.size());
    emitters[i].isDivided = parts != 0 && key % 4 != 0;
    if (!emitters[i].isDivided)
      lamps.push_back(someLamp(key, i, RTSL_WHOLE_EMITTER));
    for (std::uint32_t part = 0; part != parts && emitters[i].isDivided; ++part)
      lamps.push_back(someLamp(mix(key, part), i, part));
    lightLeaves.resize(lamps.size(), RTSL_NO_LIGHT_LEAF);
  }
  lightNodes = runtime::buildLightTree(std::move(lamps));
  for (std::uint32_t i = 0; i != lightNodes.size(); ++i)
    if (lightNodes[i].part != RTSL_INNER_LIGHT_NODE) {
      const RtslEmitter &emitter = emitters[lightNodes[i].first];
      lightLeaves[emitter.firstLeaf + (emitter.isDivided ? lightNodes[i].part : 0)] = i;
    }
  launch.lightNodes = lightNodes.data();
  launch.lightNodeCount = static_cast<std::uint32_t>(lightNodes.size());
  launch.lightLeaves = lightLeaves.data();
  launch.lightLeafCount = static_cast<std::uint32_t>(lightLeaves.size());
}

} // namespace rtsl::random
