//===- Lower.h - from the typed tree to level 1 of the `rtsl` dialect -----===//
//
// Lowering is the last stage that uses the source. It determines every operation: the order in
// which operands are evaluated, what each built-in function computes and how it rounds, and the
// effect of an index out of range. docs/language.md specifies the same for authors.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/lower/SourceTable.h"
#include "frontend/diagnostics/Diagnostics.h"
#include "sema/typed/TypedAst.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/OwningOpRef.h"

#include <cstdint>
#include <set>
#include <string>

namespace rtsl {

struct LowerOptions {
  /// Receives messages, and supplies the names and lines of locations.
  Diagnostics *diagnostics = nullptr;
  /// Components of a color, 1 to RTSL_MAX_COLOR. 3 is RGB, 1 is luminance, more is a spectrum (see
  /// Color.h).
  std::uint32_t colorComponents = 3;
  /// Clamp indices that are not constant into the array, vector or buffer; an element of an empty
  /// buffer reads as zero. Without, such an index is undefined behaviour.
  bool checkIndices = true;
  /// An index out of range is an exception too; `print` prints. Without, `print` does nothing, and
  /// its arguments are not evaluated.
  bool raisesExceptions = false, prints = false;
  /// Leave arithmetic to LLVM IR: see HideConstants.h. It will also be widened.
  bool hidesConstants = false, isWidenedLater = false;
  /// Keep expressions whole, for C++: see SourceTable.h. Null: lower them.
  SourceTable *source = nullptr;
  /// Lower these classes only, with the functions that they call. Empty: everything.
  std::set<std::string> classes;
};

/// Lowers a module without errors. Needs `options.diagnostics`. A construct that the rest of the
/// compiler does not support yet is reported there; then the result is null. The result passes the
/// verifier.
mlir::OwningOpRef<mlir::ModuleOp> lower(const typed::Module &module, const LowerOptions &options,
                                        mlir::MLIRContext &context);

} // namespace rtsl
