#include "codegen/cpp/states/statements/StatePrinter.h"

#include "codegen/cpp/cleanup/CleanUp.h"

#include "mlir/Dialect/Arith/IR/Arith.h"

namespace rtsl::cpp {

StatePrinter::StatePrinter(MethodPrinter &method)
    : method(method), source(method.source), machine(method.machine), functions(method.functions),
      types(method.types), names(method.context, source, machine, functions),
      emitter(*this, method.context), values(*this, method.context), lvalues(*this, method.context),
      expressions(*this, method.context), operations(*this, method.context),
      memory(*this, method.context), transitions(*this, method.context),
      control(*this, method.context) {}

/// Is it printed with the operations that use it?
static bool isPartOfOthers(mlir::Operation &op) {
  return llvm::isa<mlir::arith::ConstantOp, ir::NullRefOp, ir::NextOp, ir::StateOp, ir::YieldOp,
                   ir::ConditionOp, ir::TraceReturnedOp, ir::EnterOp, ir::LeaveOp,
                   ir::FrameObjectOp, ir::PayloadOp, ir::FieldOp, ir::TableOp>(op);
}

void StatePrinter::print(mlir::Operation &op, Statements &out) {
  values.consumed = {};
  emitter.moveTo(op);
  const bool isKnown = isPartOfOthers(op) || memory.print(op, out) || expressions.print(op, out) ||
                       operations.print(op, out) || transitions.print(op, out) ||
                       control.print(op, out);
  if (!isKnown)
    unsupported(op);
}

Statements StatePrinter::body(mlir::func::FuncOp function) {
  functions.constantNames.clear();
  Statements lines;
  control.block(function.getBody().front(), lines);
  cleanUp(lines, machine.frameName);
  Statements statements;
  for (const typed::Variable *constant : expressions.constants)
    statements.push_back(
        declaration(functions.literals.isTable(*constant->init) ? "static constexpr" : "const",
                    method.context.types.of(constant->type), functions.nameOf(constant),
                    functions.expressions.initialiser(*constant->init)));
  append(statements, lines);
  return statements;
}

} // namespace rtsl::cpp
