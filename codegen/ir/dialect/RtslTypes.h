//===- RtslTypes.h - types of the `rtsl` dialect --------------------------===//
//
// Also the predicates on types that the ops, the lowering and the passes use.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_CODEGEN_IR_RTSL_TYPES_H // not `#pragma once`: see Precompiled.h
#define RTSL_CODEGEN_IR_RTSL_TYPES_H

#include "mlir/IR/BuiltinTypes.h"
#include "mlir/IR/Types.h"
#include "mlir/Interfaces/MemorySlotInterfaces.h"

#include <optional>

#define GET_TYPEDEF_CLASSES
#include "codegen/ir/dialect/RtslTypes.h.inc"

namespace rtsl::ir {

/// f32, i32 or i1.
bool isScalar(mlir::Type type);
/// f64, or a vector of 1 to 16 of them: in double precision bounds of errors are computed, whose
/// variables alone may have such types.
bool isWide(mlir::Type type);
/// A scalar, a vector of 1 to 16 scalars, a reference, or one that isWide: the SSA values that can
/// be stored.
bool isValueType(mlir::Type type);
/// Numbers, and structs and arrays of them: excludes values that are valid in one process or one
/// scene only.
bool isNumbers(mlir::Type type);
/// Whether members, elements and fields may have it: a value type, or an aggregate of such. A
/// `!rtsl.ptr` points to these, or to a variable that isWide.
bool isStorable(mlir::Type type);
inline bool isRef(mlir::Type type) {
  return llvm::isa<RefType>(type);
}
inline bool isPtr(mlir::Type type) {
  return llvm::isa<PtrType>(type);
}
bool isFloatOrVector(mlir::Type type);
bool isIntOrVector(mlir::Type type);
bool isColor(mlir::Type type);
bool isVec3(mlir::Type type);
bool isPtrToValue(mlir::Type type);

template <typename T>
bool isPtrTo(mlir::Type type) {
  auto pointer = llvm::dyn_cast<PtrType>(type);
  return pointer && llvm::isa<T>(pointer.getPointee());
}

/// i32, or the vector of i32 that has the shape of `type`.
mlir::Type intLike(mlir::Type type);

/// Number of scalars, vectors and references in a storable type; a buffer counts as one.
unsigned leafCount(mlir::Type type);

} // namespace rtsl::ir

#endif
