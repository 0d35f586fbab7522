#include "ByHand.h"

#include <cmath>
#include <cstdint>

namespace byhand {

namespace {

std::uint32_t hash(const glm::ivec3 &cell) {
  std::uint32_t h = std::uint32_t(cell.x) * 0x8da6b343u ^ std::uint32_t(cell.y) * 0xd8163841u ^
                    std::uint32_t(cell.z) * 0xcb1ab31fu;
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 16);
}

float gradient(std::uint32_t h, const glm::vec3 &way) {
  const std::uint32_t which = h & 15u;
  const float u = which < 8u ? way.x : way.y;
  const float v = which < 4u ? way.y : which == 12u || which == 14u ? way.x : way.z;
  return ((which & 1u) ? -u : u) + ((which & 2u) ? -v : v);
}

float noise(const glm::vec3 &p) {
  const glm::vec3 corner = glm::floor(p);
  const glm::ivec3 cell(corner);
  const glm::vec3 t = p - corner;
  const glm::vec3 fade = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
  float sum = 0.0f;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 offset(i & 1, (i >> 1) & 1, i >> 2);
    const glm::vec3 weight = glm::mix(1.0f - fade, fade, glm::vec3(offset));
    sum += weight.x * weight.y * weight.z * gradient(hash(cell + offset), t - glm::vec3(offset));
  }
  return sum;
}

} // namespace

glm::vec3 NoiseTexture::lookup(const Hit &hit) const {
  glm::vec3 p = scale * hit.uvw;
  float amplitude = 0.5f, sum = 0.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * std::fabs(noise(p));
    p *= 2.03f;
    amplitude *= 0.5f;
  }
  return glm::mix(dark, light, glm::clamp(sum, 0.0f, 1.0f));
}

} // namespace byhand
