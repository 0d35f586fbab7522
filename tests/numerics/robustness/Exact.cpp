//===- Exact.cpp ----------------------------------------------------------===//
#include "Exact.h"

#include <algorithm>

namespace rtsl::numerics {

Rational ExactHit::smallestWeight() const {
  const Rational w = 1 - u - v;
  return std::min({w, u, v});
}

ExactHit intersectExactly(device::Vec3 origin, device::Vec3 direction, device::Vec3 v0,
                          device::Vec3 v1, device::Vec3 v2) {
  // T. Moller, B. Trumbore, "Fast, minimum storage ray-triangle intersection", 1997: exact here, so
  // any formula is as good.
  const ExactVec3 o(origin), d(direction), a(v0);
  const ExactVec3 e1 = ExactVec3(v1) - a, e2 = ExactVec3(v2) - a, s = o - a;
  const ExactVec3 p = cross(d, e2), q = cross(s, e1);
  ExactHit hit;
  hit.determinant = dot(e1, p);
  if (hit.determinant == 0)
    return hit;
  hit.u = dot(s, p) / hit.determinant;
  hit.v = dot(d, q) / hit.determinant;
  hit.t = dot(e2, q) / hit.determinant;
  return hit;
}

} // namespace rtsl::numerics
