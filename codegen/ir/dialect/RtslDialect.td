//===- RtslDialect.td - the `rtsl` dialect --------------------------------===//
#ifndef RTSL_DIALECT_TD
#define RTSL_DIALECT_TD

include "mlir/IR/DialectBase.td"

def Rtsl_Dialect : Dialect {
  let name = "rtsl";
  let cppNamespace = "::rtsl::ir";
  let summary = "shaders for one ray";
  let description = [{
    The IR of the shading language. It has two levels in one dialect.

    **Level 1** is structured and keeps the author's names: variables are `rtsl.var`, control flow
    is `rtsl.if`, `rtsl.loop`, `rtsl.switch` and `rtsl.illuminance` with `rtsl.break`,
    `rtsl.continue` and `rtsl.return`. **Level 2** is SSA over `cf`: no structured ops, and
    variables only where an address is needed.

    Values are scalars (`f32`, `i32`, `i1`), vectors of them, and references to objects of the
    scene. Integers carry no sign; the op does. A `color` is a `vector<Kxf32>` with K chosen when a
    program is lowered. Aggregates (structs, arrays, matrices, buffers) are never values: they are
    in memory, have an address of type `!rtsl.ptr`, and are accessed by `rtsl.field`, `rtsl.element`
    and `rtsl.buffer_element`.

    Functions are `func.func`. The state of the ray is a parameter of each, which becomes explicit
    only in LLVM IR. Methods have the discardable attributes `rtsl.class = "Glass"` and `rtsl.method
    = "shade"`; RtslDiscardableAttributes.td declares these and all others, on functions and other
    operations, and the verifier rejects any that are not declared there.
  }];
  let useDefaultTypePrinterParser = 1;
  let useDefaultAttributePrinterParser = 1;
  let hasOperationAttrVerify = 1;
  let hasConstantMaterializer = 1;
  let extraClassDeclaration = [{
    void registerTypes();
  }];
  let dependentDialects = [
    "::mlir::arith::ArithDialect", "::mlir::cf::ControlFlowDialect", "::mlir::func::FuncDialect",
    "::mlir::math::MathDialect", "::mlir::vector::VectorDialect"
  ];
}

#endif
