//===- World.cpp - a small scene that a random program runs in ------------===//
#include "World.h"

#include "Numbers.h"

#include "runtime/device/ray/Divisor.h"
#include "runtime/scene/MeshValues.h"
#include "runtime/scene/Objects.h"

#include <algorithm>
#include <cstring>

namespace rtsl::random {

using runtime::ClassInfo;
using runtime::MemberInfo;
using runtime::ValueType;

void World::addObjects(const std::vector<std::string> &classes, std::vector<RtslRef> *references) {
  for (const std::string &name : classes) {
    const ClassInfo *info = code.find(name);
    if (!info) // left out on the way to a smaller program
      continue;
    const std::uint32_t key =
        mix(program.seed, hashOf(name) + static_cast<std::uint32_t>(objects.size()));
    const auto reference = static_cast<RtslRef>(4 * used);
    used += (info->recordSize + 15) / 16 * 4;
    auto *record = reinterpret_cast<std::uint8_t *>(records.data()) + reference;
    std::memcpy(record, &info->id, 4);
    // An index of an empty buffer is always out of range, which primitives are not to show.
    mayBeEmpty = !program.raises || info->root == "rt_RayGeneration";
    RtslState state{};
    state.launch = &launch;
    if (info->initialize)
      info->initialize(&state, reference);
    for (const MemberInfo &member : info->members)
      if (member.isPublic &&
          (!member.hasDefault || key & 1 || member.type.bufferRank != 0)) // none is empty by chance
        fill(member, record + member.offset, mix(key, hashOf(member.name)));
    if (info->construct) {
      std::vector<std::uint32_t> arguments(info->parameterSize / 4 + 1);
      for (const MemberInfo &parameter : info->parameters)
        fill(parameter, reinterpret_cast<std::uint8_t *>(arguments.data()) + parameter.offset,
             mix(key, hashOf(parameter.name)));
      info->construct(&state, reference, arguments.data());
    }
    objects.push_back({reference, info});
    references->push_back(reference);
  }
}

/// What of a hit the methods of a class read, and those of objects that it may refer to.
std::uint32_t World::needsOf(const ClassInfo &info, std::set<const ClassInfo *> &seen) const {
  if (!seen.insert(&info).second)
    return 0;
  std::uint32_t needs = info.needs;
  for (const MemberInfo &member : info.members)
    if (member.type.kind == ValueType::Kind::Reference)
      for (const ClassInfo &other : code.classes)
        if (derivesFrom(other, member.type.className))
          needs |= needsOf(other, seen);
  return needs;
}

void World::describeMaterial(RtslInstance &instance, const ClassInfo &material) const {
  std::set<const ClassInfo *> seen;
  instance.needs |= code.needs & needsOf(material, seen);
  instance.anyHit = material.anyHit;
}

/// For the records of all objects, after what is used already.
std::size_t World::wordsOfRecords() const {
  std::size_t words = used;
  std::vector<std::string> all = {program.camera, program.miss, program.selector, program.exception,
                                  program.rayGeneration};
  for (const auto *names : {&program.helpers, &program.textures, &program.lights,
                            &program.primitives, &program.materials})
    all.insert(all.end(), names->begin(), names->end());
  for (const std::string &name : all)
    if (const ClassInfo *info = code.find(name))
      words += (info->recordSize + 15) / 16 * 4;
  return words + wordsOfImages();
}

/// Each primitive with each material in turn, and a mesh.
void World::addInstances() {
  if (primitives.empty() || materials.empty())
    return;
  const std::size_t count = std::max(primitives.size(), materials.size()) + 1;
  for (std::size_t i = 0; i != count; ++i) {
    RtslInstance instance{};
    instance.primitive = primitives[i % primitives.size()];
    instance.material = materials[i % materials.size()];
    addInstance(instance, 1 + static_cast<std::uint32_t>(i) % 2);
  }
  for (const Object &object : objects)
    if (std::find(program.meshMaterials.begin(), program.meshMaterials.end(), object.info->name) !=
        program.meshMaterials.end()) {
      RtslInstance instance{};
      instance.material = object.reference;
      instance.needs = program.seed % 2 == 0 ? RTSL_HAS_NO_BACKS : 0;
      addInstance(instance, mesh.triangleCount);
      break;
    }
}

/// What does not depend on the objects that it starts with.
void World::describeLaunch() {
  launch.meshes = &mesh;
  launch.meshCount = 1;
  launch.instances = instances.data();
  launch.instanceCount = static_cast<std::uint32_t>(instances.size());
  launch.lights = lights.data();
  launch.lightCount = static_cast<std::uint32_t>(lights.size());
  for (unsigned i = 0; i != RTSL_MAX_COLOR; ++i) {
    launch.backgroundColor[i] = 0.25f * static_cast<float>(i + 1);
    launch.ambient[i] = 0.125f * static_cast<float>(i + 3);
  }
  launch.colorComponents = code.colorComponents;
  device::setLaunchSize(launch, 5, 3, 1);
  launch.seed = program.seed;
}

World::World(const runtime::Program &code, const Program &program)
    : code(code), program(program), host{code.slots}, transforms(someTransforms()), treeItems(1),
      mesh(someMesh()) {
  records.resize(wordsOfRecords());
  launch.records = reinterpret_cast<std::uint8_t *>(records.data());

  std::vector<RtslRef> cameras, misses, selectors, exceptions, rayGenerations;
  addImages();
  addObjects(program.helpers, &others);
  addObjects(program.textures, &others);
  addObjects(program.lights, &lights);
  addObjects(program.primitives, &primitives);
  addObjects(program.materials, &materials);
  addObjects({program.camera}, &cameras);
  addObjects({program.miss}, &misses);
  addObjects({program.selector}, &selectors);
  addObjects({program.exception}, &exceptions);
  addObjects({program.rayGeneration}, &rayGenerations);
  filledBuffers = buffers;
  if (!selectors.empty())
    addSelections(selectors[0]);

  addInstances();
  launch.camera = cameras.empty() ? 0 : cameras[0];
  launch.background = misses.empty() ? 0 : misses[0];
  launch.exception = exceptions.empty() ? 0 : exceptions[0];
  launch.rayGeneration = rayGenerations.empty() ? 0 : rayGenerations[0];
  describeLaunch();
  addMotion();
  launch.transforms = transforms.data();
  launch.transformCount = static_cast<std::uint32_t>(transforms.size());
  launch.selections = selections.data();
  launch.selectionCount = static_cast<std::uint32_t>(selections.size());
  launch.boxes = boxes.data();
  launch.boxCount = static_cast<std::uint32_t>(boxes.size());
  makeTree();
  addEmitters();
  launch.needs = code.needs | featuresOfScene();
  launch.host = &host;
  listAttributes();
}

/// RTSL_HAS_*: everything, but directions of a background that cannot choose any.
std::uint32_t World::featuresOfScene() const {
  const bool isSampled = launch.background != 0 &&
                         runtime::hasMethod(classOf(launch.background), "sampleDirection") &&
                         runtime::hasMethod(classOf(launch.background), "directionPDF");
  return isSampled ? RTSL_HAS_ALL : RTSL_HAS_ALL & ~RTSL_HAS_SAMPLED_BACKGROUND;
}

void World::listAttributes() {
  attributes = runtime::attributesOf(code);
  launch.meshAttributes = attributes.data();
  launch.meshAttributeCount = static_cast<std::uint32_t>(attributes.size());
}

World::World(const runtime::Program &bound, const World &made)
    : code(bound), program(made.program), host{bound.slots}, instances(made.instances),
      mesh(made.mesh), launch(made.launch) {
  for (RtslInstance &instance : instances) {
    for (const Object &object : made.objects)
      if (object.reference == instance.material)
        describeMaterial(instance, *bound.find(object.info->name));
  }
  launch.instances = instances.data();
  launch.needs = bound.needs | made.featuresOfScene();
  launch.host = &host;
  listAttributes();
}

runtime::SceneFacts World::facts() const {
  runtime::SceneFacts facts;
  for (const Object &object : objects)
    facts.objects.push_back({object.info->name, launch.records + object.reference});
  facts.records = launch.records;
  facts.recordBytes = records.size() * sizeof(std::uint32_t);
  facts.hasBuffers = !buffers.empty();
  facts.instanceCount = instances.size();
  if (facts.instanceCount <= runtime::SceneFacts::mostInstances)
    facts.instances = instances;
  facts.needs = featuresOfScene();
  facts.emitters = emitters;
  facts.lightCount = launch.lightCount;
  facts.referenceChain = static_cast<std::uint32_t>(objects.size()); // no longer
  facts.ambient.assign(launch.ambient, launch.ambient + code.colorComponents);
  return facts;
}

std::vector<std::pair<std::string, std::string>> World::surfaces(const Program &program) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string &primitive : program.primitives)
    for (const std::string &material : program.materials)
      pairs.emplace_back(primitive, material);
  for (const std::string &material : program.meshMaterials)
    pairs.emplace_back("", material);
  return pairs;
}

} // namespace rtsl::random
