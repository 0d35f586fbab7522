//===- Surroundings.h - what shaders are called with, the same for both sides --------===//
//
// A shader gets rays, light and random numbers from its environment. Here these are cheap and
// always the same, so that what is timed is the shader. The two sides see them through their own
// interface: the generated code through the functions of runtime/device/ray/Abi.h, the code by hand
// through those of this header; both end in the same few lines.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <glm/glm.hpp>

namespace byhand {

/// What a shader by hand is given.
struct Hit {
  glm::vec3 origin, direction; // the ray
  float distance;              // in units of `direction`; for `intersect` the farthest that counts
  glm::vec3 point, geometricNormal, shadingNormal;
  glm::vec3 uvw;
};

/// The color that arrives at `origin` from `direction`.
glm::vec3 trace(const glm::vec3 &origin, const glm::vec3 &direction);

/// Uniform in [0, 1); the sequence begins anew with each shader call.
float random();

extern const int lightCount; // a scene's own: shaders are compiled without it

/// Whether a light reaches a point, from within `cosine` of the normal; `direction` is not unit.
bool light(int index, const glm::vec3 &point, const glm::vec3 &normal, float cosine,
           glm::vec3 &direction, glm::vec3 &color);

extern const glm::vec3 ambient;

/// Before each call of a shader.
void begin();

} // namespace byhand
