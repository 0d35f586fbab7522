//===- CameraCone.h - the cone of a camera's ray --------------------------===//
//
// The cone is as wide as the distance to the rays of the neighbouring pixels. For these rays the
// camera is called again for points of the image one pixel to the right and one pixel up, with the
// same lens coordinates and random numbers. So this works for any camera. The width is the
// geometric mean of the two distances.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Events.h"
#include "runtime/device/ray/State.h"
#include "runtime/device/ray/Status.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// The sine of the angle between two directions of any length; 0 if one of them is not good.
inline float sineBetween(Vec3 a, Vec3 b) {
  const Vec3 normal = cross(normalized(a), normalized(b));
  const float square = dot(normal, normal);
  return square < infinity ? squareRoot(square) : 0;
}

/// sqrt(a b) of numbers that are not negative; 0 if it is not finite.
inline float geometricMean(float a, float b) {
  const float mean = squareRoot(a) * squareRoot(b);
  return mean < infinity ? mean : 0;
}

/// Finds the cone of the camera's ray that the state has; call(state) makes one for the state's
/// ScreenCoord. `dimension` is the counter of random numbers before the camera ran.
template <typename Call>
inline void describeCameraCone(RtslState &state, const RtslLaunch &launch, uint32_t dimension,
                               Call call) {
  const Vec3 origin = load(state.RayOrigin), direction = load(state.RayDirection);
  const uint32_t after = state.dimension;
  RtslEvents *const events = state.events;
  RtslEvents ofNeighbours; // which are not traced
  if (hasEvents(state)) {
    ofNeighbours = {unheard, 0, 0, RTSL_EXCEPTION_NONE, 0};
    state.events = &ofNeighbours;
  }
  const float pixel[2] = {1.0f / float(launch.width), 1.0f / float(launch.height)};
  float width[2], spread[2];
  for (int axis = 0; axis < 2; ++axis) {
    const float at = state.ScreenCoord[axis];
    state.ScreenCoord[axis] = at + pixel[axis];
    state.dimension = dimension;
    call(state);
    state.ScreenCoord[axis] = at;
    const Vec3 apart = load(state.RayOrigin) - origin;
    width[axis] = squareRoot(dot(apart, apart));
    spread[axis] = sineBetween(direction, load(state.RayDirection));
  }
  state.events = events;
  state.dimension = after;
  store(state.RayOrigin, origin);
  store(state.RayDirection, direction);
  state.coneAtOrigin = state.ConeWidth = geometricMean(width[0], width[1]);
  state.ConeSpread = geometricMean(spread[0], spread[1]);
}

} // namespace rtsl::device
