//===- DeclareSlots.cpp - a unit without a scene --------------------------===//
//
// A file that is compiled alone calls unknown methods through references: each slot becomes the
// declaration of a function, `@dispatch.rt_Texture.lookup`, which a linker supplies. Attributes get
// separate offsets, and ray types numbers, in the order of first use.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Layout.h"
#include "codegen/link/steps/Steps.h"

#include "llvm/ADT/DenseMap.h"

namespace rtsl {

void declareSlots(mlir::ModuleOp ir) {
  llvm::DenseMap<std::tuple<mlir::StringAttr, mlir::Type, mlir::Attribute>, std::uint32_t> places;
  std::uint32_t words = 0;
  ir.walk([&](ir::AttributeOp op) {
    const mlir::Type type = mlir::cast<ir::PtrType>(op.getType()).getPointee();
    const auto [place, isNew] =
        places.try_emplace({op.getNameAttr(), type, op.getAxisAttr()}, words);
    if (isNew)
      words += ir::sizeInBytes(type) / 4;
    op.setOffset(place->second);
  });
  linking::numberRayTypes(ir);
  mlir::SymbolTable symbols(ir);
  linking::replaceSlots(
      ir, symbols, [](ir::CallMethodOp call) { return linking::slotOf(call).name(); },
      [](ir::CallMethodOp, mlir::func::FuncOp declaration) { declaration.setPrivate(); });
}

} // namespace rtsl
