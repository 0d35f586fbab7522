//===- ByHand.h - four shaders of docs/cpp-output, written in C++ by hand -===//
//
// The same algorithms on the same inputs, handwritten with GLM and the C library.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "Surroundings.h"

namespace byhand {

struct NoiseTexture {
  float scale = 4.0f;
  int octaves = 5;
  glm::vec3 dark = glm::vec3(0.1f), light = glm::vec3(0.9f);

  glm::vec3 lookup(const Hit &hit) const;
};

struct Ggx {
  float roughness = 0.3f;
  glm::vec3 reflectance = glm::vec3(0.9f, 0.6f, 0.3f);

  glm::vec3 shade(const Hit &hit) const;
};

struct Julia {
  glm::vec3 center = glm::vec3(0.0f);
  glm::vec4 constant = glm::vec4(-0.2f, 0.6f, 0.2f, 0.2f);
  int iterations = 10;
  float tolerance = 1e-3f;

  /// Moves `hit.distance` to what is hit in front of it.
  bool intersect(Hit &hit, glm::vec3 &gradient) const;
};

struct Dielectric {
  float index = 1.5f;
  glm::vec3 tint = glm::vec3(1.0f);

  glm::vec3 shade(const Hit &hit) const;
};

} // namespace byhand
