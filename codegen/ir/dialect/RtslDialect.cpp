//===- RtslDialect.cpp - the `rtsl` dialect itself ------------------------===//
#include "codegen/ir/dialect/RtslDialect.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/dialect/RtslOps.h"
#include "codegen/ir/dialect/RtslTypes.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlow.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/DialectImplementation.h"
#include "mlir/Transforms/InliningUtils.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/ADT/TypeSwitch.h"

#include "codegen/ir/dialect/RtslDialect.cpp.inc"
#include "codegen/ir/dialect/RtslEnums.cpp.inc"

#define GET_ATTRDEF_CLASSES
#include "codegen/ir/dialect/RtslAttributes.cpp.inc"

namespace rtsl::ir {

namespace {

/// Calls are inlined on level 2, where every op may be moved to any function. The structured ops of
/// level 1 may not: their `rtsl.return` returns from the enclosing function.
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
#include "codegen/ir/dialect/RtslAttributes.cpp.inc"
      >();
  addOperations<
#define GET_OP_LIST
#include "codegen/ir/dialect/RtslOps.cpp.inc"
      >();
  addInterfaces<RtslInliner>();
}

mlir::Operation *RtslDialect::materializeConstant(mlir::OpBuilder &builder, mlir::Attribute value,
                                                  mlir::Type type, mlir::Location location) {
  return mlir::arith::ConstantOp::materialize(builder, value, type, location);
}

namespace {

/// A record of RtslDiscardableAttributes.td.
struct DeclaredAttribute {
  bool (*isOfKind)(mlir::Attribute);
  llvm::StringRef rule;       // of its kind
  llvm::StringRef operations; // that may have it, separated by ", "
};

template <typename Value>
bool isOfKind(mlir::Attribute attribute) {
  return llvm::isa<Value>(attribute);
}

const llvm::StringMap<DeclaredAttribute> &declaredAttributes() {
  static const llvm::StringMap<DeclaredAttribute> attributes = {
#define RTSL_ATTRIBUTE(Constant, Word, Class, Rule, Operations)                                    \
  {attr::Constant.name, {isOfKind<mlir::Class>, Rule, Operations}},
#include "codegen/ir/dialect/RtslDiscardableAttributes.inc"
  };
  return attributes;
}

/// Is `name` in a list whose elements are separated by ", "?
bool lists(llvm::StringRef names, llvm::StringRef name) {
  while (!names.empty()) {
    const auto [first, others] = names.split(", ");
    if (first == name)
      return true;
    names = others;
  }
  return false;
}

} // namespace

/// Rejects undeclared names and attributes of other operations: they would be silently ignored.
mlir::LogicalResult RtslDialect::verifyOperationAttribute(mlir::Operation *op,
                                                          mlir::NamedAttribute attribute) {
  const llvm::StringRef name = attribute.getName();
  const auto declared = declaredAttributes().find(name);
  if (declared == declaredAttributes().end())
    return op->emitOpError() << "has the attribute `" << name
                             << "`, which the dialect does not declare";
  const auto &[isOfKind, rule, operations] = declared->second;
  if (!lists(operations, op->getName().getStringRef()))
    return op->emitOpError() << "may not have `" << name << "`, an attribute of " << operations;
  if (!isOfKind(attribute.getValue()))
    return op->emitOpError() << "`" << name << "` " << rule;
  return mlir::success();
}

} // namespace rtsl::ir
