//===- World.cpp - a small scene that a random program runs in ------------===//
#include "World.h"

#include "runtime/device/organisations/SampleSums.h"
#include "runtime/device/traverse/AnyHit.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/program/PrintLog.h"
#include "runtime/scene/MeshValues.h"
#include "runtime/scene/Samplers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

using rtsl::runtime::ClassInfo;
using rtsl::runtime::MemberInfo;
using rtsl::runtime::ValueType;

//===----------------------------------------------------------------------===//
// What compiled programs need from the host
//===----------------------------------------------------------------------===//

/// All that was printed, as one number.
static std::uint32_t printed = 0;
// of the program that runs, each as a number that every path gives it
static std::vector<std::uint32_t> formats;
static std::uint32_t raysThatHit = 0;

static void note(std::uint32_t format, const std::uint32_t *words, std::size_t count) {
  auto add = [](std::uint32_t word) { printed = (printed ^ word) * 16777619u ^ printed >> 15; };
  add(format);
  for (std::size_t i = 0; i != count; ++i)
    add(words[i]);
}

extern "C" void rtsl_print(RtslState *, std::uint32_t format, const std::uint32_t *words,
                           std::uint32_t count) {
  note(formats.at(format), words, count);
}

static std::uint32_t hashOf(const std::string &text) {
  std::uint32_t h = 2166136261u;
  for (char c : text)
    h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
  return h;
}

static std::uint32_t hashOf(const rtsl::runtime::PrintFormat &format) {
  std::uint32_t sum = 0;
  for (const rtsl::runtime::PrintItem &item : format)
    sum = rtsl::random::mix(rtsl::random::mix(sum, hashOf(item.text)),
                            32 * static_cast<std::uint32_t>(item.kind) + item.words);
  return sum;
}

namespace rtsl::runtime {
/// `print` of shaders in C++, which have no numbers for their formats.
void print(RtslState *, const PrintFormat &format, const std::vector<std::uint32_t> &words) {
  note(hashOf(format), words.data(), words.size());
}
} // namespace rtsl::runtime

extern "C" std::uint32_t rtsl_traverse(RtslState *state, std::uint32_t how) {
  const auto &slots = static_cast<const rtsl::runtime::ProgramHost *>(state->launch->host)->slots;
  const std::uint32_t answer =
      how & RTSL_INVOKE_ANY_HIT
          ? rtsl::device::traverseAsking(*state, how, rtsl::runtime::FilledSlots{slots})
          : rtsl::device::traverseDevice(*state, how & RTSL_FIRST_HIT,
                                         rtsl::runtime::FilledSlots{slots});
  raysThatHit += answer == RTSL_HIT;
  return answer;
}

static constexpr std::uint64_t guardBytes = 64;
static std::uint8_t *stackMemory = nullptr;
static std::uint64_t stackBytes = 0;

/// Of the requested size; the memory after it is checked.
extern "C" void *rtsl_machine_stack(std::uint64_t bytes) {
  std::free(stackMemory);
  bytes = (bytes + 15) / 16 * 16;
  stackMemory =
      static_cast<std::uint8_t *>(std::aligned_alloc(64, (bytes + guardBytes + 63) / 64 * 64));
  std::memset(stackMemory, 0xa5, bytes + guardBytes);
  stackBytes = bytes;
  return stackMemory;
}

static void checkGuard() {
  for (std::uint64_t i = 0; stackMemory && i != guardBytes; ++i)
    if (stackMemory[stackBytes + i] != 0xa5) {
      std::fputs("a program wrote past the machine's stack\n", stderr);
      std::abort();
    }
}

