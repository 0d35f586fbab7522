//===- Patterns.cpp - helpers of the patterns -----------------------------===//
#include "codegen/emit/patterns/Patterns.h"

#include "codegen/ir/Layout.h"
#include "runtime/device/ray/State.h"

#include "mlir/Interfaces/FunctionInterfaces.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;
using mlir::Location;
using mlir::OpBuilder;
using mlir::Value;

static mlir::FunctionOpInterface functionAround(OpBuilder &builder) {
  mlir::Operation *op = builder.getInsertionBlock()->getParentOp();
  auto function = llvm::dyn_cast<mlir::FunctionOpInterface>(op);
  return function ? function : op->getParentOfType<mlir::FunctionOpInterface>();
}

Value rayState(OpBuilder &builder) {
  return functionAround(builder).getFunctionBody().front().getArgument(0);
}

Value offsetAddress(OpBuilder &builder, Location location, Value base, uint32_t bytes) {
  if (bytes == 0)
    return base;
  return LLVM::GEPOp::create(builder, location, base.getType(), builder.getI8Type(), base,
                             llvm::ArrayRef<LLVM::GEPArg>{static_cast<int32_t>(bytes)},
                             LLVM::GEPNoWrapFlags::inbounds | LLVM::GEPNoWrapFlags::nuw);
}

Value loadFrom(OpBuilder &builder, Location location, mlir::Type type, Value address,
               bool isInvariant) {
  return LLVM::LoadOp::create(builder, location, type, address, ir::memoryAlignment,
                              /*isVolatile=*/false, /*isNonTemporal=*/false, isInvariant);
}

Value launchAddress(OpBuilder &builder, Location location, uint32_t bytes) {
  mlir::Type pointer = LLVM::LLVMPointerType::get(builder.getContext());
  Value field = offsetAddress(builder, location, rayState(builder), offsetof(RtslState, launch));
  // Not invariant, nor of an invariant group: the device code has states in local variables, and
  // LLVM may move such a load before the store of the launch.
  Value launch = LLVM::LoadOp::create(builder, location, pointer, field, alignof(void *));
  return offsetAddress(builder, location, launch, bytes);
}

Value constantLike(OpBuilder &builder, Location location, mlir::Type type, int64_t value) {
  mlir::Type element = mlir::getElementTypeOrSelf(type);
  mlir::TypedAttr attribute =
      llvm::isa<mlir::FloatType>(element)
          ? mlir::TypedAttr(builder.getFloatAttr(element, static_cast<double>(value)))
          : mlir::TypedAttr(builder.getIntegerAttr(element, value));
  if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
    attribute = mlir::DenseElementsAttr::get(vector, mlir::Attribute(attribute));
  return LLVM::ConstantOp::create(builder, location, type, attribute);
}

Value stackSlot(OpBuilder &builder, Location location, uint32_t size, uint32_t alignment) {
  mlir::Block &entry = functionAround(builder).getFunctionBody().front();
  OpBuilder::InsertionGuard guard(builder);
  builder.setInsertionPointToStart(&entry);
  mlir::Type pointer = LLVM::LLVMPointerType::get(builder.getContext());
  mlir::Type bytes = LLVM::LLVMArrayType::get(builder.getI8Type(), size);
  Value one = LLVM::ConstantOp::create(builder, location, builder.getI32IntegerAttr(1));
  return LLVM::AllocaOp::create(builder, location, pointer, bytes, one,
                                std::max(alignment, ir::memoryAlignment));
}

llvm::SmallVector<Value> componentsOf(OpBuilder &builder, Location location, Value vector) {
  auto type = llvm::cast<mlir::VectorType>(vector.getType());
  llvm::SmallVector<Value> components;
  for (int64_t index = 0; index < type.getNumElements(); ++index) {
    Value position = LLVM::ConstantOp::create(builder, location, builder.getI64IntegerAttr(index));
    components.push_back(LLVM::ExtractElementOp::create(builder, location, vector, position));
  }
  return components;
}

Value callRuntime(OpBuilder &builder, Location location, llvm::StringRef name,
                  llvm::ArrayRef<Value> arguments) {
  auto module = functionAround(builder)->getParentOfType<mlir::ModuleOp>();
  auto function = module.lookupSymbol<LLVM::LLVMFuncOp>(name);
  auto call = LLVM::CallOp::create(builder, location, function, arguments);
  return call.getNumResults() ? call.getResult() : Value();
}

} // namespace rtsl::codegen
