//===- StateWriter.cpp - the body of a state ------------------------------===//
#include "codegen/cpp/states/StateWriter.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/Matchers.h"
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

StateWriter::StateWriter(ModulePrinter &module, const SourceTable &source, Machine &machine)
    : module(module), source(source), machine(machine), printer(module, machine.method) {
  printer.isNested = false;
  always = module.namesInClass(*machine.definition);
  for (std::size_t at = 0; machine.called && at < machine.called->given.size(); ++at)
    always.insert(machine.addressName(module, at));
  for (std::string *name : {&machine.frameName, &machine.callName}) {
    while (isAlways(*name))
      *name += '_';
    always.insert(*name);
  }
}

void StateWriter::unsupported(mlir::Operation &op) {
  if (hasRefused) // one message a method says enough
    return;
  hasRefused = true;
  std::string what = op.getName().stripDialect().str();
  if (llvm::isa<ir::VarOp, ir::TableOp>(op))
    what = "an array or a struct";
  const unsigned line = lineOf(op.getLoc(), machine.file);
  module.unsupported(machine.method->range,
                     fmt::format("{} in states in C++{} (--trace=recurse keeps `trace` as a call)",
                                 what, line ? fmt::format(", of line {}", line) : ""));
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

void StateWriter::operation(mlir::Operation &op, Lines &out) {
  consumed = {};
  if (unsigned line = lineOf(op.getLoc(), machine.file))
    currentLine = line;
  auto pure = [&](Code code) { define(op, std::move(code), consumed, true, out); };
  auto infix = [&](Operator sign) {
    const Code left = use(op.getOperand(0));
    pure(binary(sign, left, use(op.getOperand(1))));
  };
  auto isBool = [&] { return op.getResult(0).getType().isInteger(1); };
  auto field = [&](llvm::StringRef slot) -> const FrameField * {
    for (const FrameField &known : machine.frame)
      if (!known.isObject && known.slot == slot)
        return &known;
    return nullptr;
  };
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](ir::VarOp variable) {
        Line line;
        line.declares = variable;
        out.push_back(std::move(line));
      })
      .Case([&](ir::LoadOp load) {
        const Code code = place(load.getAddress());
        Touches touches;
        note(load.getAddress(), touches, false);
        flush(touches, out);
        define(op, code, touches, true, out);
      })
      .Case([&](ir::FrameLoadOp load) {
        if (const FrameField *from = field(load.getName())) {
          Touches touches;
          touches.reads.insert({Location::Kind::Frame, from->slot});
          define(op, frameField(from->name), touches, true, out);
        }
      })
      .Case([&](ir::ExpressionOp whole) {
        const Code code = expression(source.entries[whole.getSource()], op.getOperands());
        usesScratch |=
            module.effects.expression(*source.entries[whole.getSource()].expr).usesScratch;
        pure(code);
      })
      .Case([&](ir::EvaluateOp inner) { evaluate(inner, out); })
      .Case([&](ir::ClearOp inner) { clear(inner, out); })
      .Case([&](ir::CopyOp copy) {
        const Code from = place(copy.getSource()), to = place(copy.getTarget());
        flush(touchesOf(&op), out);
        if (!same(from, to))
          emit(out, assign(to, from));
      })
      .Case([&](ir::SpawnPayloadOp spawn) { spawnPayload(spawn); })
      .Case([&](ir::RandOp rand) {
        Touches touches = touchesOf(&op);
        flush(touches, out);
        define(op, cpp::call(rand.getOpen() ? "rtsl::randOpen" : "rtsl::rand", {name("rt")}),
               touches, false, out);
      })
      .Case([&](ir::CallArgumentOp argument) {
        if (!llvm::isa<ir::PtrType>(argument.getType()))
          define(op, frameField(machine.called->fields[machine.given(argument)]), {}, true, out);
      })
      .Case([&](ir::CallResultOp result) {
        const Code value = use(result.getValue(), machine.method->returnType);
        emit(out, assign(frameField(machine.called->returned), value));
      })
      .Case([&](ir::CallReturnedOp) {
        const auto before =
            machine.callBefore.find(op.getParentOfType<mlir::func::FuncOp>().getSymName().str());
        if (op.getNumResults() != 0 && before->second)
          define(op, member(name(machine.callName), before->second->returned), {}, true, out);
      })
      .Case([&](ir::CastRefOp cast) { pure(use(cast.getObject())); })
      .Case([&](ir::TraceResultOp) {
        define(op, cpp::call("rtsl::traced", {name("rt")}), {}, true, out);
      })
      .Case([&](ir::LightCountOp) {
        define(op, cpp::call("rtsl::lightCount", {name("rt")}), {}, true, out);
      })
      .Case([&](ir::IlluminateOp light) {
        std::vector<Code> arguments = {name("rt")};
        for (mlir::Value operand : op.getOperands())
          arguments.push_back(use(operand));
        Touches touches = touchesOf(&op);
        flush(touches, out);
        touches.add(consumed);
        define(op, cpp::call("rtsl::illuminate", std::move(arguments)), touches, false, out);
      })
      .Case([&](ir::StoreOp stored) { store(stored, out); })
      .Case([&](ir::FrameStoreOp stored) {
        if (const FrameField *to = field(stored.getName())) {
          const Code value = use(stored.getValue(), to->type), target = frameField(to->name);
          flush(touchesOf(&op), out);
          if (!same(value, target))
            emit(out, assign(target, value));
        }
      })
      .Case([&](ir::SpawnOp spawn) {
        const Code origin = use(spawn.getOrigin(), vec3());
        spawned = {origin, use(spawn.getDirection(), vec3())};
      })
      .Case([&](ir::ReturnOp end) { leave(end, out); })
      .Case([&](ir::BreakOp) { emit(out, simple(StatementKind::Break)); })
      .Case([&](ir::ContinueOp) { emit(out, simple(StatementKind::Continue)); })
      .Case([&](ir::IfOp inner) { choice(inner, out); })
      .Case([&](ir::LoopOp inner) { loop(inner, out); })
      .Case([&](ir::SwitchOp inner) { switchOver(inner, out); })
      .Case([&](mlir::vector::ExtractOp part) {
        auto position = part.getStaticPosition();
        if (position.size() != 1 || (!part.hasDynamicPosition() && position.front() > 3))
          return unsupported(op);
        const Code vector = use(part.getSource());
        if (part.hasDynamicPosition())
          pure(cpp::call("rtsl::at", {vector, use(part.getDynamicPosition().front())}));
        else
          pure(component(vector, static_cast<std::size_t>(position.front())));
      })
      .Case([&](mlir::vector::InsertOp part) {
        auto position = part.getStaticPosition();
        if (position.size() != 1 || (!part.hasDynamicPosition() && position.front() > 3))
          return unsupported(op);
        Insertion whole;
        if (auto before = insertions.find(part.getDest());
            before != insertions.end() && pending.count(part.getDest()))
          whole = before->second;
        const Code vector = use(part.getDest(), typeOf(part.getResult()));
        if (whole.parts.empty()) {
          whole.before = part.getDest();
          whole.vector = vector;
        }
        Insertion::Part &last = whole.parts.emplace_back();
        last.value = use(part.getValueToStore());
        if (part.hasDynamicPosition())
          last.index = use(part.getDynamicPosition().front());
        else
          last.component = static_cast<std::size_t>(position.front());
        insertions[part.getResult()] = whole;
        pure(whole.code());
      })
      .Case([&](mlir::vector::FromElementsOp made) {
        const Type *type = typeOf(made.getResult());
        if (!type)
          return unsupported(op);
        std::vector<Code> parts;
        for (mlir::Value part : made.getElements())
          parts.push_back(use(part));
        pure(construct(module.type(type), std::move(parts)));
      })
      .Case([&](mlir::vector::BroadcastOp same) {
        const Type *type = typeOf(same.getResult());
        if (!type || !same.getSourceType().isIntOrFloat())
          return unsupported(op);
        pure(construct(module.type(type), {use(same.getSource())}));
      })
      .Case([&](mlir::vector::ShuffleOp chosen) {
        const Type *type = typeOf(chosen.getResult());
        if (!type)
          return unsupported(op);
        const Code first = named(chosen.getV1(), out);
        const Code second = chosen.getV1() == chosen.getV2() ? first : named(chosen.getV2(), out);
        const std::int64_t width = chosen.getV1VectorType().getNumElements();
        std::vector<Code> parts;
        for (std::int64_t at : chosen.getMask())
          parts.push_back(component(at < width ? first : second,
                                    static_cast<std::size_t>(at < width ? at : at - width)));
        pure(construct(module.type(type), std::move(parts)));
      })
      .Case([&](arith::XOrIOp negation) {
        if (!isBool() || !mlir::matchPattern(negation.getRhs(), mlir::m_One()))
          return unsupported(op);
        pure(opposite(negation.getLhs(), use(negation.getLhs())));
      })
      .Case([&](arith::AndIOp) { isBool() ? infix(Operator::And) : unsupported(op); })
      .Case([&](arith::OrIOp) { isBool() ? infix(Operator::Or) : unsupported(op); })
      .Case([&](arith::IndexCastUIOp index) { pure(use(index.getIn())); })
      .Case([&](arith::AddIOp) { infix(Operator::Add); }) // of a light's number
      .Case([&](arith::CmpIOp compare) {
        compare.getPredicate() == arith::CmpIPredicate::ult ? infix(Operator::Less)
                                                            : unsupported(op);
      })
      .Case([&](arith::SelectOp select) {
        const Type *type = typeOf(select.getResult());
        const Code condition = use(select.getCondition());
        const Code first = use(select.getTrueValue(), type);
        pure(choose(module, condition, first, use(select.getFalseValue(), type), type));
      })
      .Case<arith::ConstantOp, ir::NullRefOp, ir::NextOp, ir::StateOp, ir::YieldOp, ir::ConditionOp,
            ir::TraceReturnedOp, ir::EnterOp, ir::LeaveOp, ir::FrameObjectOp, ir::PayloadOp,
            ir::FieldOp, ir::TableOp>([](auto) {})
      .Case([&](ir::ElementOp element) { elementIndices[element] = use(element.getIndex()); })
      .Default([&](mlir::Operation *) { unsupported(op); });
}

//===----------------------------------------------------------------------===//
// The end of a state
//===----------------------------------------------------------------------===//

void StateWriter::spawnPayload(ir::SpawnPayloadOp op) {
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

/// A call with which the state ends: its arguments are evaluated there, for what is saved is saved
/// before.
Code StateWriter::call(ir::ReturnOp op) {
  mlir::Operation *at = op;
  while (at && !llvm::isa<ir::EnterOp>(at))
    at = at->getPrevNode();
  auto enter = llvm::dyn_cast_or_null<ir::EnterOp>(at);
  const CalledMethod *called = enter ? module.calledMethod(enter.getCallee().str()) : nullptr;
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
  arguments.push_back(list(module.structureOf(*called), std::move(given)));
  return cpp::call("rtsl::callThen", std::move(arguments));
}

void StateWriter::leave(ir::ReturnOp op, Lines &out) {
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
