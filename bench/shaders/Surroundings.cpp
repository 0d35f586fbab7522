#include "Surroundings.h"

#include "runtime/device/ray/Abi.h"

#include <cstdint>

namespace byhand {

const glm::vec3 ambient(0.05f, 0.06f, 0.07f);
const int lightCount = 2;

namespace {

std::uint32_t drawn;
const glm::vec3 lights[] = {{4, 6, 3}, {-5, 3, 2}};

} // namespace

void begin() {
  drawn = 0x9e3779b9u;
}

glm::vec3 trace(const glm::vec3 &origin, const glm::vec3 &direction) {
  return glm::vec3(0.5f) + 0.1f * direction + 0.01f * origin;
}

float random() {
  drawn = drawn * 1664525u + 1013904223u;
  return float(drawn >> 8) * 0x1p-24f;
}

bool light(int index, const glm::vec3 &point, const glm::vec3 &normal, float cosine,
           glm::vec3 &direction, glm::vec3 &color) {
  direction = lights[index] - point;
  color = glm::vec3(1.0f, 0.9f, 0.8f);
  return glm::dot(direction, normal) > cosine * glm::length(direction);
}

} // namespace byhand

extern "C" {

void rtsl_trace(RtslState *, float ox, float oy, float oz, float dx, float dy, float dz,
                float *color) {
  const glm::vec3 arrived = byhand::trace({ox, oy, oz}, {dx, dy, dz});
  color[0] = arrived.x;
  color[1] = arrived.y;
  color[2] = arrived.z;
}

uint32_t rtsl_hit(RtslState *state, float t) {
  if (!(t > state->Epsilon && t < state->HitDistance))
    return 0;
  state->HitDistance = t;
  return 1;
}

float rtsl_rand(RtslState *) {
  return byhand::random();
}

uint32_t rtsl_illuminance(RtslState *state, uint32_t index, float px, float py, float pz, float nx,
                          float ny, float nz, float cosine) {
  glm::vec3 direction, color;
  const bool reaches =
      byhand::light(int(index), {px, py, pz}, {nx, ny, nz}, cosine, direction, color);
  for (int i = 0; i < 3; ++i) {
    state->LightDirection[i] = direction[i];
    state->LightColor[i] = color[i];
  }
  state->LightDistance = glm::length(direction);
  return reaches;
}
}