namespace rtsl::random {

//===----------------------------------------------------------------------===//
// Values
//===----------------------------------------------------------------------===//

static std::uint32_t bitsOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

static std::uint32_t someFloat(std::uint32_t key) {
  static const std::uint32_t extremes[] = {0x7f800000u, 0xff800000u, 0x7fc00000u, 0x80000000u, 1u,
                                           0x00800000u, 0x7f7fffffu, 0x4b000001u, 0xcf000000u, 0u};
  if (key % 16 == 0)
    return extremes[(key >> 8) % 10];
  const float small = static_cast<float>(static_cast<std::int32_t>(key) >> 16);
  return bitsOf(small / static_cast<float>(1 << (key & 15)));
}

static std::uint32_t someInteger(std::uint32_t key) {
  static const std::uint32_t extremes[] = {0x80000000u, 0x7fffffffu, 0xffffffffu, 32u, 0u};
  if (key % 12 == 0)
    return extremes[(key >> 8) % 5];
  return (key >> 8) % 9 - (key & 1 ? 4u : 0u);
}

/// A number of a range of the generator, often one of its bounds.
static double someInside(const Range &range, std::uint32_t key) {
  const double low = std::isfinite(range.low)    ? range.low
                     : std::isfinite(range.high) ? range.high - 2
                                                 : 0,
               high = std::isfinite(range.high) ? range.high : low + 2;
  for (const double value : {key & 1 ? low : high, key & 2 ? high : low})
    if (range.contains(value))
      return value;
  const double middle = 0.5 * (low + high);
  return std::floor(middle) > low ? std::floor(middle) : middle; // a whole one for integers
}

void World::fillElement(const ValueType &type, const std::optional<Range> &range, std::uint8_t *to,
                        std::uint32_t key) {
  auto put = [&](unsigned word, std::uint32_t value) { std::memcpy(to + 4 * word, &value, 4); };
  const unsigned scalars = type.rows * type.columns;
  auto putFloat = [&](unsigned i) {
    const std::uint32_t bits = someFloat(mix(key, i));
    float value;
    std::memcpy(&value, &bits, 4);
    put(i, range && !range->contains(value) ? bitsOf(float(someInside(*range, bits))) : bits);
  };
  switch (type.kind) {
  case ValueType::Kind::Float:
    for (unsigned i = 0; i != scalars; ++i)
      putFloat(i);
    break;
  case ValueType::Kind::Color:
    for (unsigned i = 0; i != code.colorComponents; ++i)
      putFloat(i);
    break;
  case ValueType::Kind::Int:
  case ValueType::Kind::UInt:
    for (unsigned i = 0; i != scalars; ++i) {
      const std::uint32_t word = someInteger(mix(key, i));
      const double value =
          type.kind == ValueType::Kind::Int ? double(std::int32_t(word)) : double(word);
      put(i, range && !range->contains(value)
                 ? std::uint32_t(std::int32_t(someInside(*range, word)))
                 : word);
    }
    break;
  case ValueType::Kind::Bool:
    for (unsigned i = 0; i != scalars; ++i)
      put(i, mix(key, i) & 1);
    break;
  case ValueType::Kind::Reference:
    put(0, choose(type.className, key));
    break;
  case ValueType::Kind::Struct:
    for (const MemberInfo &field : type.fields)
      fill(field, to + field.offset, mix(key, hashOf(field.name)));
    break;
  }
}

void World::fill(const MemberInfo &member, std::uint8_t *to, std::uint32_t key) {
  const ValueType &type = member.type;
  if (type.bufferRank != 0) {
    RtslBuffer buffer{};
    std::size_t count = 1;
    for (unsigned i = 0; i != type.bufferRank; ++i) {
      buffer.size[i] = (key >> 4 * i) % 3 + (program.inRange || !mayBeEmpty ? 1 : 0);
      count *= buffer.size[i];
    }
    buffers.emplace_back(count * type.elementSize / 4 + 1);
    if (type.isOutput)
      outputs.push_back(&buffers.back());
    auto *elements = reinterpret_cast<std::uint8_t *>(buffers.back().data());
    for (std::size_t i = 0; i != count; ++i)
      fillElement(type, member.values, elements + i * type.elementSize,
                  mix(key, static_cast<std::uint32_t>(i)));
    const auto address = reinterpret_cast<std::uint64_t>(elements);
    buffer.addressLow = static_cast<std::uint32_t>(address);
    buffer.addressHigh = static_cast<std::uint32_t>(address >> 32);
    std::memcpy(to, &buffer, sizeof buffer);
    return;
  }
  std::uint32_t count = 1;
  for (std::uint32_t size : type.arraySizes)
    count *= size;
  for (std::uint32_t i = 0; i != count; ++i)
    fillElement(type, member.values, to + i * (type.size / count), mix(key, i));
}

bool World::derivesFrom(const ClassInfo &info, const std::string &base) const {
  for (const ClassInfo *at = &info; at; at = code.find(at->base))
    if (at->name == base || at->root == base)
      return true;
  return false;
}

RtslRef World::choose(const std::string &className, std::uint32_t key) const {
  std::vector<RtslRef> candidates;
  for (const Object &object : objects)
    if (derivesFrom(*object.info, className))
      candidates.push_back(object.reference);
  return candidates.empty() ? 0 : candidates[key % candidates.size()];
}

//===----------------------------------------------------------------------===//
// The scene
//===----------------------------------------------------------------------===//

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

static constexpr std::uint32_t imageCount = 3;

void World::addImages() {
  if (const ClassInfo *info = code.find("sampler2D"))
    for (std::uint32_t i = 0; i != imageCount; ++i)
      addImage(*info, i);
}

/// The members that a scene gives an image, as bytes of a record.
void World::addImage(const ClassInfo &info, std::uint32_t number) {
  const std::uint32_t key = mix(program.seed, number);
  runtime::Texels texels;
  texels.format = number == 0 ? runtime::TexelFormat::Float32 : runtime::TexelFormat::Srgb8;
  texels.width = 1 + key % 9;
  texels.height = number == 2 ? 1 : 1 + key / 9 % 7;
  std::vector<std::uint32_t> bytes(std::size_t(4) * texels.width * texels.height);
  for (std::uint32_t i = 0; i != bytes.size(); ++i)
    bytes[i] = number == 0 ? bitsOf(static_cast<float>(mix(key, i) % 512) / 256) : mix(key, i);
  texels = runtime::texelsOfBytes(bytes.data(), std::move(texels));
  runtime::addLevels(texels);
  runtime::Sampling sampling;
  sampling.filter = static_cast<runtime::Filter>(3 - number);
  sampling.wrap[0] = static_cast<runtime::Wrap>(key / 64 % 4);
  sampling.wrap[1] = static_cast<runtime::Wrap>(key / 256 % 4);
  sampling.anisotropy = 1 + key / 1024 % 5;

  const auto reference = static_cast<RtslRef>(4 * used);
  used += (info.recordSize + 15) / 16 * 4;
  auto *record = reinterpret_cast<std::uint8_t *>(records.data()) + reference;
  std::memcpy(record, &info.id, 4);
  RtslState state{};
  state.launch = &launch;
  if (info.initialize)
    info.initialize(&state, reference);
  for (const auto &[name, value, place] :
       runtime::samplerValues(std::move(texels), sampling, false, false).members)
    for (const MemberInfo &member : info.members)
      if (member.name == name && value.words)
        putBuffer(record + member.offset, *value.words);
      else if (member.name == name) {
        const auto whole = static_cast<std::int32_t>(value.number);
        std::memcpy(record + member.offset, &whole, 4);
      }
  objects.push_back({reference, &info});
}

/// A buffer of one dimension with these elements.
void World::putBuffer(std::uint8_t *to, const runtime::Words &words) {
  buffers.emplace_back(words.data(), words.data() + words.size());
  RtslBuffer buffer{};
  buffer.size[0] = static_cast<std::uint32_t>(words.size());
  const auto address = reinterpret_cast<std::uint64_t>(buffers.back().data());
  buffer.addressLow = static_cast<std::uint32_t>(address);
  buffer.addressHigh = static_cast<std::uint32_t>(address >> 32);
  std::memcpy(to, &buffer, sizeof buffer);
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
  if (const ClassInfo *info = code.find("sampler2D"))
    words += imageCount * ((info->recordSize + 15) / 16 * 4);
  return words;
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
  launch.needs = code.needs | RTSL_HAS_ALL;
  launch.host = &host;
  listAttributes();
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
  launch.needs = bound.needs | RTSL_HAS_ALL;
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
  facts.needs = RTSL_HAS_ALL;
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

bool World::hitSomething() const {
  return raysThatHit != 0;
}

//===----------------------------------------------------------------------===//
// Running
//===----------------------------------------------------------------------===//

/// Nothing was printed yet, no ray has hit anything, and nothing is written.
void World::begin() {
  printed = raysThatHit = 0;
  for (std::size_t i = 0; i != buffers.size(); ++i) // the addresses of their elements stay
    std::copy(filledBuffers[i].begin(), filledBuffers[i].end(), buffers[i].begin());
  formats.clear();
  for (const runtime::PrintFormat &format : code.prints)
    formats.push_back(hashOf(format));
}

static std::uint32_t wordOf(float component) {
  return std::isnan(component) ? 0x7fc00000u : bitsOf(component);
}

/// A state of a ray that hit something, with the bits of its variables made from a number.
static RtslState someState(const RtslLaunch &launch, RtslEvents &events, std::uint32_t key) {
  RtslState state{};
  state.launch = &launch;
  state.events = &events;
  state.randomKey[0] = key;
  auto fill = [&](auto *variable, std::size_t bytes) {
    for (std::size_t word = 0; word != bytes / 4; ++word) {
      const std::uint32_t bits = someFloat(key = mix(key, 17));
      std::memcpy(reinterpret_cast<std::uint8_t *>(variable) + 4 * word, &bits, 4);
    }
  };
#define RTSL_STATE_VARIABLE(name, type, ...) fill(&state.name, sizeof state.name);
#include "language/StateVariables.def"
  std::fill_n(state.attributes, RTSL_MAX_ATTRIBUTE_WORDS,
              1u); // true, 1 or nearly 0, wherever the compiler put which
  return state;
}

/// What has been counted since `status` was cleared.
void World::noteExceptions(std::vector<std::uint32_t> &words) {
  if (program.raises)
    for (const auto count : status.exceptions)
      words.push_back(static_cast<std::uint32_t>(count));
}

void World::sampleObjects(std::vector<std::uint32_t> &words) {
  using Method = void (*)(RtslState *, RtslRef);
  const auto &slots = code.slots;
  auto call = [&](Method method, RtslRef object, std::uint32_t number) {
    RtslEvents events{};
    RtslState state = someState(launch, events, mix(program.seed, number));
    if (method) // that no class has may be null, or do nothing
      method(&state, object);
    auto note = [&](const float *values, unsigned count) {
      for (unsigned i = 0; i != count; ++i)
        words.push_back(wordOf(values[i]));
    };
    note(state.BSDFValue, code.colorComponents);
    note(state.SampleColor, code.colorComponents);
    note(state.EmissionColor, code.colorComponents);
    for (const float *vector : {state.LightDirection, state.RayDirection, state.HitPoint,
                                state.GeometricNormal, state.BoundMin, state.BoundMax})
      note(vector, 3);
    note(&state.PDF, 1);
    words.push_back(printed);
    words.push_back(events.exception);
  };
  for (std::uint32_t number = 0; number != 2; ++number) {
    for (RtslRef material : materials)
      for (Method method : {slots.rt_Material_sampleBSDF, slots.rt_Material_BSDF,
                            slots.rt_Material_evaluatePDF, slots.rt_Material_emission})
        call(method, material, number);
    for (RtslRef primitive : primitives)
      for (Method method : {slots.rt_Primitive_generateSample, slots.rt_Primitive_samplePDF,
                            slots.rt_Primitive_computeBounds})
        call(method, primitive, number);
    if (launch.background != 0)
      for (Method method : {slots.rt_Miss_sampleDirection, slots.rt_Miss_directionPDF})
        call(method, launch.background, number);
  }
  for (const std::vector<std::uint32_t> *buffer : outputs)
    for (std::uint32_t word : *buffer) // not known to be a float: what would be a NaN is one
      words.push_back((word & 0x7fffffffu) > 0x7f800000u ? 0x7fc00000u : word);
}

/// The ranges that the classes of all objects state.
void World::noteRanges(std::vector<std::uint32_t> &words) const {
  for (const Object &object : objects)
    for (const auto *list : {&object.info->members, &object.info->parameters})
      for (const MemberInfo &member : *list)
        if (const auto &range = member.values) {
          for (const double bound : {range->low, range->high})
            words.push_back(bitsOf(static_cast<float>(bound)));
          words.push_back(range->includesLow * 2u + range->includesHigh);
        }
}

std::vector<std::uint32_t> World::run() {
  begin();
  std::vector<std::uint32_t> words;
  launch.status = &status;
  for (std::uint32_t depth : {0u, 2u}) {
    launch.maxDepth = depth;
    status = {};
    for (std::uint32_t pixel = 0; pixel != 6; ++pixel) {
      float color[RTSL_MAX_COLOR] = {};
      code.sample(&launch, pixel * 7 % 5, pixel % 3, pixel / 3, color);
      checkGuard();
      for (unsigned i = 0; i != code.colorComponents; ++i)
        words.push_back(wordOf(color[i]));
      words.push_back(printed);
    }
    noteExceptions(words);
  }
  launch.status = nullptr;
  sampleObjects(words);
  noteRanges(words);
  return words;
}

void World::renderByLane(std::vector<float> &pixels) {
  RtslJob job{};
  job.launch = &launch;
  job.status = &status;
  job.laneBytes =
      (code.megakernel.laneBytes(launch.maxDepth, launch.referenceChain) + 15) / 16 * 16;
  job.lanes = static_cast<std::uint8_t *>(rtsl_machine_stack(job.laneBytes));
  device::setWindowSize(job, launch.width, launch.height);
  job.samplesPerPixel = 1;
  device::setSampleCount(job, 1);
  std::vector<float> samples(pixels.size());
  job.samples = samples.data();
  job.pixels = pixels.data();
  code.megakernel.runLane(&job, 0);
  device::addSamples(job, 0, 1);
  checkGuard();
}

void World::renderBySample(std::vector<float> &pixels) {
  RtslJob job{}; // the order of a lane, in which programs print
  device::setWindowSize(job, launch.width, launch.height);
  for (std::uint32_t place = 0; place != launch.width * launch.height; ++place) {
    const device::Pixel pixel = device::pixelAt(job, place);
    float *color = &pixels[pixel.number(job) * code.colorComponents];
    code.sample(&launch, pixel.x, pixel.y, 0, color);
    checkGuard();
    if (!std::all_of(color, color + code.colorComponents,
                     [](float component) { return std::isfinite(component); }))
      std::fill_n(color, code.colorComponents, 0.0f);
    for (unsigned i = 0; i != code.colorComponents; ++i)
      color[i] += 0.0f; // of a sum of samples, which is never -0
  }
}

std::vector<std::uint32_t> World::render() {
  begin();
  std::vector<std::uint32_t> words;
  launch.status = &status;
  for (std::uint32_t depth : {0u, 2u}) {
    launch.maxDepth = depth;
    status = {};
    std::vector<float> pixels(static_cast<std::size_t>(launch.width) * launch.height *
                              code.colorComponents);
    if (code.megakernel.runLane)
      renderByLane(pixels);
    else
      renderBySample(pixels);
    for (float component : pixels)
      words.push_back(wordOf(component));
    words.push_back(printed);
    noteExceptions(words);
  }
  launch.status = nullptr;
  sampleObjects(words);
  return words;
}

} // namespace rtsl::random
