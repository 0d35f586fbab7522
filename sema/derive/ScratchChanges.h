//===- ScratchChanges.h - how scratch members of a primitive change -------===//
//
// A material on a primitive may use the change across the footprint of what `intersect` writes to
// a scratch member. It is the difference to what `intersect` would write for the ray through the
// neighbouring point of the surface: that ray has the same origin, a direction that differs by
// rt_dUVWdx (the runtime scales it so), and t does not change, to first order. A method of the
// primitive, which the runtime calls at the hit, computes it:
//
//     void intersect() {                    void rt_computeChanges() {
//       float t = -rt_RayOrigin.z             float distance = rt_HitDistance; // the ray's end
//                 / rt_RayDirection.z;        vec2 uv = vec2(0.0);
//       if (hit(t))                           float t = -rt_RayOrigin.z / rt_RayDirection.z;
//         uv = rt_RayOrigin.xy                if (rt_Epsilon < t && t < distance
//              + t * rt_RayDirection.xy;  ==>     ? (distance = t, true) : false)
//     }                                         uv = rt_RayOrigin.xy + t * rt_RayDirection.xy;
//                                             uv_dx = dFdx(uv);
//                                             uv_dy = dFdy(uv);
//                                           }
//
// dFdx and dFdy are then replaced as in any other function. If `intersect` draws random numbers, or
// calls functions that report hits or use scratch members, it cannot be followed: changes are 0.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/derive/Derivation.h"

namespace rtsl::derive {

/// A change that the method computes: a member with typed::Member::changeOf.
using ChangeMembers = std::vector<const typed::Member *>;

/// Can the changes of what `intersect` writes be computed?
bool canFollowScratch(const typed::Function &intersect, typed::EffectsOf &effects);

/// Fills the body of the method, with dFdx and dFdy.
void writeScratchChanges(Derivation &derivation, const typed::Function &intersect,
                         const ChangeMembers &changes, typed::Function &to);

/// The body if they cannot be computed: they are 0.
void writeNoScratchChanges(const typed::Function &intersect, const ChangeMembers &changes,
                           typed::Function &to);

} // namespace rtsl::derive
