#include "ByHand.h"

#include <cmath>

namespace byhand {

namespace {

constexpr float pi = 3.14159265f;

float distribution(float cosine, float sineSquared, float alpha) {
  const float denominator = sineSquared + alpha * alpha * cosine * cosine;
  return alpha * alpha / (pi * denominator * denominator);
}

float visibility(float cosine, float alpha) {
  return 1.0f / (cosine + std::sqrt(alpha * alpha + (1.0f - alpha * alpha) * cosine * cosine));
}

} // namespace

glm::vec3 Ggx::shade(const Hit &hit) const {
  const glm::vec3 view = -glm::normalize(hit.direction);
  const glm::vec3 normal = glm::faceforward(hit.shadingNormal, hit.direction, hit.geometricNormal);
  const float alpha = std::fmax(roughness * roughness, 1e-4f);
  const float viewCosine = std::fmax(glm::dot(normal, view), 1e-4f);
  glm::vec3 sum = reflectance * ambient;

  for (int i = 0; i < lightCount; ++i) {
    glm::vec3 direction, color;
    if (!byhand::light(i, hit.point, normal, 0.0f, direction, color))
      continue;
    const glm::vec3 toLight = glm::normalize(direction);
    const glm::vec3 halfway = glm::normalize(view + toLight);
    const float lightCosine = glm::dot(normal, toLight);
    if (lightCosine <= 0.0f)
      continue;
    const glm::vec3 across = glm::cross(normal, halfway);
    const float d = distribution(glm::dot(normal, halfway), glm::dot(across, across), alpha);
    const float v = visibility(lightCosine, alpha) * visibility(viewCosine, alpha);
    const float rest = 1.0f - glm::dot(view, halfway), squared = rest * rest;
    const glm::vec3 fresnel = glm::mix(reflectance, glm::vec3(1.0f), squared * squared * rest);
    sum += fresnel * (d * v * lightCosine) * color;
  }
  return sum;
}

} // namespace byhand
