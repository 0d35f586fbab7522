//===- Lower.h - from the typed tree to level 1 of the `rtsl` dialect -----===//
//
// Lowering is the last part that sees the source. It decides every operation: in which order
// operands are evaluated, what each built-in function computes and how it rounds, and what an index
// out of range does. docs/language.md says the same for authors.
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
  /// Where messages go, and where the names and lines of locations come from.
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
  /// Leave arithmetic to LLVM IR, which will be widened: see HideConstants.h.
  bool isWidenedLater = false;
  /// Keep expressions whole, for C++: see SourceTable.h. Null: lower them.
  SourceTable *source = nullptr;
  /// Lower these classes only, with the functions that they call. Empty: everything.
  std::set<std::string> classes;
};

/// Lowers a module without errors. Needs `options.diagnostics`. What the rest of the compiler
/// cannot do yet is reported there, with its place; then the result is null. The result passes the
/// verifier.
mlir::OwningOpRef<mlir::ModuleOp> lower(const typed::Module &module, const LowerOptions &options,
                                        mlir::MLIRContext &context);

} // namespace rtsl
