//===- Insertion.h - a vector with components replaced --------------------===//
#pragma once

#include "codegen/cpp/tree/Expression.h"

#include "mlir/IR/Value.h"

namespace rtsl::cpp {

/// Components of a vector that are replaced one after the other.
struct Insertion {
  struct Part {
    std::optional<std::size_t> component; // nothing: the one at `index`
    Code index, value;
  };
  mlir::Value before; // all of them
  Code vector;        // that, in C++
  std::vector<Part> parts;
  Code code() const; // `rtsl::with<0>(v, value)`
  /// `v.x`
  static Code lvalue(const Code &vector, const Part &part);
};

} // namespace rtsl::cpp
