#include "codegen/ir/NamedLocation.h"

#include "codegen/ir/Attributes.h"

namespace rtsl::ir {

static constexpr llvm::StringLiteral shortCircuitMark = "short_circuit", builtinMark = "builtin";

static bool isMarked(mlir::Location location, llvm::StringRef mark) {
  auto fused = llvm::dyn_cast<mlir::FusedLoc>(location);
  auto text =
      fused ? llvm::dyn_cast_or_null<mlir::StringAttr>(fused.getMetadata()) : mlir::StringAttr();
  return text && text.getValue() == mark;
}

static mlir::Location marked(mlir::Location location, llvm::StringRef mark) {
  mlir::MLIRContext *context = location->getContext();
  return mlir::FusedLoc::get(context, {location}, mlir::StringAttr::get(context, mark));
}

VariableName nameIn(mlir::Location location) {
  if (auto name = llvm::dyn_cast<mlir::NameLoc>(location))
    return {name.getName().str(), isMarked(name.getChildLoc(), shortCircuitMark)};
  if (isMarked(location, builtinMark))
    return {};
  if (auto fused = llvm::dyn_cast<mlir::FusedLoc>(location))
    for (mlir::Location part : fused.getLocations())
      if (VariableName name = nameIn(part); !name.isEmpty())
        return name;
  if (auto call = llvm::dyn_cast<mlir::CallSiteLoc>(location)) {
    VariableName name = nameIn(call.getCallee());
    return name.isEmpty() ? nameIn(call.getCaller()) : name;
  }
  return {};
}

mlir::Location withName(const VariableName &name, mlir::Location location) {
  return mlir::NameLoc::get(mlir::StringAttr::get(location->getContext(), name.text),
                            name.isOfShortCircuit ? marked(location, shortCircuitMark) : location);
}

mlir::Location withNameOf(VarOp variable, mlir::Location location) {
  if (!variable || llvm::isa<mlir::NameLoc>(location) || isMarked(location, builtinMark))
    return location;
  return withName({variable.getName().str(), attr::shortCircuit.isOn(variable)}, location);
}

mlir::Location builtinLocation(mlir::MLIRContext *context, llvm::StringRef symbol) {
  return marked(mlir::NameLoc::get(mlir::StringAttr::get(context, symbol)), builtinMark);
}

} // namespace rtsl::ir
