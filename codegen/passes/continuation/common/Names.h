//===- Names.h - what values are called in the source ---------------------===//
#pragma once

#include "mlir/IR/Value.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/StringMap.h"

#include <string>

namespace rtsl::continuation {

/// The name that an address or a value goes by: the variable that it was (a NameLoc), the member or
/// state variable that it was read from, or what made it ("mulf"). Never empty, and the same on
/// every run.
std::string sourceName(mlir::Value value);

/// The variable that the value was; empty if it was none of the author's.
std::string authorsName(mlir::Value value);

/// Is that name of what an inlined function was called for? It fits what the function returns, and
/// not its conditions.
bool isNamedByCaller(mlir::Value value);

/// What a message calls the value: "`sum`", "`rt_HitPoint`", or "what line 12 computes" where the
/// author gave no name.
std::string describeToAuthor(mlir::Value value);

/// Names for values of one function, each different: the second "sum" is "sum.2".
class UniqueNames {
public:
  /// The name of a value; the same each time it is asked.
  const std::string &of(mlir::Value value);
  /// `name`, or that with a number if it is taken.
  std::string unique(const std::string &name);

private:
  llvm::DenseMap<mlir::Value, std::string> names;
  llvm::StringMap<unsigned> used;
};

} // namespace rtsl::continuation
