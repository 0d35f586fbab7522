#include "codegen/cpp/states/statements/StateMemory.h"

#include "codegen/cpp/states/statements/StatePrinter.h"
#include "codegen/ir/Attributes.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::cpp {

using typed::ExprKind;

bool StateMemory::print(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case<ir::VarOp, ir::LoadOp, ir::StoreOp, ir::CopyOp, ir::ClearOp, ir::ElementOp,
            ir::FrameLoadOp, ir::FrameStoreOp, ir::EvaluateOp>([&](auto one) { write(one, out); })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

void StateMemory::write(ir::VarOp op, Statements &out) {
  Statement open = simple(StatementKind::Declaration); // named at the end of the block
  open.isOpen = true;
  open.written.identity = op;
  out.push_back(std::move(open));
}

void StateMemory::write(ir::LoadOp op, Statements &out) {
  const Code code = state.lvalues.of(op.getAddress());
  ir::MemoryAccesses accesses;
  accesses.reads.insert(ir::locationOf(op.getAddress()));
  state.values.flush(accesses, out);
  state.values.define(*op, code, accesses, true, out);
}

void StateMemory::write(ir::CopyOp op, Statements &out) {
  const Code from = state.lvalues.of(op.getSource()), to = state.lvalues.of(op.getTarget());
  state.values.flush(ir::accessesOf(op), out);
  if (!same(from, to))
    state.emitter.emit(out, assign(to, from));
}

void StateMemory::write(ir::ElementOp op, Statements &) {
  state.lvalues.setIndex(op, state.values.use(op.getIndex()));
}

void StateMemory::write(ir::FrameLoadOp op, Statements &out) {
  const FrameField *from = state.machine.savedField(op.getName());
  if (!from)
    return;
  ir::MemoryAccesses accesses;
  accesses.reads.insert({ir::MemoryLocation::Kind::Frame, from->key});
  state.values.define(*op, state.lvalues.frameField(from->name), accesses, true, out);
}

void StateMemory::write(ir::FrameStoreOp op, Statements &out) {
  const FrameField *to = state.machine.savedField(op.getName());
  if (!to)
    return;
  const Code value = state.values.use(op.getValue(), to->type),
             target = state.lvalues.frameField(to->name);
  state.values.flush(ir::accessesOf(op), out);
  if (!same(value, target))
    state.emitter.emit(out, assign(target, value));
}

/// Variables that stay whole are read and written where they lie, by the author's expression.
void StateMemory::write(ir::EvaluateOp op, Statements &out) {
  const SourceTable::Entry &entry = state.source.entries[op.getSource()];
  const bool isWrite =
      op.getNumResults() == 0 && entry.kind == SourceTable::Kind::Value &&
      (entry.expr->kind == ExprKind::Assign || entry.expr->kind == ExprKind::IncDec);
  state.functions.isNested = ir::attr::nested.isOn(op);
  if (state.functions.isNested) // its first part may change a pending operand of its last
    state.values.flush(ir::accessesOf(op), out);
  Statements before, written;
  state.functions.before = &before;
  Code code;
  if (isWrite) {
    state.expressions.replaceLeaves(entry, op.getOperands());
    written = state.functions.statements.expressionStatement(*entry.expr);
  } else {
    code = state.expressions.of(entry, op.getOperands());
  }
  state.functions.before = nullptr;
  state.functions.isNested = false;
  ir::MemoryAccesses accesses = ir::accessesOf(op);
  const bool isInto = entry.kind == SourceTable::Kind::Into;
  const Code target = isInto ? state.lvalues.of(op.getOperand(0)) : Code();
  state.values.flush(accesses, out);
  for (Statement &statement : before)
    state.emitter.emit(out, std::move(statement));
  if (isInto) {
    Statement &made = state.emitter.emit(out, assign(target, code));
    if (auto variable = op.getOperand(0).getDefiningOp<ir::VarOp>();
        variable && !contains(code, target))
      made.written = writtenVariable(variable);
    return;
  }
  for (Statement &statement : written)
    state.emitter.emit(out, std::move(statement));
  accesses.add(state.values.consumed);
  if (op.getNumResults() != 0)
    state.values.define(*op, code, accesses, /*isPure=*/ir::changesNothing(op), out);
  else if (code)
    state.emitter.emit(out, code);
}

void StateMemory::write(ir::ClearOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const Code target = state.lvalues.of(op.getAddress());
  state.values.flush(ir::accessesOf(op), out);
  const Type *type = state.types.ofMemory(op.getAddress());
  Statement &made =
      state.emitter.emit(out, assign(target, type ? context.types.zero(type) : list("", {})));
  if (variable)
    made.written = writtenVariable(variable);
}

Code StateMemory::assignment(const Code &target, const Code &code, mlir::Value value) {
  auto whole = value.getDefiningOp<ir::ExpressionOp>();
  const bool isCompound =
      whole && state.source.entries[whole.getSource()].kind == SourceTable::Kind::Compound;
  if (isCompound && code->is(ExpressionKind::Binary) && same(code->parts[0], target))
    return assign(code->op, target, code->parts[1]);
  return assign(target, code);
}

void StateMemory::write(ir::StoreOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const Type *declared = variable ? nullptr : state.types.ofMemory(op.getAddress());
  const Type *type = variable   ? state.types.ofVariable(variable)
                     : declared ? declared
                                : state.types.of(op.getValue());
  const Code target = state.lvalues.of(op.getAddress());
  // A component of what lies there.
  const Insertion *insertion = state.values.insertion(op.getValue());
  const bool isPart = insertion && state.values.isPending(op.getValue()) &&
                      same(insertion->vector, target) && insertion->parts.size() == 1;
  const Code value = state.values.use(op.getValue(), type);
  state.values.flush(ir::accessesOf(op), out);
  if (same(value, target))
    return;
  if (op.getValue().getDefiningOp<mlir::arith::AddIOp>() &&
      same(value, binary(Operator::Add, target, integer(1)))) {
    state.emitter.emit(out, unary(UnaryOperator::Increment, target)); // the next light
    return;
  }
  if (isPart) {
    const Insertion::Part &part = insertion->parts.front();
    mlir::Value scalar = op.getValue().getDefiningOp<mlir::vector::InsertOp>().getValueToStore();
    state.emitter.emit(out, assignment(Insertion::lvalue(target, part), part.value, scalar));
    return;
  }
  Statement &made = state.emitter.emit(out, assignment(target, value, op.getValue()));
  if (variable)
    made.written = writtenVariable(variable);
  made.field = writtenField(op);
  if (auto field = op.getAddress().getDefiningOp<ir::FieldOp>(); field && !made.field.all.empty())
    if (auto whole = field.getBase().getDefiningOp<ir::VarOp>())
      made.written = writtenVariable(whole);
}

WrittenVariable StateMemory::writtenVariable(ir::VarOp variable) {
  const Type *type = state.types.ofVariable(variable);
  WrittenVariable made;
  made.identity = variable.getAsOpaquePointer();
  made.type = type ? context.types.of(type) : std::string();
  made.isTemporary = ir::attr::shortCircuit.isOn(variable);
  made.isVectorOfBools = type && type->isVector() && type->element->is(TypeKind::Bool);
  return made;
}

WrittenField StateMemory::writtenField(ir::StoreOp op) {
  WrittenField made;
  auto field = op.getAddress().getDefiningOp<ir::FieldOp>();
  const Type *type = field ? state.types.ofMemory(field.getBase()) : nullptr;
  if (!type || !type->is(TypeKind::Struct))
    return made;
  for (const typed::Field &one : type->structure->fields)
    made.all.push_back(context.names.of(&one));
  auto load = op.getValue().getDefiningOp<ir::LoadOp>();
  auto from = load ? load.getAddress().getDefiningOp<ir::FieldOp>() : ir::FieldOp();
  made.isCopy = from && state.types.ofMemory(from.getBase()) == type;
  return made;
}

} // namespace rtsl::cpp
