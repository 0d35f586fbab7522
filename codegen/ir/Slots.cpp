#include "codegen/ir/Slots.h"

#include "codegen/ir/Attributes.h"

#include <algorithm>

namespace rtsl::ir {

std::string slotName(llvm::StringRef base, llvm::StringRef method, bool takesPayload) {
  return (base + "." + method + (takesPayload ? ".payload" : "")).str();
}

std::string slotSymbol(llvm::StringRef slot) {
  std::string symbol = "rtsl_" + slot.str();
  std::replace(symbol.begin(), symbol.end(), '.', '_');
  return symbol;
}

void insertForRuntime(mlir::SymbolTable &symbols, mlir::func::FuncOp function) {
  const mlir::StringAttr name = function.getSymNameAttr();
  symbols.insert(function);
  if (function.getSymNameAttr() != name)
    attr::symbol.set(function, name);
}

llvm::StringRef finalSymbol(mlir::func::FuncOp function) {
  const auto symbol = attr::symbol.of(function);
  return symbol ? symbol.getValue() : function.getSymName();
}

llvm::StringRef slotOf(mlir::func::FuncOp function) {
  const auto name = attr::slot.of(function);
  return name ? name.getValue() : llvm::StringRef();
}

mlir::func::FuncOp entryPoint(mlir::ModuleOp module, llvm::StringRef slot) {
  for (auto function : module.getOps<mlir::func::FuncOp>())
    if (slotOf(function) == slot && !attr::state.isOn(function))
      return function;
  return {};
}

} // namespace rtsl::ir
