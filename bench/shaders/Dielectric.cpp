#include "ByHand.h"

#include <cmath>

namespace byhand {

namespace {

float reflectance(float cosine, float ratio) {
  const float sineSquared = ratio * ratio * (1.0f - cosine * cosine);
  if (sineSquared >= 1.0f)
    return 1.0f;
  const float other = std::sqrt(1.0f - sineSquared);
  const float parallel = (cosine - ratio * other) / (cosine + ratio * other);
  const float perpendicular = (ratio * cosine - other) / (ratio * cosine + other);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

} // namespace

glm::vec3 Dielectric::shade(const Hit &hit) const {
  const glm::vec3 direction = glm::normalize(hit.direction);
  const bool entering = glm::dot(direction, hit.geometricNormal) < 0.0f;
  const glm::vec3 normal = entering ? hit.shadingNormal : -hit.shadingNormal;
  const float ratio = entering ? 1.0f / index : index;
  const float cosine = glm::clamp(-glm::dot(direction, normal), 0.0f, 1.0f);

  const glm::vec3 next = random() < reflectance(cosine, ratio)
                             ? glm::reflect(direction, normal)
                             : glm::refract(direction, normal, ratio);
  glm::vec3 attenuation(1.0f);
  if (!entering) {
    const float length = hit.distance * glm::length(hit.direction);
    attenuation =
        glm::vec3(std::pow(tint.x, length), std::pow(tint.y, length), std::pow(tint.z, length));
  }
  return attenuation * trace(hit.point, next);
}

} // namespace byhand
