//===- StateStores.cpp - what a state writes -------------------------------===//
#include "codegen/cpp/states/StateWriter.h"
#include "codegen/ir/Attributes.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

bool writesTo(mlir::Operation *op, mlir::Value address) {
  if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    return store.getAddress() == address;
  if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    return clear.getAddress() == address;
  if (auto copy = llvm::dyn_cast<ir::CopyOp>(op))
    return copy.getTarget() == address;
  if (auto spawn = llvm::dyn_cast<ir::SpawnPayloadOp>(op))
    return spawn.getPayload() == address;
  if (auto call = llvm::dyn_cast<ir::EnterOp>(op))
    return llvm::is_contained(call.getOperands(), address);
  if (auto evaluation = llvm::dyn_cast<ir::EvaluateOp>(op))
    for (auto [index, operand] : llvm::enumerate(evaluation.getOperands()))
      if (operand == address && changes(evaluation, index))
        return true;
  return llvm::isa<ir::FieldOp, ir::ElementOp>(op) &&
         llvm::any_of(op->getUsers(),
                      [&](mlir::Operation *user) { return writesTo(user, op->getResult(0)); });
}

/// Variables that stay whole are read and written where they lie, by the author's expression.
void StateWriter::write(ir::EvaluateOp op, Statements &out) {
  const SourceTable::Entry &entry = source.entries[op.getSource()];
  usesScratch |= context.effects.expression(*entry.expr).usesScratch;
  const bool isWrite =
      op.getNumResults() == 0 && entry.kind == SourceTable::Kind::Value &&
      (entry.expr->kind == ExprKind::Assign || entry.expr->kind == ExprKind::IncDec);
  printer.isNested = ir::attr::nested.isOn(op);
  if (printer.isNested) // its first part may change a pending operand of its last
    flush(touchesOf(op), out);
  Statements before, written;
  printer.before = &before;
  Code code;
  if (isWrite) {
    replaceLeaves(entry, op.getOperands());
    written = printer.statements.expressionStatement(*entry.expr);
  } else {
    code = expression(entry, op.getOperands());
  }
  printer.before = nullptr;
  printer.isNested = false;
  Touches touches = touchesOf(op);
  const bool isInto = entry.kind == SourceTable::Kind::Into;
  const Code target = isInto ? place(op.getOperand(0)) : Code();
  flush(touches, out);
  for (Statement &statement : before)
    emit(out, std::move(statement));
  if (isInto) {
    Statement &made = emit(out, assign(target, code));
    if (auto variable = op.getOperand(0).getDefiningOp<ir::VarOp>();
        variable && !contains(code, target))
      made.written = this->written(variable);
    return;
  }
  for (Statement &statement : written)
    emit(out, std::move(statement));
  touches.add(consumed);
  if (op.getNumResults() != 0)
    define(*op, code, touches, /*isPure=*/ir::attr::plain.isOn(op) && !ir::attr::changes.isOn(op),
           out);
  else if (code)
    emit(out, code);
}

void StateWriter::write(ir::ClearOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const Code target = place(op.getAddress());
  flush(touchesOf(op), out);
  const Type *type = declaredType(op.getAddress());
  Statement &made = emit(out, assign(target, type ? context.types.zero(type) : list("", {})));
  if (variable)
    made.written = this->written(variable);
}

/// `target += y` for `target + y`, where `value` is the whole expression of the source that made
/// it.
Code StateWriter::assignment(const Code &target, const Code &value, mlir::Value made) {
  auto whole = made.getDefiningOp<ir::ExpressionOp>();
  const bool isCompound =
      whole && source.entries[whole.getSource()].kind == SourceTable::Kind::Compound;
  if (isCompound && value->is(ExpressionKind::Binary) && same(value->parts[0], target))
    return assign(value->op, target, value->parts[1]);
  return assign(target, value);
}

void StateWriter::write(ir::StoreOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const Type *declared = variable ? nullptr : declaredType(op.getAddress());
  const Type *type = variable ? varType(variable) : declared ? declared : typeOf(op.getValue());
  const Code target = place(op.getAddress());
  // A component of what lies there.
  auto insertion = insertions.find(op.getValue());
  const bool isPart = insertion != insertions.end() && pending.count(op.getValue()) &&
                      same(insertion->second.vector, target) && insertion->second.parts.size() == 1;
  const Code value = use(op.getValue(), type);
  flush(touchesOf(op), out);
  if (same(value, target))
    return;
  if (op.getValue().getDefiningOp<mlir::arith::AddIOp>() &&
      same(value, binary(Operator::Add, target, integer(1)))) {
    emit(out, unary(UnaryOperator::Increment, target)); // the next light
    return;
  }
  if (isPart) {
    const Insertion::Part &part = insertion->second.parts.front();
    mlir::Value scalar = op.getValue().getDefiningOp<mlir::vector::InsertOp>().getValueToStore();
    emit(out, assignment(Insertion::place(target, part), part.value, scalar));
    return;
  }
  Statement &made = emit(out, assignment(target, value, op.getValue()));
  if (variable)
    made.written = this->written(variable);
  made.field = writtenField(op);
  if (auto field = op.getAddress().getDefiningOp<ir::FieldOp>(); field && !made.field.all.empty())
    if (auto whole = field.getBase().getDefiningOp<ir::VarOp>())
      made.written = written(whole);
}

WrittenVariable StateWriter::written(ir::VarOp variable) {
  const Type *type = varType(variable);
  WrittenVariable made;
  made.identity = variable.getAsOpaquePointer();
  made.type = type ? context.types.of(type) : std::string();
  made.isTemporary = isOwnName(variable.getName());
  made.isVectorOfBools = type && type->isVector() && type->element->is(TypeKind::Bool);
  return made;
}

WrittenField StateWriter::writtenField(ir::StoreOp op) {
  WrittenField made;
  auto field = op.getAddress().getDefiningOp<ir::FieldOp>();
  const Type *type = field ? declaredType(field.getBase()) : nullptr;
  if (!type || !type->is(TypeKind::Struct))
    return made;
  for (const typed::Field &one : type->structure->fields)
    made.all.push_back(context.names.of(&one));
  auto load = op.getValue().getDefiningOp<ir::LoadOp>();
  auto from = load ? load.getAddress().getDefiningOp<ir::FieldOp>() : ir::FieldOp();
  made.isCopy = from && declaredType(from.getBase()) == type;
  return made;
}

} // namespace rtsl::cpp
