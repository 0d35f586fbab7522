//===- SceneTables.h - constants of a bound program -----------------------===//
//
// A program that was bound to a small scene has its records, instances and emitters as constants:
//
//   module attributes {rtsl.records = array<i32: ...>, rtsl.instances = array<i32: ...>,
//                      rtsl.emitters = array<i32: ...>, rtsl.listed_boxes = array<i32: ...>}
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/LLVMIR/LLVMDialect.h"
#include "mlir/IR/BuiltinOps.h"
#include "llvm/IR/Module.h"

namespace rtsl::codegen {

/// Adds a global variable for each table, and defines rtsl_instances, rtsl_emitters,
/// rtsl_listed_instances, rtsl_listed_boxes, rtsl_listed_pairs and rtsl_mesh_attributes
/// (runtime/device/ray/Abi.h), which otherwise read the launch.
void defineSceneTables(mlir::ModuleOp module);

/// Has the LLVM IR of such a module the records of the scene's objects as constants?
bool hasConstantRecords(const llvm::Module &module);

/// In a function of such a program, the address of the records; null if they are not constants.
mlir::Value sceneRecords(mlir::OpBuilder &builder, mlir::Location location);

} // namespace rtsl::codegen
