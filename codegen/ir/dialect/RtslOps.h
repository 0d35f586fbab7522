//===- RtslOps.h - operations of the `rtsl` dialect -----------------------===//
#ifndef RTSL_CODEGEN_IR_RTSL_OPS_H // not `#pragma once`: see Precompiled.h
#define RTSL_CODEGEN_IR_RTSL_OPS_H

#include "codegen/ir/dialect/RtslTypes.h"

#include "mlir/IR/Builders.h"
#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/OpDefinition.h"
#include "mlir/IR/OpImplementation.h"
#include "mlir/IR/SymbolTable.h"
#include "mlir/Interfaces/ControlFlowInterfaces.h"
#include "mlir/Interfaces/InferTypeOpInterface.h"
#include "mlir/Interfaces/MemorySlotInterfaces.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"

#include "codegen/ir/dialect/RtslEnums.h.inc"

#define GET_ATTRDEF_CLASSES
#include "codegen/ir/dialect/RtslAttributes.h.inc"

namespace rtsl::ir {
class MemberDeclOp;

/// The frame, in which values survive a trace, as a resource of memory effects.
struct FrameResource : mlir::SideEffects::Resource::Base<FrameResource> {
  llvm::StringRef getName() final { return "Frame"; }
};
/// The value of an elementary function of one argument or two.
float evaluate(Elementary function, llvm::ArrayRef<float> x);

/// What the address, of a !rtsl.ptr, points to.
mlir::Type pointee(mlir::Value address);

} // namespace rtsl::ir

#define GET_OP_CLASSES
#include "codegen/ir/dialect/RtslOps.h.inc"

namespace rtsl::ir {

/// The root of a class that derives from no rt_ class (typed::helperRoot).
constexpr llvm::StringLiteral helperRoot = "helper class";

/// Zero of a value type: `arith.constant` or `rtsl.null_ref`.
mlir::Value createZero(mlir::OpBuilder &builder, mlir::Location location, mlir::Type type);

} // namespace rtsl::ir

#endif
