//===- Picture.h - what is the same for all samples of a picture ----------===//
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace handwritten {

using glm::vec2;
using glm::vec3;

struct Picture {
  std::uint32_t width = 960, height = 540;
  std::uint32_t samplesPerPixel = 16;
  std::uint32_t maxDepth = 8; // 0: camera rays only
  std::uint32_t seed = 1;
};

/// A pinhole camera at `eye`; a sample at (x, y) in [0, 1]^2 looks along corner + x across + y
/// upward.
struct Camera {
  vec3 eye{0, 2.2f, 7.5f};
  vec3 gaze = glm::normalize(vec3(0, -0.19f, -1));
  vec3 right = glm::normalize(glm::cross(gaze, vec3(0, 1, 0)));
  vec3 up = glm::cross(right, gaze);
  vec3 corner = -1.6f * right - 0.9f * up + 2.7f * gaze;
  vec3 across = 3.2f * right;
  vec3 upward = 1.8f * up;
};

struct BallLight {
  vec3 position;
  float radius;
  vec3 intensity;
};

} // namespace handwritten
