//===- Triangles.h - a mesh for Embree ------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <embree3/rtcore.h>

namespace handwritten {

/// A geometry that is committed and not attached yet. It reads the mesh as long as it exists, which
/// gets one number more behind its vertices.
inline RTCGeometry newTriangles(RTCDevice device, rtsl::runtime::Mesh &mesh) {
  const std::size_t vertices = mesh.vertexCount();
  mesh.positions.push_back(0); // Embree reads 16 bytes at each vertex
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh.positions.data(), 0, 3 * sizeof(float), vertices);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.indices.data(), 0, 3 * sizeof(unsigned), mesh.triangleCount());
  rtcCommitGeometry(geometry);
  return geometry;
}

} // namespace handwritten
