//===- NamedLocation.h - names of variables in locations ------------------===//
//
// A value that was a variable of the source has that variable's name in its location. Two kinds of
// names are marked, so that they cannot be taken for an author's: those of variables for the
// results of `&&` and `||` (attr::shortCircuit), and those of built-in functions, which name no
// variable.
//
//   loc("sum"("glass.rtsl":4:7))
//   loc("both"(fused<"short_circuit">["glass.rtsl":4:7]))
//   loc(fused<"builtin">["rtsl.cross.vec3"])
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include "mlir/IR/Location.h"

#include <string>

namespace rtsl::ir {

struct VariableName {
  std::string text; // empty: there is none
  bool isOfShortCircuit = false;

  bool isEmpty() const { return text.empty(); }
  bool operator==(const VariableName &other) const {
    return text == other.text && isOfShortCircuit == other.isOfShortCircuit;
  }
};

/// The name in a location. In inlined code, the name within the function is preferred to that of
/// the variable that gets its result.
VariableName nameIn(mlir::Location location);

/// The location with another name.
mlir::Location withName(const VariableName &name, mlir::Location location);

/// The location of a value that was promoted from the variable: with its name, unless it has one or
/// is in a built-in function.
mlir::Location withNameOf(VarOp variable, mlir::Location location);

/// The location of code of a built-in function.
mlir::Location builtinLocation(mlir::MLIRContext *context, llvm::StringRef symbol);

} // namespace rtsl::ir
