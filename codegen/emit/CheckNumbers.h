//===- CheckNumbers.h - where a number stops being finite ------------------===//
//
// For programs that find out why a sample is infinite or not a number
// (runtime/program/NumberCheck.h): every number that a shader computes or stores goes through a
// call of rtsl_check_number, with what it was computed from and the number of its place in the
// source. The bits are the same.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Error.h"

#include <vector>

namespace mlir {
class ModuleOp;
} // namespace mlir

namespace rtsl::codegen {

/// On a module of the LLVM dialect. Adds the places, by number, to `places`.
void checkNumbers(mlir::ModuleOp module, std::vector<Place> &places);

} // namespace rtsl::codegen
