#include "ByHand.h"

#include <cmath>

namespace byhand {

namespace {

constexpr float radius = 1.8f; // of a sphere around the set
constexpr float epsilon = 1e-4f;

glm::vec4 square(const glm::vec4 &q) {
  const glm::vec3 imaginary(q.y, q.z, q.w);
  return glm::vec4(q.x * q.x - glm::dot(imaginary, imaginary), 2.0f * q.x * imaginary);
}

float distanceBound(const Julia &julia, const glm::vec3 &p) {
  glm::vec4 z(p, 0.0f);
  float derivative = 1.0f;
  for (int i = 0; i < julia.iterations; ++i) {
    derivative = 2.0f * glm::length(z) * derivative;
    z = square(z) + julia.constant;
    if (glm::dot(z, z) > 16.0f)
      break;
  }
  const float size = glm::length(z);
  return 0.5f * size * std::log(size) / derivative;
}

glm::vec3 gradientAt(const Julia &julia, const glm::vec3 &p) {
  const float e = 1e-4f;
  const glm::vec3 x(e, 0, 0), y(0, e, 0), z(0, 0, e);
  return glm::vec3(distanceBound(julia, p + x) - distanceBound(julia, p - x),
                   distanceBound(julia, p + y) - distanceBound(julia, p - y),
                   distanceBound(julia, p + z) - distanceBound(julia, p - z));
}

} // namespace

bool Julia::intersect(Hit &hit, glm::vec3 &gradient) const {
  const float speed = glm::length(hit.direction);
  const glm::vec3 direction = hit.direction / speed;
  const glm::vec3 origin = hit.origin - center;

  const float b = -glm::dot(origin, direction);
  const glm::vec3 nearest = origin + b * direction;
  const float discriminant = radius * radius - glm::dot(nearest, nearest);
  if (discriminant < 0.0f)
    return false;
  const float root = std::sqrt(discriminant);
  float t = std::fmax(b - root, epsilon * speed);
  const float end = std::fmin(b + root, hit.distance * speed);

  while (t < end) {
    const glm::vec3 p = origin + t * direction;
    const float step = distanceBound(*this, p);
    if (step < tolerance) {
      gradient = gradientAt(*this, p);
      const float found = t / speed;
      if (!(found > epsilon && found < hit.distance))
        return false;
      hit.distance = found;
      return true;
    }
    t += step;
  }
  return false;
}

} // namespace byhand
