//===- Main.cpp - generated shaders beside those by hand ------------------===//
//
//     PROGRAM ROUNDS
//
// prints a line of JSON a shader: nanoseconds a call of each round, of both sides in turns, and how
// far their answers are apart.
//
//===----------------------------------------------------------------------===//
#include "ByHand.h"

#include "rtsl/program.h"
#include "runtime/device/ray/State.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <random>
#include <string>
#include <vector>

extern "C" {
const RtslShaders *NoiseTexture_shaders();
const RtslShaders *Ggx_shaders();
const RtslShaders *Julia_shaders();
const RtslShaders *Dielectric_shaders();
}

namespace {

using byhand::Hit;

// So many that a processor does not learn by heart which way each hit goes, which no picture would
// let it do: with 128, code by hand that jumps over its choices runs at six times its speed. And
// few enough for the states, which are large, to lie in the nearer caches, as those of a renderer
// do.
constexpr std::size_t hitCount = 512, repeats = 16;

double processorNanoseconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) * 1e9 + double(time.tv_nsec);
}

/// Hits on a sphere of radius 1, seen from outside and from inside.
std::vector<Hit> someHits() {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const auto direction = [&] {
    const float x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(glm::vec3(x, y, z));
  };
  std::vector<Hit> hits(hitCount);
  for (Hit &hit : hits) {
    hit.origin = direction() * (uniform(random) < 0.5f ? 3.0f : 0.5f);
    hit.point = direction();
    hit.direction = (hit.point - hit.origin) * (0.5f + uniform(random));
    hit.distance = glm::length(hit.point - hit.origin) / glm::length(hit.direction);
    hit.geometricNormal = hit.shadingNormal = hit.point;
    hit.uvw = hit.point * 3.0f;
  }
  return hits;
}

/// The object of the only class of some shaders, as its defaults make it, and the rays that meet
/// it.
class Generated {
public:
  Generated(const RtslShaders *shaders, const std::vector<Hit> &hits)
      : program(*rtsl::program(shaders)), records(object + program.classes.at(0).recordSize + 16) {
    launch.records = records.data();
    launch.lightCount = byhand::lightCount;
    copy(byhand::ambient, launch.ambient);
    RtslState state{};
    state.launch = &launch;
    std::memcpy(&records[object], &program.classes[0].id, 4);
    if (program.classes[0].initialize)
      program.classes[0].initialize(&state, object);
    for (const Hit &hit : hits) {
      copy(hit.origin, state.RayOrigin);
      copy(hit.direction, state.RayDirection);
      copy(hit.point, state.HitPoint);
      copy(hit.geometricNormal, state.GeometricNormal);
      copy(hit.shadingNormal, state.ShadingNormal);
      copy(hit.uvw, state.TextureUVW);
      state.Epsilon = 1e-4f;
      state.HitDistance = hit.distance;
      states.push_back(state);
    }
  }
  Generated(const Generated &) = delete;

  void set(const std::string &member, const glm::vec3 &value) {
    for (const rtsl::runtime::MemberInfo &info : program.classes[0].members)
      if (info.name == member)
        std::memcpy(&records[object + info.offset], &value, sizeof value);
  }

  static constexpr RtslRef object = 16;
  const rtsl::runtime::Program &program;
  std::vector<RtslState> states;

private:
  static void copy(const glm::vec3 &from, float *to) { std::copy_n(&from.x, 3, to); }

  std::vector<std::uint8_t> records;
  RtslLaunch launch{};
};

glm::vec3 vector(const float *components) {
  return glm::vec3(components[0], components[1], components[2]);
}

