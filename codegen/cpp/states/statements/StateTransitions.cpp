#include "codegen/cpp/states/statements/StateTransitions.h"

#include "codegen/cpp/states/statements/StatePrinter.h"

#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::cpp {

static Code onState(const char *function) {
  return cpp::call(function, {name("rt")});
}

bool StateTransitions::print(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case<ir::SpawnOp, ir::SpawnPayloadOp, ir::RandOp, ir::IlluminateOp>(
          [&](auto one) { write(one, out); })
      .Case<ir::CallArgumentOp, ir::CallResultOp, ir::CallReturnedOp, ir::ReturnOp>(
          [&](auto one) { write(one, out); })
      .Case([&](ir::TraceResultOp) { state.values.makeAnywhere(op, onState("rtsl::traced"), out); })
      .Case([&](ir::LightCountOp) {
        state.values.makeAnywhere(op, onState("rtsl::lightCount"), out);
      })
      .Case([&](ir::LightMayPassOp) {
        state.values.makeAnywhere(op, onState("rtsl::lightMayPass"), out);
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

void StateTransitions::write(ir::SpawnOp op, Statements &) {
  const Code origin = state.values.use(op.getOrigin(), state.types.vec3());
  spawned = {origin, state.values.use(op.getDirection(), state.types.vec3())};
}

void StateTransitions::write(ir::SpawnPayloadOp op, Statements &) {
  spawned = {state.values.use(op.getOrigin(), state.types.vec3())};
  spawned.push_back(state.values.use(op.getDirection(), state.types.vec3()));
  spawned.push_back(state.values.use(op.getTmin()));
  spawned.push_back(state.values.use(op.getTmax()));
  spawned.push_back(state.lvalues.of(op.getPayload()));
  const mlir::Value options[] = {op.getRoot(), op.getMask(), op.getTime()};
  for (mlir::Value optional : options)
    if (optional)
      spawned.push_back(state.values.use(optional));
}

void StateTransitions::write(ir::RandOp op, Statements &out) {
  ir::MemoryAccesses accesses = ir::accessesOf(op);
  state.values.flush(accesses, out);
  state.values.define(*op, onState(op.getOpen() ? "rtsl::randOpen" : "rtsl::rand"), accesses, false,
                      out);
}

void StateTransitions::write(ir::IlluminateOp op, Statements &out) {
  std::vector<Code> arguments = {name("rt")};
  for (mlir::Value operand : op->getOperands())
    arguments.push_back(state.values.use(operand));
  ir::MemoryAccesses accesses = ir::accessesOf(op);
  state.values.flush(accesses, out);
  accesses.add(state.values.consumed);
  state.values.define(*op, cpp::call("rtsl::illuminate", std::move(arguments)), accesses, false,
                      out);
}

//===----------------------------------------------------------------------===//
// Methods that are called through references
//===----------------------------------------------------------------------===//

void StateTransitions::write(ir::CallArgumentOp op, Statements &out) {
  if (!llvm::isa<ir::PtrType>(op.getType()))
    state.values.makeAnywhere(
        *op,
        state.lvalues.frameField(state.machine.called->fields[state.machine.argumentNumber(op)]),
        out);
}

void StateTransitions::write(ir::CallResultOp op, Statements &out) {
  const Code value = state.values.use(op.getValue(), state.machine.method->returnType);
  state.emitter.emit(out, assign(state.lvalues.frameField(state.machine.called->returned), value));
}

void StateTransitions::write(ir::CallReturnedOp op, Statements &out) {
  const auto before =
      state.machine.callBefore.find(op->getParentOfType<mlir::func::FuncOp>().getSymName().str());
  if (op->getNumResults() != 0 && before->second)
    state.values.makeAnywhere(*op, member(name(state.machine.callName), before->second->returned),
                              out);
}

//===----------------------------------------------------------------------===//
// The end of a state
//===----------------------------------------------------------------------===//

/// The call that ends a state. Its arguments are evaluated at the end of the state, after the
/// values that are saved.
Code StateTransitions::call(ir::ReturnOp op) {
  mlir::Operation *at = op;
  while (at && !llvm::isa<ir::EnterOp>(at))
    at = at->getPrevNode();
  auto enter = llvm::dyn_cast_or_null<ir::EnterOp>(at);
  const CalledMethod *called =
      enter ? context.split.calledMethod(enter.getCallee().str()) : nullptr;
  if (!called) {
    state.unsupported(*op);
    return {};
  }
  std::vector<Code> arguments = {name("rt")}, passed;
  if (state.machine.hasFrame())
    arguments.push_back(name(state.machine.frameName));
  arguments.push_back(name("Step::" + state.machine.stepOf.at(enter.getResume()->str())));
  arguments.push_back(state.values.use(enter.getOperands().front()));
  for (auto [variable, value] : llvm::zip(called->arguments, enter.getOperands().drop_front()))
    passed.push_back(llvm::isa<ir::PtrType>(value.getType())
                         ? unary(UnaryOperator::Address, state.lvalues.of(value))
                         : state.values.use(value, variable->type));
  arguments.push_back(list(context.split.structureOf(*called), std::move(passed)));
  return cpp::call("rtsl::callThen", std::move(arguments));
}

void StateTransitions::write(ir::ReturnOp op, Statements &out) {
  auto next =
      op.getValues().empty() ? ir::NextOp() : op.getValues().front().getDefiningOp<ir::NextOp>();
  auto withRay = [&](const char *callee, std::vector<Code> arguments) {
    arguments.insert(arguments.begin(), name("rt"));
    arguments.insert(arguments.end(), spawned.begin(), spawned.end());
    state.emitter.emit(out, returning(cpp::call(callee, std::move(arguments))));
  };
  if (!next || next.getTransition() == ir::Transition::Done)
    state.emitter.emit(out, returning(name("rtsl::done")));
  else if (next.getTransition() == ir::Transition::Last)
    withRay("rtsl::traceLast", {});
  else if (next.getTransition() == ir::Transition::Return)
    state.emitter.emit(out, returning(cpp::call("rtsl::returnToCaller", {name("rt")})));
  else if (next.getTransition() == ir::Transition::Jump &&
           state.machine.joins.count(next.getState()->str()))
    state.emitter.emit(
        out,
        returning(cpp::call("rtsl::goOn",
                            {name("Step::" + state.machine.stepOf.at(next.getState()->str()))})));
  else if (next.getTransition() == ir::Transition::Jump)
    state.emitter.emit(out, returning(call(op)));
  else
    withRay("rtsl::traceThen", {name("Step::" + state.machine.stepOf.at(next.getState()->str()))});
}

} // namespace rtsl::cpp
