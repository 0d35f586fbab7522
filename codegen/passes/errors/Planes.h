//===- Planes.h - primitives that a ray meets once at most ----------------===//
//
// A ray that leaves a plane does not meet it again, so what `intersect` reports there is the start
// of the ray, whatever its error. The `intersect` of a plane reports one hit, at
//
//   t = (c - n . RayOrigin) / (n . RayDirection)
//
// where n and c do not depend on the ray: t is then 0 for each origin on the plane. The conditions
// for the hit may be any: parallelograms, disks and triangles are parts of planes.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl {

/// Is this `intersect`, of level 2, that of a plane? False if that is not seen.
bool isOfPlane(mlir::func::FuncOp intersect);

} // namespace rtsl
