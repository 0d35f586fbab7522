//===- Triangle.h - the one ray-triangle intersector ----------------------===//
//
// All traversals take t, u and v from here. Watertight after Woop, Benthin and Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2(1), 2013: the vertices are moved to the ray's origin and
// sheared so that the ray is the z axis; both triangles at an edge then see the same
// two-dimensional vertices, and the sign of the edge function decides. That paper falls back to
// double if an edge function is zero; here Kahan's difference of products gives the sign exactly in
// single precision.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Vector.h"

#include <stdint.h>

namespace rtsl::device {

/// Precomputed values of a ray for the test.
struct TriangleRay {
  Vec3 origin, direction;
  Vec3 inverse;     // 1 / direction by component, for boxes
  int kx, ky, kz;   // kz: the axis along which the direction is longest
  Vec3 turned;      // the origin along these axes
  float sx, sy, sz; // shear and scale, of the direction scaled by 2^-exponent
  int directionExponent;
};

struct TriangleHit {
  float t, u, v; // u, v: weights of vertices 1 and 2
};

/// `direction` must be finite and not zero; of any length.
inline TriangleRay makeTriangleRay(Vec3 origin, Vec3 direction) {
  TriangleRay ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.inverse = {1.0f / direction.x, 1.0f / direction.y, 1.0f / direction.z};
  float x = absolute(direction.x), y = absolute(direction.y), z = absolute(direction.z);
  ray.kz = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
  ray.kx = ray.kz == 2 ? 0 : ray.kz + 1;
  ray.ky = ray.kx == 2 ? 0 : ray.kx + 1;
  ray.turned = {origin[ray.kx], origin[ray.ky], origin[ray.kz]};
  ray.directionExponent = 0;
  float length = largest(direction);
  if (!(length > 0x1p-30f && length < 0x1p30f)) {
    int exponent = exponentOf(length);
    if (exponent < -126) { // denormal: scaled to a normal number first
      direction = direction * 0x1p100f;
      ray.directionExponent = -100;
      exponent = exponentOf(largest(direction));
    }
    // 2^-127 is denormal, so the largest lengths end at 2, not at 1.
    int down = exponent > 126 ? 126 : exponent;
    direction = direction * powerOfTwo(-down);
    ray.directionExponent += down;
  }
  // Three selects, because indexing registers would go through memory.
  float dx = direction[ray.kx], dy = direction[ray.ky], dz = direction[ray.kz];
  ray.sz = 1.0f / dz;
  ray.sx = dx * ray.sz;
  ray.sy = dy * ray.sz;
  return ray;
}

/// a times 2^exponent, rounded once more if the result is denormal; saturates to infinity.
inline float scaledBy(float a, int exponent) {
  while (exponent > 100) {
    a *= 0x1p100f;
    exponent -= 100;
  }
  while (exponent < -100) {
    a *= 0x1p-100f;
    exponent += 100;
  }
  return a * powerOfTwo(exponent);
}

/// The depth of a hit so near that the rounding of the differences would matter, such as at the
/// triangle that a ray leaves. Computed in double, from the plane, times `scale`; exact to some
/// units of itself over the cosine. `depth` is the result if the ray is parallel to the plane.
__attribute__((cold, noinline)) inline float
depthNearOrigin(const TriangleRay &ray, Vec3 v0, Vec3 v1, Vec3 v2, float scale, float depth) {
  int kx = ray.kx, ky = ray.ky, kz = ray.kz;
  double ax = double(v0[kx]) - ray.origin[kx], ay = double(v0[ky]) - ray.origin[ky],
         az = double(v0[kz]) - ray.origin[kz];
  double bx = double(v1[kx]) - v0[kx], by = double(v1[ky]) - v0[ky], bz = double(v1[kz]) - v0[kz];
  double cx = double(v2[kx]) - v0[kx], cy = double(v2[ky]) - v0[ky], cz = double(v2[kz]) - v0[kz];
  double nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  double down = (nx * ray.sx + ny * ray.sy) + nz;
  if (!(down != 0))
    return depth;
  return float(((nx * ax + ny * ay) + nz * az) / down * scale);
}

/// Hits nearer than this share of the triangle's distances are taken from depthNearOrigin: the
/// error of the others is a smaller share of them, unless the ray is within 2^-11 of the triangle's
/// plane.
constexpr float nearShare = 0x1p-9f;

/// Intersects the line of `ray` with the triangle; from both sides, edges and vertices included.
/// The caller compares t, which is in units of the direction given to makeTriangleRay and may have
/// any sign.
inline bool intersectTriangle(const TriangleRay &ray, Vec3 v0, Vec3 v1, Vec3 v2, TriangleHit &hit) {
  Vec3 a = v0 - ray.origin, b = v1 - ray.origin, c = v2 - ray.origin;
  float az = a[ray.kz], bz = b[ray.kz], cz = c[ray.kz];
  float ax = a[ray.kx] - ray.sx * az, ay = a[ray.ky] - ray.sy * az;
  float bx = b[ray.kx] - ray.sx * bz, by = b[ray.ky] - ray.sy * bz;
  float cx = c[ray.kx] - ray.sx * cz, cy = c[ray.ky] - ray.sy * cz;

  // Far from 1 the products would leave the range of a float. Powers of two do not change signs.
  float size =
      maximum(maximum(maximum(absolute(ax), absolute(ay)), maximum(absolute(bx), absolute(by))),
              maximum(absolute(cx), absolute(cy)));
  float depth = maximum(maximum(absolute(az), absolute(bz)), absolute(cz));
  int depthExponent = 0;
  float depthScale = 1;
  if (!(size > 0x1p-30f && size < 0x1p30f)) {
    if (!(size > 0 && size < infinity))
      return false;
    int exponent = exponentOf(size);
    int up = exponent < -100 ? 100 : exponent > 100 ? -100 : -exponent;
    float scale = powerOfTwo(up);
    ax *= scale, ay *= scale, bx *= scale, by *= scale, cx *= scale, cy *= scale;
  }
  if (!(depth > 0x1p-30f && depth < 0x1p30f) && depth != 0) {
    if (!(depth < infinity))
      return false;
    depthExponent = exponentOf(depth);
    depthExponent = depthExponent > 126 ? 126 : depthExponent;
    depthScale = powerOfTwo(-depthExponent);
    az *= depthScale, bz *= depthScale, cz *= depthScale;
  }
  float near = nearShare * (size * depthScale + depth * depthScale);

  float e0 = differenceOfProducts(cx, by, cy, bx);
  float e1 = differenceOfProducts(ax, cy, ay, cx);
  float e2 = differenceOfProducts(bx, ay, by, ax);
  if (!((e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0)))
    return false;
  float determinant = (e0 + e1) + e2;
  if (!(determinant != 0))
    return false;
  float reciprocal = 1.0f / determinant;
  float z = ((e0 * az + e1 * bz) + e2 * cz) * reciprocal;
  if (absolute(z) < near)
    z = depthNearOrigin(ray, v0, v1, v2, depthScale, z);
  float t = z * ray.sz;
  int exponent = depthExponent - ray.directionExponent;
  hit.t = exponent == 0 ? t : scaledBy(t, exponent);
  hit.u = e1 * reciprocal;
  hit.v = e2 * reciprocal;
  return true;
}

} // namespace rtsl::device
