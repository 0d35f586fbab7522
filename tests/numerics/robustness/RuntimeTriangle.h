//===- RuntimeTriangle.h - the runtime's own triangle test ----------------===//
#pragma once

#include "TriangleCases.h"

#include "runtime/device/traverse/Triangle.h"

#include <optional>

namespace rtsl::numerics {

inline std::optional<device::TriangleHit> meet(const Triangle &triangle, device::Vec3 origin,
                                               device::Vec3 direction) {
  device::TriangleHit hit;
  if (!device::intersectTriangle(device::makeTriangleRay(origin, direction), triangle.v[0],
                                 triangle.v[1], triangle.v[2], hit))
    return std::nullopt;
  return hit;
}

} // namespace rtsl::numerics
