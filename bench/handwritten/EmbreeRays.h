//===- EmbreeRays.h - rays of Embree --------------------------------------===//
#pragma once

#include "Picture.h"

#include <embree3/rtcore.h>

#include <limits>

namespace handwritten {

/// The end of rays that see everything, and the distance of what is not hit. No infinity, because
/// with -ffast-math the compiler takes for granted that there is none.
constexpr float farthest = std::numeric_limits<float>::max();

inline RTCRay embreeRay(vec3 origin, vec3 direction, float start, float end) {
  RTCRay ray;
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tnear = start, ray.tfar = end;
  ray.time = 0, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
  return ray;
}

inline bool isOccluded(RTCScene scene, RTCRay ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
  return ray.tfar < 0;
}

} // namespace handwritten
