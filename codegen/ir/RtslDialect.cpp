//===- RtslDialect.cpp - the `rtsl` dialect itself ------------------------===//
#include "codegen/ir/RtslDialect.h"

#include "codegen/ir/RtslOps.h"
#include "codegen/ir/RtslTypes.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlow.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/DialectImplementation.h"
#include "mlir/Transforms/InliningUtils.h"
#include "llvm/ADT/TypeSwitch.h"

#include "codegen/ir/RtslDialect.cpp.inc"
#include "codegen/ir/RtslEnums.cpp.inc"

#define GET_ATTRDEF_CLASSES
#include "codegen/ir/RtslAttributes.cpp.inc"

namespace rtsl::ir {

namespace {

/// Calls are inlined on level 2, where every op may go anywhere. The structured ops of level 1 may
/// not: their `rtsl.return` belongs to the function that they stand in.
struct RtslInliner : mlir::DialectInlinerInterface {
  using DialectInlinerInterface::DialectInlinerInterface;

  bool isLegalToInline(mlir::Operation *op, mlir::Region *, bool,
                       mlir::IRMapping &) const override {
    return !mlir::isa<IfOp, LoopOp, SwitchOp, IlluminanceOp, ReturnOp>(op);
  }
};

} // namespace

void RtslDialect::initialize() {
  registerTypes();
  addAttributes<
#define GET_ATTRDEF_LIST
#include "codegen/ir/RtslAttributes.cpp.inc"
      >();
  addOperations<
#define GET_OP_LIST
#include "codegen/ir/RtslOps.cpp.inc"
      >();
  addInterfaces<RtslInliner>();
}

mlir::Operation *RtslDialect::materializeConstant(mlir::OpBuilder &builder, mlir::Attribute value,
                                                  mlir::Type type, mlir::Location location) {
  return mlir::arith::ConstantOp::materialize(builder, value, type, location);
}

/// The attributes of functions that have a meaning to passes.
mlir::LogicalResult RtslDialect::verifyOperationAttribute(mlir::Operation *op,
                                                          mlir::NamedAttribute attribute) {
  llvm::StringRef name = attribute.getName();
  bool isText = mlir::isa<mlir::StringAttr>(attribute.getValue());
  bool isUnit = mlir::isa<mlir::UnitAttr>(attribute.getValue());
  if ((name == "rtsl.class" || name == "rtsl.method") && !isText)
    return op->emitOpError() << "`" << name << "` is to be a string";
  if ((name == "rtsl.constructor" || name == "rtsl.export" || name == "rtsl.noinline" ||
       name == "rtsl.states") &&
      !isUnit)
    return op->emitOpError() << "`" << name << "` takes no value";
  return mlir::success();
}

} // namespace rtsl::ir
