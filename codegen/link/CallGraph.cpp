//===- CallGraph.cpp - what functions call --------------------------------===//
#include "codegen/link/CallGraph.h"

#include "codegen/ir/Rays.h"

#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::linking {

using mlir::func::CallOp;
using mlir::func::FuncOp;

std::vector<FuncOp> reachedFrom(llvm::ArrayRef<FuncOp> from, const mlir::SymbolTable &symbols,
                                FunctionFilter follows) {
  std::vector<FuncOp> reached;
  llvm::SmallPtrSet<mlir::Operation *, 16> seen;
  const auto add = [&](FuncOp function) {
    if (seen.insert(function).second)
      reached.push_back(function);
  };
  llvm::for_each(from, add);
  for (std::size_t i = 0; i < reached.size(); ++i)
    FuncOp(reached[i]).walk([&](CallOp call) {
      auto callee = symbols.lookup<FuncOp>(call.getCallee());
      if (callee && (!follows || follows(callee)))
        add(callee);
    });
  return reached;
}

bool Contains::operator()(mlir::Operation *code) {
  return ir::anyOperation(code, [&](mlir::Operation *op) {
    if (auto call = llvm::dyn_cast<CallOp>(op))
      if (auto callee = symbols.lookup<FuncOp>(call.getCallee())) {
        if (follows && !follows(callee))
          return false;
        return functions.of(callee, [&] { return (*this)(callee.getOperation()); });
      }
    return holds(op);
  });
}

} // namespace rtsl::linking
