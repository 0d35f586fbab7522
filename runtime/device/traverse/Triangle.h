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
#ifdef __NVPTX__
  // All bits are 1 if kz is 0, or 1, otherwise 0: to select components without jumps.
  uint32_t isX, isY;
#endif
};

/// The number for kz = 0, 1, or 2.
#ifdef __NVPTX__
inline float numberFor(const TriangleRay &ray, float x, float y, float z) {
  return floatOf((bitsOf(x) & ray.isX) |
                 (((bitsOf(y) & ray.isY) | (bitsOf(z) & ~ray.isY)) & ~ray.isX));
}
#endif

/// A vector's components along kx, ky and kz.
inline Vec3 alongRay(const TriangleRay &ray, Vec3 v) {
#ifdef __NVPTX__
  return {numberFor(ray, v.y, v.z, v.x), numberFor(ray, v.z, v.x, v.y),
          numberFor(ray, v.x, v.y, v.z)};
#else
  return {v[ray.kx], v[ray.ky], v[ray.kz]};
#endif
}

struct TriangleHit {
  float t, u, v; // u, v: weights of vertices 1 and 2
  bool isBack;   // the ray goes along the normal, as the signs of the edge functions say
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
#ifdef __NVPTX__
  ray.isX = ray.kz == 0 ? ~0u : 0u;
  ray.isY = ray.kz == 1 ? ~0u : 0u;
  asm("" : "+r"(ray.isX), "+r"(ray.isY)); // or the compiler would make jumps of them again
#endif
  ray.turned = alongRay(ray, origin);
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
  const Vec3 turned = alongRay(ray, direction);
  ray.sz = 1.0f / turned.z;
  ray.sx = turned.x * ray.sz;
  ray.sy = turned.y * ray.sz;
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
__attribute__((cold, pure, noinline)) inline float
depthNearOrigin(const TriangleRay &ray, Vec3 v0, Vec3 v1, Vec3 v2, float scale, float depth) {
  const Vec3 o = dependingOn(v0.x, alongRay(ray, ray.origin)),
             shear = dependingOn(v0.x, {ray.sx, ray.sy, 0});
  const Vec3 a = alongRay(ray, v0), b = alongRay(ray, v1), c = alongRay(ray, v2);
  double ax = double(a.x) - o.x, ay = double(a.y) - o.y, az = double(a.z) - o.z;
  double bx = double(b.x) - a.x, by = double(b.y) - a.y, bz = double(b.z) - a.z;
  double cx = double(c.x) - a.x, cy = double(c.y) - a.y, cz = double(c.z) - a.z;
  double nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  double down = (nx * shear.x + ny * shear.y) + nz;
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
  const Vec3 a = alongRay(ray, v0 - ray.origin), b = alongRay(ray, v1 - ray.origin),
             c = alongRay(ray, v2 - ray.origin);
  float az = a.z, bz = b.z, cz = c.z;
  float ax = a.x - ray.sx * az, ay = a.y - ray.sy * az;
  float bx = b.x - ray.sx * bz, by = b.y - ray.sy * bz;
  float cx = c.x - ray.sx * cz, cy = c.y - ray.sy * cz;

  // Far from 1 the products would leave the range of a float. Powers of two do not change signs.
  // Where one of them is NaN, two of the edge functions are.
  float size =
      raised(raised(raised(absolute(ax), absolute(ay)), raised(absolute(bx), absolute(by))),
             raised(absolute(cx), absolute(cy)));
  float depth = raised(raised(absolute(az), absolute(bz)), absolute(cz));
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
  hit.isBack = (determinant < 0) != (ray.sz < 0);
  return true;
}

} // namespace rtsl::device
