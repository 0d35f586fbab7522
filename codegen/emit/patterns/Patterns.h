//===- Patterns.h - ops to LLVM, for ConvertToLlvm.cpp --------------------===//
//
// Private to codegen/emit. Memory and references, rays, and numbers have a file each.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Conversion/LLVMCommon/TypeConverter.h"
#include "mlir/Dialect/LLVMIR/LLVMDialect.h"
#include "mlir/Transforms/DialectConversion.h"

namespace rtsl::codegen {

void addMemoryPatterns(mlir::LLVMTypeConverter &converter, mlir::RewritePatternSet &patterns);
void addRayPatterns(mlir::LLVMTypeConverter &converter, mlir::RewritePatternSet &patterns);
void addNumberPatterns(mlir::LLVMTypeConverter &converter, mlir::RewritePatternSet &patterns);

/// A constant record whose class id is 0, for the class of the null reference.
constexpr llvm::StringLiteral nullRecord = "rtsl.null_record";

/// A function of the runtime: has an exception ended the sample of this ray?
constexpr llvm::StringLiteral isAbandonedFunction = "rtsl_is_abandoned";

//===----------------------------------------------------------------------===//
// Helpers of the patterns
//===----------------------------------------------------------------------===//

/// The state of the ray: the first parameter of the function around the insertion point.
mlir::Value rayState(mlir::OpBuilder &builder);

/// `base` + `bytes`, within the same object.
mlir::Value offsetAddress(mlir::OpBuilder &builder, mlir::Location location, mlir::Value base,
                          uint32_t bytes);

/// A load with the alignment of all memory.
mlir::Value loadFrom(mlir::OpBuilder &builder, mlir::Location location, mlir::Type type,
                     mlir::Value address, bool isInvariant);

/// The address of a field of RtslLaunch at this offset. Everything there is constant for a launch.
mlir::Value launchAddress(mlir::OpBuilder &builder, mlir::Location location, uint32_t bytes);

/// A constant of a scalar type, or a vector with it in every component.
mlir::Value constantLike(mlir::OpBuilder &builder, mlir::Location location, mlir::Type type,
                         int64_t value);

/// A stack slot of `size` bytes, at the entry of the function around the insertion point, with the
/// alignment of all memory if none is given.
mlir::Value stackSlot(mlir::OpBuilder &builder, mlir::Location location, uint32_t size,
                      uint32_t alignment = 0);

/// The components of a vector.
llvm::SmallVector<mlir::Value> componentsOf(mlir::OpBuilder &builder, mlir::Location location,
                                            mlir::Value vector);

/// Calls a declared function of the runtime; null if it returns nothing.
mlir::Value callRuntime(mlir::OpBuilder &builder, mlir::Location location, llvm::StringRef name,
                        llvm::ArrayRef<mlir::Value> arguments);

} // namespace rtsl::codegen
