//===- MeshAttributes.h - the named attributes of a mesh at a hit ---------===//
//
// A material reads named attributes of a mesh as scratch members, so they are written to where
// `intersect` of a primitive would have stored them. The list of those that materials read is a
// constant of a compiled program: the loops over it unroll, and without attributes they are gone.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Instance.h"

namespace rtsl::device {

/// Calls visit(attribute, values) for the attributes of the mesh that some material reads.
template <typename Visit>
void forEachAttribute(const RtslLaunch &launch, const RtslMesh &mesh, Visit visit) {
  const RtslMeshAttribute *attributes = rtsl_mesh_attributes(&launch);
  const uint32_t count = rtsl_mesh_attribute_count(&launch);
  if (count == 0 || !mesh.attributes)
    return;
  for (uint32_t i = 0; i < count; ++i)
    if (const RtslMeshValues &values = mesh.attributes[i]; values.values)
      visit(attributes[i], values);
}

/// The attributes at state's hit: those of vertices are interpolated like texture coordinates.
inline void describeAttributes(RtslState &state, const RtslMesh &mesh) {
  forEachAttribute(
      *state.launch, mesh, [&](const RtslMeshAttribute &attribute, const RtslMeshValues &values) {
        uint32_t *to = state.attributes + attribute.offset;
        if (values.ofTriangles) {
          const uint32_t *from = values.values + size_t(attribute.words) * state.primitive;
          for (uint32_t i = 0; i < attribute.words; ++i)
            to[i] = from[i];
          return;
        }
        const uint32_t *index = mesh.indices + 3 * size_t(state.primitive);
        const float u = state.u, v = state.v, w = (1.0f - u) - v;
        const auto at = [&](int corner, uint32_t i) {
          return floatOf(values.values[size_t(attribute.words) * index[corner] + i]);
        };
        for (uint32_t i = 0; i < attribute.words; ++i)
          to[i] = bitsOf(fused(at(0, i), w, fused(at(1, i), u, at(2, i) * v)));
      });
}

/// Does the linear part of a transform mirror?
inline bool isMirror(const RtslLaunch &launch, const RtslTransform &transform) {
  if (!hasStretch(launch) || transform.squaredScale != 0)
    return false;
  const double *m = transform.inverse;
  return m[0] * (m[4] * m[8] - m[5] * m[7]) + m[3] * (m[7] * m[2] - m[1] * m[8]) +
             m[6] * (m[1] * m[5] - m[4] * m[2]) <
         0;
}

/// Converts those that are points, vectors, normals and tangents from object to world space.
inline void attributesToWorld(RtslState &state, const RtslMesh &mesh,
                              const RtslTransform &transform) {
  const RtslLaunch &launch = *state.launch;
  forEachAttribute(launch, mesh,
                   [&](const RtslMeshAttribute &attribute, const RtslMeshValues &values) {
                     if (values.space == RTSL_ATTRIBUTE_NUMBERS)
                       return;
                     uint32_t *at = state.attributes + attribute.offset;
                     const Vec3 given = {floatOf(at[0]), floatOf(at[1]), floatOf(at[2])};
                     const Vec3 world = values.space == RTSL_ATTRIBUTE_POINT
                                            ? pointToWorld(launch, transform, given)
                                        : values.space == RTSL_ATTRIBUTE_NORMAL
                                            ? normalToWorld(launch, transform, given)
                                            : vectorToWorld(launch, transform, given);
                     at[0] = bitsOf(world.x);
                     at[1] = bitsOf(world.y);
                     at[2] = bitsOf(world.z);
                     if (values.space == RTSL_ATTRIBUTE_TANGENT && isMirror(launch, transform))
                       at[3] = bitsOf(-floatOf(at[3]));
                   });
}

} // namespace rtsl::device
