//===- Slots.h - entry points of a linked program -------------------------===//
//
// Linking adds a function for each slot of language/Slots.def and PayloadSlots.def that the runtime
// calls, and marks it with attr::slot. Passes find these functions by the mark, never by name:
// authors may call their functions what they like.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/SymbolTable.h"

#include <string>

namespace rtsl::ir {

namespace slot {
constexpr llvm::StringLiteral shade = "rt_Material.shade", miss = "rt_Miss.miss",
                              generate = "rt_RayGeneration.generate",
                              closestHitForPayload = "rt_Material.closestHit.payload",
                              missForPayload = "rt_Miss.miss.payload",
                              illumination = "rt_Light.illumination",
                              exception = "rt_Exception.exception",
                              computeBounds = "rt_Primitive.computeBounds",
                              features = "features"; // of no object: RTSL_FEATURE_*
} // namespace slot

/// "rt_Miss.miss", and for rays with a payload "rt_Miss.miss.payload".
std::string slotName(llvm::StringRef base, llvm::StringRef method, bool takesPayload = false);

/// The symbol by which the runtime finds the entry point: `rtsl_rt_Miss_miss_payload`.
std::string slotSymbol(llvm::StringRef slot);

/// Adds a function that the runtime finds by its symbol. If an author's class has that name, the
/// function has another one in the IR, and its own again in machine code.
void insertForRuntime(mlir::SymbolTable &symbols, mlir::func::FuncOp function);

/// The symbol of a function in machine code.
llvm::StringRef finalSymbol(mlir::func::FuncOp function);

/// The slot of an entry point, or of one of its states; empty for other functions.
llvm::StringRef slotOf(mlir::func::FuncOp function);

/// The entry point for a slot; null if the program has none.
mlir::func::FuncOp entryPoint(mlir::ModuleOp module, llvm::StringRef slot);

} // namespace rtsl::ir
