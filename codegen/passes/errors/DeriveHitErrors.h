//===- DeriveHitErrors.h - bounds of t for the primitives of a program ----===//
//
// Adds `Class.rt_boundHitError` (BoundHitError.h) to a module of level 1 that nothing has been
// linked or bound in yet: so the function is the same whatever becomes of the module, machine code
// for a scene or C++ for any, and gives the same bits.
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

/// How the function is called: a slot of language/Slots.def that no author can write.
constexpr llvm::StringLiteral hitErrorMethod = "rt_boundHitError";

struct DerivedHitError {
  std::string className;
  bool hasFunction = false; // some hit has a bound that the author does not state
  std::vector<UnboundHit> unbound;
};

/// For each of these classes that has an `intersect`. `symbols` is the table of `ir`.
std::vector<DerivedHitError> deriveHitErrors(mlir::ModuleOp ir, mlir::SymbolTable &symbols,
                                             const std::vector<std::string> &classes,
                                             ElementaryErrors elementary);

/// Functions that send rays, or call some that do. A call through a reference may, if anything
/// does.
llvm::SetVector<mlir::Operation *> functionsThatSendRays(mlir::ModuleOp ir,
                                                         const mlir::SymbolTable &symbols);

} // namespace rtsl
