//===- Run.cpp - what a program computes in its world ---------------------===//
#include "HostFunctions.h"
#include "Numbers.h"
#include "World.h"

#include "runtime/device/organisations/SampleSums.h"

#include <algorithm>
#include <cmath>

extern "C" void *rtsl_machine_stack(std::uint64_t bytes);

namespace rtsl::random {

using runtime::MemberInfo;

/// Nothing was printed yet, no ray has hit anything, and nothing is written.
void World::begin() {
  beginRun(code.prints);
  for (std::size_t i = 0; i != buffers.size(); ++i) // the addresses of their elements stay
    std::copy(filledBuffers[i].begin(), filledBuffers[i].end(), buffers[i].begin());
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
    words.push_back(hashOfPrinted());
    words.push_back(events.exception);
  };
  for (std::uint32_t number = 0; number != 2; ++number) {
    for (RtslRef material : materials)
      for (Method method :
           {slots.rt_Material_sampleBSDF, slots.rt_Material_BSDF, slots.rt_Material_evaluatePDF,
            slots.rt_Material_emission, slots.rt_Material_transmittance})
        call(method, material, number);
    for (RtslRef primitive : primitives)
      for (Method method : {slots.rt_Primitive_generateSample, slots.rt_Primitive_samplePDF,
                            slots.rt_Primitive_computeBounds})
        call(method, primitive, number);
    if (launch.background != 0)
      for (Method method : {slots.rt_Miss_sampleDirection, slots.rt_Miss_directionPDF})
        call(method, launch.background, number);
  }
}

/// The elements of output buffers.
void World::noteOutputs(std::vector<std::uint32_t> &words) const {
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

/// What surfaces that shine send out, as whoever makes a scene estimates it.
void World::notePowers(std::vector<std::uint32_t> &words) const {
  if (!(code.needs & RTSL_NEEDS_EMITTERS) || !code.emittedPower)
    return;
  for (const RtslEmitter &emitter : emitters)
    for (std::uint32_t sample = 0; sample != 2; ++sample) {
      float normal[3];
      words.push_back(
          wordOf(code.emittedPower(&launch, emitter.instance, sample % 2, sample, normal)));
      for (const float component : normal)
        words.push_back(wordOf(component));
    }
}

template <typename Render>
std::vector<std::uint32_t> World::renderAtEachDepth(bool isSampled, Render render) {
  begin();
  std::vector<std::uint32_t> words;
  launch.status = &status;
  // Paths of the engine `path` end at random from the fourth surface on.
  for (std::uint32_t depth : {0u, usesPathTracer(program.seed) ? 4u : 2u}) {
    launch.maxDepth = depth;
    status = {};
    render(words);
    noteExceptions(words);
  }
  launch.status = nullptr;
  if (isSampled)
    sampleObjects(words);
  noteOutputs(words);
  return words;
}

std::vector<std::uint32_t> World::run(bool isSampled) {
  std::vector<std::uint32_t> all =
      renderAtEachDepth(isSampled, [&](std::vector<std::uint32_t> &words) {
        for (std::uint32_t pixel = 0; pixel != 6; ++pixel) {
          float color[RTSL_MAX_COLOR] = {};
          code.sample(&launch, pixel * 7 % 5, pixel % 3, pixel / 3, color);
          checkStack();
          for (unsigned i = 0; i != code.colorComponents; ++i)
            words.push_back(wordOf(color[i]));
          words.push_back(hashOfPrinted());
        }
      });
  noteRanges(all);
  if (isSampled)
    notePowers(all);
  return all;
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
  checkStack();
}

void World::renderBySample(std::vector<float> &pixels) {
  RtslJob job{}; // the order of a lane, in which programs print
  device::setWindowSize(job, launch.width, launch.height);
  for (std::uint32_t place = 0; place != launch.width * launch.height; ++place) {
    const device::Pixel pixel = device::pixelAt(job, place);
    float *color = &pixels[pixel.number(job) * code.colorComponents];
    code.sample(&launch, pixel.x, pixel.y, 0, color);
    checkStack();
    if (!std::all_of(color, color + code.colorComponents,
                     [](float component) { return std::isfinite(component); }))
      std::fill_n(color, code.colorComponents, 0.0f);
    for (unsigned i = 0; i != code.colorComponents; ++i)
      color[i] += 0.0f; // of a sum of samples, which is never -0
  }
}

std::vector<std::uint32_t> World::render() {
  return renderAtEachDepth(/*isSampled=*/true, [&](std::vector<std::uint32_t> &words) {
    std::vector<float> pixels(static_cast<std::size_t>(launch.width) * launch.height *
                              code.colorComponents);
    if (code.megakernel.runLane)
      renderByLane(pixels);
    else
      renderBySample(pixels);
    for (float component : pixels)
      words.push_back(wordOf(component));
    words.push_back(hashOfPrinted());
  });
}

bool World::hitSomething() const {
  return hasRayThatHit();
}

} // namespace rtsl::random
