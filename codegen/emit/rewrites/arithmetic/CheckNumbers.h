//===- CheckNumbers.h - where a number stops being finite ------------------===//
//
// For finding out why a sample is infinite or not a number (runtime/program/NumberCheck.h): every
// number that a shader computes is passed to rtsl_check_number, with its operands, and every number
// that it stores to rtsl_check_stored_number, each with the number of its source location. The bits
// do not change. Nothing may have been folded before (codegen/lower/HideConstants.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Error.h"

#include <vector>

namespace mlir {
class ModuleOp;
} // namespace mlir

namespace rtsl::codegen {

/// Runs on a module of the LLVM dialect. Adds the source locations, by number, to `places`.
void checkNumbers(mlir::ModuleOp module, std::vector<Place> &places);

} // namespace rtsl::codegen
