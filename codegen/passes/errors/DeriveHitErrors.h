//===- DeriveHitErrors.h - bounds of t for the primitives of a program ----===//
//
// Adds `Class.rt_boundHitError` (BoundHitError.h) to a module of level 1 before it is linked or
// bound: so the function does not depend on whether it is compiled for a scene or printed as C++,
// and gives the same bits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/errors/BoundHitError.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/ADT/StringRef.h"

#include <string>
#include <vector>

namespace rtsl {

/// The name of the function: a slot of language/Slots.def that authors cannot define.
constexpr llvm::StringLiteral hitErrorMethod = "rt_boundHitError";

struct DerivedHitError {
  std::string className;
  bool hasFunction = false; // some hit has a derived bound
  bool isPlane = false;     // Planes.h
  std::vector<UnboundHit> unbound;
};

/// Derives the function for each of these classes that has an `intersect`. `symbols` is the table
/// of `ir`.
std::vector<DerivedHitError> deriveHitErrors(mlir::ModuleOp ir, mlir::SymbolTable &symbols,
                                             const std::vector<std::string> &classes,
                                             ElementaryErrors elementary);

/// Functions that send rays, directly or through calls. A call through a reference counts if any
/// function sends rays.
llvm::SetVector<mlir::Operation *> functionsThatSendRays(mlir::ModuleOp ir,
                                                         const mlir::SymbolTable &symbols);

} // namespace rtsl
