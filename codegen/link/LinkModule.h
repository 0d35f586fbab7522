//===- LinkModule.h - linking a module without a scene --------------------===//
//
// A module is printed as C++ without a scene. This runs the steps of linking (Link.h) that remove
// nothing, and collects the same facts as for a scene: every class may have objects, every material
// may be on every primitive, and every method may run.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/FloatingPoint.h"
#include "codegen/link/ModuleFacts.h"
#include "frontend/diagnostics/Diagnostics.h"

#include "mlir/IR/BuiltinOps.h"

#include <optional>

namespace rtsl {

/// Links level 1 IR in place and adds the functions of DeriveHitErrors.h. Reports through
/// `diagnostics`; nothing if there were errors. `floatingPoint` is the mode in which the program
/// will be compiled.
std::optional<ModuleFacts> linkModule(mlir::ModuleOp ir, const typed::Module &module,
                                      Diagnostics &diagnostics, FloatingPoint floatingPoint);

} // namespace rtsl
