//===- StateWriter.cpp - the body of a state ------------------------------===//
#include "codegen/cpp/states/StateWriter.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/TypeSwitch.h"

#include <fmt/format.h>

namespace rtsl::cpp {

namespace arith = mlir::arith;

unsigned lineOf(mlir::Location location, llvm::StringRef file) {
  if (auto place = llvm::dyn_cast<mlir::FileLineColLoc>(location))
    return place.getFilename() == file ? place.getLine() : 0;
  if (auto name = llvm::dyn_cast<mlir::NameLoc>(location))
    return lineOf(name.getChildLoc(), file);
  if (auto call = llvm::dyn_cast<mlir::CallSiteLoc>(location)) {
    const unsigned line = lineOf(call.getCallee(), file);
    return line != 0 ? line : lineOf(call.getCaller(), file);
  }
  if (auto fused = llvm::dyn_cast<mlir::FusedLoc>(location))
    for (mlir::Location part : fused.getLocations())
      if (unsigned line = lineOf(part, file))
        return line;
  return 0;
}

StateWriter::StateWriter(Context &context, const SourceTable &source, Machine &machine)
    : context(context), source(source), machine(machine), printer(context, machine.method) {
  printer.isNested = false;
  always = context.namesInClass(*machine.definition);
  for (std::size_t at = 0; machine.called && at < machine.called->given.size(); ++at)
    always.insert(machine.addressName(context, at));
  for (std::string *name : {&machine.frameName, &machine.callName}) {
    while (isAlways(*name))
      *name += '_';
    always.insert(*name);
  }
}

void StateWriter::unsupported(mlir::Operation &op) {
  if (hasRefused) // one message a method is enough
    return;
  hasRefused = true;
  std::string what = op.getName().stripDialect().str();
  if (llvm::isa<ir::VarOp, ir::TableOp>(op))
    what = "an array or a struct";
  const unsigned line = lineOf(op.getLoc(), machine.file);
  context.unsupported(machine.method->range,
                      fmt::format("{} in states in C++{} (--trace=recurse keeps `trace` as a call)",
                                  what, line ? fmt::format(", of line {}", line) : ""));
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

static Code onState(const char *function) {
  return cpp::call(function, {name("rt")});
}

void StateWriter::operation(mlir::Operation &op, Statements &out) {
  consumed = {};
  if (unsigned line = lineOf(op.getLoc(), machine.file))
    currentLine = line;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      // variables, and the frame
      .Case<ir::VarOp, ir::LoadOp, ir::StoreOp, ir::CopyOp, ir::ClearOp, ir::ElementOp>(
          [&](auto one) { write(one, out); })
      .Case<ir::FrameLoadOp, ir::FrameStoreOp>([&](auto one) { write(one, out); })
      // the author's expressions
      .Case<ir::ExpressionOp, ir::EvaluateOp>([&](auto one) { write(one, out); })
      // rays, lights and random numbers
      .Case<ir::SpawnOp, ir::SpawnPayloadOp>([&](auto one) { write(one); })
      .Case<ir::RandOp, ir::IlluminateOp>([&](auto one) { write(one, out); })
      .Case([&](ir::TraceResultOp) { makeAnywhere(op, onState("rtsl::traced"), out); })
      .Case([&](ir::LightCountOp) { makeAnywhere(op, onState("rtsl::lightCount"), out); })
      // methods that are called through references
      .Case<ir::CallArgumentOp, ir::CallResultOp, ir::CallReturnedOp>(
          [&](auto one) { write(one, out); })
      // control flow
      .Case([&](ir::IfOp inner) { choice(inner, out); })
      .Case([&](ir::LoopOp inner) { loop(inner, out); })
      .Case([&](ir::SwitchOp inner) { switchOver(inner, out); })
      .Case([&](ir::BreakOp) { emit(out, simple(StatementKind::Break)); })
      .Case([&](ir::ContinueOp) { emit(out, simple(StatementKind::Continue)); })
      .Case([&](ir::ReturnOp end) { leave(end, out); })
      // what the passes have made of expressions (StateValues.cpp)
      .Case<mlir::vector::ExtractOp, mlir::vector::InsertOp, mlir::vector::FromElementsOp,
            mlir::vector::BroadcastOp, mlir::vector::ShuffleOp>([&](auto one) { write(one, out); })
      .Case<arith::XOrIOp, arith::AndIOp, arith::OrIOp, arith::AddIOp, arith::CmpIOp,
            arith::SelectOp>([&](auto one) { write(one, out); })
      .Case([&](ir::CastRefOp cast) { make(op, use(cast.getObject()), out); })
      .Case([&](arith::IndexCastUIOp index) { make(op, use(index.getIn()), out); })
      // printed with what uses them
      .Case<arith::ConstantOp, ir::NullRefOp, ir::NextOp, ir::StateOp, ir::YieldOp, ir::ConditionOp,
            ir::TraceReturnedOp, ir::EnterOp, ir::LeaveOp, ir::FrameObjectOp, ir::PayloadOp,
            ir::FieldOp, ir::TableOp>([](auto) {})
      .Default([&](mlir::Operation *) { unsupported(op); });
}

void StateWriter::make(mlir::Operation &op, Code code, Statements &out) {
  define(op, std::move(code), consumed, true, out);
}

void StateWriter::makeAnywhere(mlir::Operation &op, Code code, Statements &out) {
  define(op, std::move(code), {}, true, out);
}

//===----------------------------------------------------------------------===//
// Variables, and the frame
//===----------------------------------------------------------------------===//

void StateWriter::write(ir::VarOp op, Statements &out) {
  Statement open = simple(StatementKind::Declaration); // named at the end of the block
  open.isOpen = true;
  open.written.identity = op;
  out.push_back(std::move(open));
}

void StateWriter::write(ir::LoadOp op, Statements &out) {
  const Code code = place(op.getAddress());
  Touches touches;
  note(op.getAddress(), touches, false);
  flush(touches, out);
  define(*op, code, touches, true, out);
}

void StateWriter::write(ir::CopyOp op, Statements &out) {
  const Code from = place(op.getSource()), to = place(op.getTarget());
  flush(touchesOf(op), out);
  if (!same(from, to))
    emit(out, assign(to, from));
}

void StateWriter::write(ir::ElementOp op, Statements &) {
  elementIndices[op] = use(op.getIndex());
}

/// What a value is saved as; null: it is not in the frame.
const FrameField *StateWriter::savedField(llvm::StringRef slot) const {
  for (const FrameField &known : machine.frame)
    if (!known.isObject && known.slot == slot)
      return &known;
  return nullptr;
}

void StateWriter::write(ir::FrameLoadOp op, Statements &out) {
  const FrameField *from = savedField(op.getName());
  if (!from)
    return;
  Touches touches;
  touches.reads.insert({Location::Kind::Frame, from->slot});
  define(*op, frameField(from->name), touches, true, out);
}

void StateWriter::write(ir::FrameStoreOp op, Statements &out) {
  const FrameField *to = savedField(op.getName());
  if (!to)
    return;
  const Code value = use(op.getValue(), to->type), target = frameField(to->name);
  flush(touchesOf(op), out);
  if (!same(value, target))
    emit(out, assign(target, value));
}

void StateWriter::write(ir::ExpressionOp op, Statements &out) {
  const SourceTable::Entry &entry = source.entries[op.getSource()];
  const Code code = expression(entry, op->getOperands());
  usesScratch |= context.effects.expression(*entry.expr).usesScratch;
  make(*op, code, out);
}

//===----------------------------------------------------------------------===//
// Rays, lights and random numbers
//===----------------------------------------------------------------------===//

void StateWriter::write(ir::SpawnOp op) {
  const Code origin = use(op.getOrigin(), vec3());
  spawned = {origin, use(op.getDirection(), vec3())};
}

void StateWriter::write(ir::SpawnPayloadOp op) {
  spawned = {use(op.getOrigin(), vec3())};
  spawned.push_back(use(op.getDirection(), vec3()));
  spawned.push_back(use(op.getTmin()));
  spawned.push_back(use(op.getTmax()));
  spawned.push_back(place(op.getPayload()));
  const mlir::Value options[] = {op.getRoot(), op.getMask(), op.getTime()};
  for (mlir::Value optional : options)
    if (optional)
      spawned.push_back(use(optional));
}

void StateWriter::write(ir::RandOp op, Statements &out) {
  Touches touches = touchesOf(op);
  flush(touches, out);
  define(*op, onState(op.getOpen() ? "rtsl::randOpen" : "rtsl::rand"), touches, false, out);
}

void StateWriter::write(ir::IlluminateOp op, Statements &out) {
  std::vector<Code> arguments = {name("rt")};
  for (mlir::Value operand : op->getOperands())
    arguments.push_back(use(operand));
  Touches touches = touchesOf(op);
  flush(touches, out);
  touches.add(consumed);
  define(*op, cpp::call("rtsl::illuminate", std::move(arguments)), touches, false, out);
}

//===----------------------------------------------------------------------===//
// Methods that are called through references
//===----------------------------------------------------------------------===//

void StateWriter::write(ir::CallArgumentOp op, Statements &out) {
  if (!llvm::isa<ir::PtrType>(op.getType()))
    makeAnywhere(*op, frameField(machine.called->fields[machine.given(op)]), out);
}

void StateWriter::write(ir::CallResultOp op, Statements &out) {
  const Code value = use(op.getValue(), machine.method->returnType);
  emit(out, assign(frameField(machine.called->returned), value));
}

void StateWriter::write(ir::CallReturnedOp op, Statements &out) {
  const auto before =
      machine.callBefore.find(op->getParentOfType<mlir::func::FuncOp>().getSymName().str());
  if (op->getNumResults() != 0 && before->second)
    makeAnywhere(*op, member(name(machine.callName), before->second->returned), out);
}

//===----------------------------------------------------------------------===//
// The end of a state
//===----------------------------------------------------------------------===//

/// A call with which the state ends: its arguments are evaluated there, for what is saved is saved
/// before.
Code StateWriter::call(ir::ReturnOp op) {
  mlir::Operation *at = op;
  while (at && !llvm::isa<ir::EnterOp>(at))
    at = at->getPrevNode();
  auto enter = llvm::dyn_cast_or_null<ir::EnterOp>(at);
  const CalledMethod *called =
      enter ? context.split.calledMethod(enter.getCallee().str()) : nullptr;
  if (!called) {
    unsupported(*op);
    return {};
  }
  std::vector<Code> arguments = {name("rt")}, given;
  if (machine.hasFrame())
    arguments.push_back(name(machine.frameName));
  arguments.push_back(name("Step::" + machine.stepOf.at(enter.getResume()->str())));
  arguments.push_back(use(enter.getOperands().front()));
  for (auto [variable, value] : llvm::zip(called->given, enter.getOperands().drop_front()))
    given.push_back(llvm::isa<ir::PtrType>(value.getType())
                        ? unary(UnaryOperator::Address, place(value))
                        : use(value, variable->type));
  arguments.push_back(list(context.split.structureOf(*called), std::move(given)));
  return cpp::call("rtsl::callThen", std::move(arguments));
}

void StateWriter::leave(ir::ReturnOp op, Statements &out) {
  auto next =
      op.getValues().empty() ? ir::NextOp() : op.getValues().front().getDefiningOp<ir::NextOp>();
  auto withRay = [&](const char *callee, std::vector<Code> arguments) {
    arguments.insert(arguments.begin(), name("rt"));
    arguments.insert(arguments.end(), spawned.begin(), spawned.end());
    emit(out, returning(cpp::call(callee, std::move(arguments))));
  };
  if (!next || next.getTransition() == ir::Transition::Done)
    emit(out, returning(name("rtsl::done")));
  else if (next.getTransition() == ir::Transition::Last)
    withRay("rtsl::traceLast", {});
  else if (next.getTransition() == ir::Transition::Return)
    emit(out, returning(cpp::call("rtsl::returnToCaller", {name("rt")})));
  else if (next.getTransition() == ir::Transition::Jump &&
           machine.joins.count(next.getState()->str()))
    emit(out, returning(cpp::call("rtsl::goOn",
                                  {name("Step::" + machine.stepOf.at(next.getState()->str()))})));
  else if (next.getTransition() == ir::Transition::Jump)
    emit(out, returning(call(op)));
  else
    withRay("rtsl::traceThen", {name("Step::" + machine.stepOf.at(next.getState()->str()))});
}

} // namespace rtsl::cpp