/// Calls both sides for all hits, in turns. Each is a function from the number of a hit to the
/// answer.
template <typename ByHand, typename Ours>
void compare(const char *name, int rounds, ByHand byHand, Ours ours) {
  std::array<std::vector<glm::vec3>, 2> answers = {std::vector<glm::vec3>(hitCount),
                                                   std::vector<glm::vec3>(hitCount)};
  std::array<std::vector<double>, 2> times;
  const auto run = [&](std::size_t side, auto &shader) {
    const double start = processorNanoseconds();
    for (std::size_t repeat = 0; repeat < repeats; ++repeat)
      for (std::size_t i = 0; i < hitCount; ++i) {
        byhand::begin();
        answers[side][i] = shader(i);
      }
    return (processorNanoseconds() - start) / double(hitCount * repeats);
  };
  for (int round = -2; round < rounds; ++round) { // two to warm up
    double byHandTime, oursTime;
    if (round & 1) {
      byHandTime = run(0, byHand);
      oursTime = run(1, ours);
    } else {
      oursTime = run(1, ours);
      byHandTime = run(0, byHand);
    }
    if (round >= 0) {
      times[0].push_back(byHandTime);
      times[1].push_back(oursTime);
    }
  }
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < hitCount; ++i) {
    const glm::vec3 d = answers[1][i] - answers[0][i];
    difference += double(glm::dot(d, d));
    size += double(glm::dot(answers[0][i], answers[0][i]));
  }
  std::printf("{\"shader\": \"%s\", \"difference\": %.3g", name, std::sqrt(difference / size));
  for (std::size_t side = 0; side < 2; ++side) {
    std::printf(", \"%s\": [", side ? "generated" : "byHand");
    for (std::size_t i = 0; i < times[side].size(); ++i)
      std::printf("%s%.2f", i ? ", " : "", times[side][i]);
    std::printf("]");
  }
  std::printf("}\n");
}

} // namespace

int main(int argc, char **argv) {
  const int rounds = argc > 1 ? std::max(std::atoi(argv[1]), 1) : 20;
  const std::vector<Hit> hits = someHits();
  {
    const byhand::NoiseTexture byHand;
    Generated generated(NoiseTexture_shaders(), hits);
    const auto lookup = generated.program.slots.rt_Texture_lookup;
    compare(
        "noise texture", rounds, [&](std::size_t i) { return byHand.lookup(hits[i]); },
        [&](std::size_t i) {
          lookup(&generated.states[i], generated.object);
          return vector(generated.states[i].TextureColor);
        });
  }
  {
    const byhand::Ggx byHand;
    Generated generated(Ggx_shaders(), hits);
    const auto shade = generated.program.slots.rt_Material_shade;
    compare(
        "GGX", rounds, [&](std::size_t i) { return byHand.shade(hits[i]); },
        [&](std::size_t i) {
          shade(&generated.states[i], generated.object);
          return vector(generated.states[i].SampleColor);
        });
  }
  {
    const byhand::Julia byHand;
    Generated generated(Julia_shaders(), hits);
    const auto intersect = generated.program.slots.rt_Primitive_intersect;
    const float infinity = 1e30f;
    compare(
        "Julia intersection", rounds,
        [&](std::size_t i) {
          Hit hit = hits[i];
          hit.distance = infinity;
          glm::vec3 gradient(0.0f);
          return byHand.intersect(hit, gradient) ? glm::vec3(hit.distance, 0.0f, 1.0f)
                                                 : glm::vec3(0.0f);
        },
        [&](std::size_t i) {
          RtslState &state = generated.states[i];
          state.HitDistance = infinity;
          intersect(&state, generated.object);
          return state.HitDistance < infinity ? glm::vec3(state.HitDistance, 0.0f, 1.0f)
                                              : glm::vec3(0.0f);
        });
  }
  {
    byhand::Dielectric byHand;
    byHand.tint = glm::vec3(0.85f, 0.97f, 0.9f);
    Generated generated(Dielectric_shaders(), hits);
    generated.set("tint", byHand.tint);
    const auto shade = generated.program.slots.rt_Material_shade;
    compare(
        "dielectric", rounds, [&](std::size_t i) { return byHand.shade(hits[i]); },
        [&](std::size_t i) {
          shade(&generated.states[i], generated.object);
          return vector(generated.states[i].SampleColor);
        });
  }
}
