// Made by rtslc --emit=cpp. Compiled with any options but -ffast-math it computes what rtslc's own
// machine code computes, to the last bit.
#include <rtsl/shader.h>

namespace NoiseTexture {

using State = rtsl::State<3>;
using Color = rtsl::Color<3>;

namespace {

enum class Id : std::uint32_t { NoiseTexture = 1 };

// Turbulence: several octaves of gradient noise in space (Perlin, "Improving Noise", 2002, with a
// hash in place of the permutation).
struct NoiseTexture : rtsl::Texture {
  float scale = 4.0f;
  int octaves = 5;
  Color dark = Color(0.1f);
  Color light = Color(0.9f);

  // A well-mixed number for a lattice point (the finaliser of MurmurHash3, Appleby 2008).
  unsigned hash(glm::ivec3 cell) const {
    unsigned h = (unsigned(cell.x) * 0x8da6b343u) ^ (unsigned(cell.y) * 0xd8163841u) ^
                 (unsigned(cell.z) * 0xcb1ab31fu);
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    return h ^ (h >> 16);
  }

  // The product of a lattice point's gradient, one of twelve, with the way to it.
  float gradient(unsigned h, glm::vec3 way) const {
    unsigned which = h & 15u;
    float u = which < 8u ? way.x : way.y;
    float v = which < 4u ? way.y : which == 12u || which == 14u ? way.x : way.z;
    return ((which & 1u) == 0u ? u : -u) + ((which & 2u) == 0u ? v : -v);
  }

  // In about [-1, 1].
  float noise(glm::vec3 p) const {
    glm::vec3 corner = rtsl::floor(p);
    glm::ivec3 cell = rtsl::toInt(corner);
    glm::vec3 t = p - corner;
    glm::vec3 fade = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
    float sum = 0.0f;
    for (int i = 0; i < 8; ++i) {
      glm::ivec3 offset = glm::ivec3(i & 1, (i >> 1) & 1, i >> 2);
      glm::vec3 weight = rtsl::mix(1.0f - fade, fade, glm::vec3(offset));
      sum += weight.x * weight.y * weight.z *
             gradient(hash(rtsl::add(cell, offset)), t - glm::vec3(offset));
    }
    return sum;
  }

  void lookup(State &rt) const {
    glm::vec3 p = scale * rt.TextureUVW;
    float amplitude = 0.5f;
    float sum = 0.0f;
    for (int octave = 0; octave < octaves; ++octave) {
      sum += amplitude * rtsl::abs(noise(p));
      p *= 2.03f; // not 2: the lattices of the octaves must not meet
      amplitude *= 0.5f;
    }
    rt.TextureColor = rtsl::mix(dark, light, rtsl::clamp(sum, 0.0f, 1.0f));
  }
};

} // namespace

//===----------------------------------------------------------------------===//
// Functions that the runtime calls
//===----------------------------------------------------------------------===//

namespace slots {

inline void lookup(RtslState *ray, RtslRef object) {
  State &rt = rtsl::stateOf<3>(ray);
  rtsl::object<NoiseTexture>(rt, object).lookup(rt);
}

} // namespace slots

static RtslShaders describe() {
  rtsl::Program<3> program;
  program
      .add<NoiseTexture>(static_cast<std::uint32_t>(Id::NoiseTexture), "NoiseTexture", "rt_Texture",
                         "rt_Texture")
      .member("scale", &NoiseTexture::scale, rtsl::Access::Public, rtsl::Default::Given)
      .member("octaves", &NoiseTexture::octaves, rtsl::Access::Public, rtsl::Default::Given)
      .member("dark", &NoiseTexture::dark, rtsl::Access::Public, rtsl::Default::Given)
      .member("light", &NoiseTexture::light, rtsl::Access::Public, rtsl::Default::Given)
      .methods({"gradient", "hash", "lookup", "noise"})
      .needs(RTSL_NEEDS_TEXTURE_COORDINATES);
  program.needs(RTSL_NEEDS_TEXTURE_COORDINATES);
  program.slots().rt_Texture_lookup = &slots::lookup;
  return program.finish();
}

} // namespace NoiseTexture

/// For rtsl::program in C++, and rtslSceneCreate in C.
extern "C" const RtslShaders *NoiseTexture_shaders();
const RtslShaders *NoiseTexture_shaders() {
  static const RtslShaders shaders = NoiseTexture::describe();
  return &shaders;
}
