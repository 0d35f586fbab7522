//===- ExpandCopies.cpp - small copies as loads and stores ----------------===//
#include "codegen/passes/variables/ExpandCopies.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Pass/Pass.h"

namespace rtsl::codegen {

using mlir::Location;
using mlir::OpBuilder;
using mlir::Value;

namespace {

constexpr unsigned mostLeaves = 64;

bool holdsBuffer(mlir::Type type) {
  if (auto array = llvm::dyn_cast<ir::ArrayType>(type))
    return holdsBuffer(array.getElement());
  if (auto structure = llvm::dyn_cast<ir::StructType>(type))
    return llvm::any_of(structure.getFieldTypes(), holdsBuffer);
  return llvm::isa<ir::BufferType>(type);
}

bool isSmall(mlir::Type type) {
  return ir::leafCount(type) <= mostLeaves && !holdsBuffer(type);
}

/// In C++ output, where expressions are kept whole, variables are too, except payloads: passes
/// track their fields.
bool staysWhole(Value address) {
  address = ir::baseAddress(address);
  if (llvm::isa_and_nonnull<ir::PayloadOp>(address.getDefiningOp()))
    return false;
  return llvm::none_of(address.getUsers(), llvm::IsaPred<ir::TracePayloadOp>);
}

/// Calls `visit` with the addresses of each leaf of the type that `addresses` point to, which is
/// the same for all of them.
void forEachLeaf(OpBuilder &builder, Location location, llvm::ArrayRef<Value> addresses,
                 llvm::function_ref<void(llvm::ArrayRef<Value>)> visit) {
  mlir::Type type = ir::pointee(addresses.front());
  llvm::SmallVector<Value, 2> parts;
  if (auto structure = llvm::dyn_cast<ir::StructType>(type)) {
    for (mlir::StringAttr field : structure.getFieldNames()) {
      parts.clear();
      for (Value address : addresses)
        parts.push_back(ir::FieldOp::create(builder, location, address, field.getValue()));
      forEachLeaf(builder, location, parts, visit);
    }
  } else if (auto array = llvm::dyn_cast<ir::ArrayType>(type)) {
    for (unsigned element = 0; element < array.getLength(); ++element) {
      parts.clear();
      Value index = mlir::arith::ConstantOp::create(
          builder, location, builder.getI32IntegerAttr(static_cast<int32_t>(element)));
      for (Value address : addresses)
        parts.push_back(ir::ElementOp::create(builder, location, address, index));
      forEachLeaf(builder, location, parts, visit);
    }
  } else {
    visit(addresses);
  }
}

struct ExpandCopies : mlir::PassWrapper<ExpandCopies, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ExpandCopies)
  llvm::StringRef getArgument() const override { return "rtsl-expand-copies"; }
  llvm::StringRef getDescription() const override {
    return "replaces small copies by loads and stores of their leaves";
  }

  void runOnOperation() override {
    OpBuilder builder(&getContext());
    auto module = getOperation()->getParentOfType<mlir::ModuleOp>();
    const bool isForCpp = module && ir::attr::source.isOn(module);
    getOperation().walk([&](ir::CopyOp copy) {
      if (!isSmall(ir::pointee(copy.getSource())) ||
          (isForCpp && staysWhole(copy.getSource()) && staysWhole(copy.getTarget())))
        return;
      builder.setInsertionPoint(copy);
      forEachLeaf(builder, copy.getLoc(), {copy.getSource(), copy.getTarget()},
                  [&](llvm::ArrayRef<Value> leaf) {
                    Value value = ir::LoadOp::create(builder, copy.getLoc(), leaf[0]);
                    ir::StoreOp::create(builder, copy.getLoc(), value, leaf[1]);
                  });
      copy.erase();
    });
    getOperation().walk([&](ir::ClearOp clear) {
      if (!isSmall(ir::pointee(clear.getAddress())) || (isForCpp && staysWhole(clear.getAddress())))
        return;
      builder.setInsertionPoint(clear);
      forEachLeaf(builder, clear.getLoc(), {clear.getAddress()}, [&](llvm::ArrayRef<Value> leaf) {
        Value zero = ir::createZero(builder, clear.getLoc(), ir::pointee(leaf[0]));
        ir::StoreOp::create(builder, clear.getLoc(), zero, leaf[0]);
      });
      clear.erase();
    });
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createExpandCopiesPass() {
  return std::make_unique<ExpandCopies>();
}

} // namespace rtsl::codegen
