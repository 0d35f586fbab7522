//===- ValueNames.h - names of values and variables of a state ------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPrinter.h"
#include "codegen/cpp/states/Machine.h"
#include "codegen/lower/SourceTable.h"

#include "llvm/ADT/DenseMap.h"

namespace rtsl::cpp {

/// A readable name for a value: the author's, or one after the operation that makes it.
std::string nameFor(mlir::Value value);
/// A name of the IR as C++ writes it: `m[0]` is m0, `ray.origin` ray_origin, and the state's
/// `HitPoint` hitPoint.
std::string spelling(const Machine &machine, llvm::StringRef name);

/// The names in one state; each is used for one variable.
class ValueNames {
public:
  ValueNames(Context &context, const SourceTable &source, const Machine &machine,
             FunctionPrinter &functions);

  /// A name that nothing else in the state has.
  std::string fresh(const std::string &wanted);
  const std::string &of(ir::VarOp variable);
  /// nameFor(), or the name of its field in the frame.
  std::string ofValue(mlir::Value value);
  /// A name for what has the scope of one statement, to be released after it.
  std::string ofLights();
  void release(const std::string &name) { taken.erase(name); }

private:
  bool isReservedHere(const std::string &name) const {
    return reserved.count(name) || context.namesInFile().count(name);
  }

  Context &context;
  const SourceTable &source;
  const Machine &machine;
  FunctionPrinter &functions;
  std::set<std::string> taken, reserved;
  llvm::DenseMap<mlir::Operation *, std::string> variables;
};

} // namespace rtsl::cpp
