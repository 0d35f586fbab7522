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
        if (attribute.offset == RTSL_NOT_READ)
          return;
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
  forEachAttribute(
      launch, mesh, [&](const RtslMeshAttribute &attribute, const RtslMeshValues &values) {
        if (values.space == RTSL_ATTRIBUTE_NUMBERS || attribute.offset == RTSL_NOT_READ)
          return;
        uint32_t *at = state.attributes + attribute.offset;
        const Vec3 given = {floatOf(at[0]), floatOf(at[1]), floatOf(at[2])};
        const Vec3 world =
            values.space == RTSL_ATTRIBUTE_POINT    ? pointToWorld(launch, transform, given)
            : values.space == RTSL_ATTRIBUTE_NORMAL ? normalToWorld(launch, transform, given)
                                                    : vectorToWorld(launch, transform, given);
        at[0] = bitsOf(world.x);
        at[1] = bitsOf(world.y);
        at[2] = bitsOf(world.z);
        if (values.space == RTSL_ATTRIBUTE_TANGENT && isMirror(launch, transform))
          at[3] = bitsOf(-floatOf(at[3]));
      });
}

/// Changes of the barycentric coordinates u and v of a triangle along the axes of the footprint.
struct BarycentricChanges {
  float along[2][2] = {{0, 0}, {0, 0}}; // by axis: of u, of v
};

/// Does the program read how attributes change? Folds to a constant in a compiled program.
inline bool hasAttributeChanges(const RtslLaunch &launch) {
  const RtslMeshAttribute *attributes = rtsl_mesh_attributes(&launch);
  bool has = false;
  for (uint32_t i = 0; i < rtsl_mesh_attribute_count(&launch); ++i)
    has |= attributes[i].changes[0] != RTSL_NOT_READ || attributes[i].changes[1] != RTSL_NOT_READ;
  return has;
}

/// On a primitive that does not have these scratch members they are 0.
inline void clearAttributeChanges(RtslState &state) {
  const RtslMeshAttribute *attributes = rtsl_mesh_attributes(state.launch);
  for (uint32_t i = 0; i < rtsl_mesh_attribute_count(state.launch); ++i)
    for (const uint32_t change : attributes[i].changes)
      for (uint32_t word = 0; change != RTSL_NOT_READ && word < attributes[i].words; ++word)
        state.attributes[change + word] = 0;
}

/// What describeAttributes interpolates is linear in the barycentric coordinates.
inline void describeAttributeChanges(RtslState &state, const RtslMesh &mesh,
                                     const BarycentricChanges &by) {
  forEachAttribute(
      *state.launch, mesh, [&](const RtslMeshAttribute &attribute, const RtslMeshValues &values) {
        const uint32_t *index = mesh.indices + 3 * size_t(state.primitive);
        const auto at = [&](int corner, uint32_t i) {
          return floatOf(values.values[size_t(attribute.words) * index[corner] + i]);
        };
        for (int axis = 0; axis < 2; ++axis) {
          if (attribute.changes[axis] == RTSL_NOT_READ)
            continue;
          uint32_t *to = state.attributes + attribute.changes[axis];
          const float *of = by.along[axis];
          for (uint32_t i = 0; i < attribute.words; ++i)
            to[i] = values.ofTriangles
                        ? 0
                        : bitsOf(fused(at(1, i) - at(0, i), of[0], (at(2, i) - at(0, i)) * of[1]));
        }
      });
}

/// The change of a normalised vector v / |v| if v changes by `change`; 0 for v = 0.
inline Vec3 changeOfNormalized(Vec3 v, Vec3 change) {
  const float square = dot(v, v);
  if (!(square > 0 && square < infinity))
    return {0, 0, 0};
  const float reciprocal = 1 / squareRoot(square);
  const Vec3 unit = v * reciprocal;
  return (change - unit * dot(unit, change)) * reciprocal;
}

/// Converts these changes as attributesToWorld converts the values; that of a point is a vector.
inline void attributeChangesToWorld(RtslState &state, const RtslMesh &mesh,
                                    const RtslTransform &transform) {
  const RtslLaunch &launch = *state.launch;
  const uint32_t *index = mesh.indices + 3 * size_t(state.primitive);
  forEachAttribute(launch, mesh,
                   [&](const RtslMeshAttribute &attribute, const RtslMeshValues &values) {
                     if (values.space == RTSL_ATTRIBUTE_NUMBERS || values.ofTriangles)
                       return;
                     const auto corner = [&](int i) {
                       const uint32_t *from = values.values + size_t(attribute.words) * index[i];
                       return Vec3{floatOf(from[0]), floatOf(from[1]), floatOf(from[2])};
                     };
                     for (const uint32_t change : attribute.changes) {
                       if (change == RTSL_NOT_READ)
                         continue;
                       uint32_t *to = state.attributes + change;
                       Vec3 world = {floatOf(to[0]), floatOf(to[1]), floatOf(to[2])};
                       if (values.space == RTSL_ATTRIBUTE_NORMAL) {
                         const float u = state.u, v = state.v, w = (1.0f - u) - v;
                         const Vec3 normal = corner(0) * w + corner(1) * u + corner(2) * v;
                         world = changeOfNormalized(covectorToWorld(launch, transform, normal),
                                                    covectorToWorld(launch, transform, world));
                       } else {
                         world = vectorToWorld(launch, transform, world);
                       }
                       to[0] = bitsOf(world.x);
                       to[1] = bitsOf(world.y);
                       to[2] = bitsOf(world.z);
                       if (values.space == RTSL_ATTRIBUTE_TANGENT && isMirror(launch, transform))
                         to[3] = bitsOf(-floatOf(to[3]));
                     }
                   });
}

} // namespace rtsl::device
