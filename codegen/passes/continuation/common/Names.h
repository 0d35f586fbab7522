//===- Names.h - names of values in the source ----------------------------===//
#pragma once

#include "mlir/IR/Value.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/StringMap.h"

#include <string>

namespace rtsl::continuation {

/// The name of an address or a value: the variable that it was, the member or state variable that
/// it was loaded from, or the operation ("mulf"). Never empty, and the same on every run.
std::string sourceName(mlir::Value value);

/// The variable that the value was in the source; empty if there is none.
std::string authorsName(mlir::Value value);

/// Does the name come from the caller of an inlined function? Then it describes the function's
/// result, not its conditions.
bool isNamedByCaller(mlir::Value value);

/// The value in a message: "`sum`", "`rt_HitPoint`", or "the value computed in line 12" if it has
/// no name in the source.
std::string describeToAuthor(mlir::Value value);

/// Names for values of one function, each unique: the second "sum" is "sum.2".
class UniqueNames {
public:
  /// The name of a value; the same on each call.
  const std::string &of(mlir::Value value);
  /// `name`, with a number if it is taken.
  std::string unique(const std::string &name);

private:
  llvm::DenseMap<mlir::Value, std::string> names;
  llvm::StringMap<unsigned> used;
};

} // namespace rtsl::continuation
