//===- CallGraph.h - what functions call ----------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/STLFunctionalExtras.h"

namespace rtsl::linking {

using FunctionFilter = llvm::function_ref<bool(mlir::func::FuncOp)>;

/// The functions `from` and all their direct and indirect callees for which `follows` holds, if it
/// is given; in the order in which they are found.
std::vector<mlir::func::FuncOp> reachedFrom(llvm::ArrayRef<mlir::func::FuncOp> from,
                                            const mlir::SymbolTable &symbols,
                                            FunctionFilter follows = nullptr);

/// A property of functions that depends on that of their callees. It is computed once for each
/// function; in a cycle of calls it is false where it is still being computed.
class FunctionProperty {
public:
  template <typename Compute>
  bool of(mlir::func::FuncOp function, Compute &&compute) {
    const auto [known, isNew] = values.try_emplace(function, false);
    return isNew ? values[function] = compute() : known->second;
  }

private:
  llvm::DenseMap<mlir::Operation *, bool> values;
};

/// Whether code contains an operation for which `holds` holds, itself or in functions that it calls
/// and for which `follows` holds, if it is given.
class Contains {
public:
  Contains(const mlir::SymbolTable &symbols, llvm::function_ref<bool(mlir::Operation *)> holds,
           FunctionFilter follows = nullptr)
      : symbols(symbols), holds(holds), follows(follows) {}

  bool operator()(mlir::Operation *code);

private:
  const mlir::SymbolTable &symbols;
  llvm::function_ref<bool(mlir::Operation *)> holds;
  FunctionFilter follows;
  FunctionProperty functions;
};

} // namespace rtsl::linking
