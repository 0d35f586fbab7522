//===- PendingValues.h - when a state evaluates its values ----------------===//
//
// The value of an operation is pending until it is used, and is then part of the expression that
// uses it, unless something in between would change it: then it gets a variable before.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"
#include "codegen/cpp/states/statements/Insertion.h"
#include "codegen/ir/MemoryAccesses.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/MapVector.h"

#include <map>

namespace rtsl::cpp {

class PendingValues : StatePart {
public:
  using StatePart::StatePart;

  /// The expression or variable of a value, for one of its uses.
  Code use(mlir::Value value, const Type *type = nullptr);
  /// The same for an expression that has it more than once.
  Code named(mlir::Value value, Statements &out);
  bool isPending(mlir::Value value) const { return pending.count(value) != 0; }
  /// The components that replace others in the value, if it is an insertion; otherwise null.
  const Insertion *insertion(mlir::Value value) const;

  /// The value of an operation becomes pending, or gets a variable.
  void define(mlir::Operation &op, Code code, ir::MemoryAccesses accesses, bool isPure,
              Statements &out);
  /// The same for an operation without effects of its own, made of the operands that were used.
  void make(mlir::Operation &op, Code code, Statements &out);
  /// The same for a value that is the same anywhere in the state.
  void makeAnywhere(mlir::Operation &op, Code code, Statements &out);
  void makeInsertion(mlir::Operation &op, Insertion insertion, Statements &out);

  /// Evaluates pending values that accesses would change, or whose evaluation would change these.
  void flush(const ir::MemoryAccesses &accesses, Statements &out);
  /// To be called before a construct with regions: values that an inner statement would change are
  /// not pending in another region, and a value that is used once is not evaluated in each
  /// iteration of a loop.
  void flushBefore(mlir::Operation &op, Statements &out);

  ir::MemoryAccesses consumed; // by the values used for the operation that is being printed

private:
  struct Pending {
    Code code;
    ir::MemoryAccesses accesses;
    unsigned usesLeft = 0;
    bool isPure = true;     // no effects of its own
    bool isTrivial = false; // may be repeated in the text
  };
  void materialise(mlir::Value value, Statements &out, bool isNew = false);
  bool isReplacedBy(mlir::Value before, mlir::Value value);

  llvm::MapVector<mlir::Value, Pending> pending;
  llvm::DenseMap<mlir::Value, std::string> declared;
  std::map<std::string, mlir::Value> latest; // of the values that have a variable, by wanted name
  llvm::DenseMap<mlir::Value, Insertion> insertions;
};

} // namespace rtsl::cpp
