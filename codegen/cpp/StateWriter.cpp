//===- StateWriter.cpp - the body of a state ------------------------------===//
#include "codegen/cpp/StateWriter.h"

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
  always = module.namesInScope(*machine.definition);
  for (std::size_t at = 0; machine.called && at < machine.called->given.size(); ++at)
    always.insert(machine.addressName(module, at));
  for (std::string *name : {&machine.frameName, &machine.callName}) {
    while (always.count(*name))
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
                     fmt::format("{} in states in C++{} (--trace=recurse keeps `trace` as a call)", what,
                                 line ? fmt::format(", of line {}", line) : ""));
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

void StateWriter::operation(mlir::Operation &op, Statements &out) {
  consumed = {};
  if (unsigned line = lineOf(op.getLoc(), machine.file))
    currentLine = line;
  auto pure = [&](Code code) { define(op, std::move(code), consumed, true, out); };
  auto infix = [&](const char *sign, Binding binding) {
    const auto tighter = static_cast<Binding>(static_cast<int>(binding) + 1);
    const std::string left = bind(use(op.getOperand(0)), binding == Binding::Or ? Binding::BitOr : binding);
    pure({left + " " + sign + " " + bind(use(op.getOperand(1)), binding == Binding::Or ? Binding::BitOr : tighter),
          binding});
  };
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](ir::VarOp variable) {
        Statement statement;
        statement.declares = variable;
        out.push_back(std::move(statement));
      })
      .Case([&](ir::LoadOp load) {
        Code code = place(load.getAddress());
        Touches touches;
        touches.reads.insert(keyOf(load.getAddress()));
        flush(touches, out);
        define(op, code, touches, true, out);
      })
      .Case([&](ir::FrameLoadOp load) {
        for (const FrameField &field : machine.frame)
          if (!field.isObject && field.slot == load.getName()) {
            Touches touches;
            touches.reads.insert("frame " + field.slot);
            define(op, {machine.frameName + "." + field.name}, touches, true, out);
          }
      })
      .Case([&](ir::ExpressionOp whole) {
        bool isCompound;
        Code code = expression(source.entries[whole.getSource()], op.getOperands(), isCompound);
        usesScratch |= module.effects.expression(*source.entries[whole.getSource()].expr).usesScratch;
        pure(code);
      })
      .Case([&](ir::EvaluateOp inner) { evaluate(inner, out); })
      .Case([&](ir::ClearOp inner) { clear(inner, out); })
      .Case([&](ir::CopyOp copy) {
        const std::string from = place(copy.getSource()).text, to = place(copy.getTarget()).text;
        flush(touchesOf(&op), out);
        if (from != to)
          emit(out, to + " = " + from + ";");
      })
      .Case([&](ir::SpawnPayloadOp spawn) { spawnPayload(spawn); })
      .Case([&](ir::RandOp rand) {
        Touches touches = touchesOf(&op);
        flush(touches, out);
        define(op, {rand.getOpen() ? "rtsl::randOpen(rt)" : "rtsl::rand(rt)"}, touches, false, out);
      })
      .Case([&](ir::CallArgumentOp argument) {
        if (!llvm::isa<ir::PtrType>(argument.getType()))
          define(op, {machine.frameName + "." + machine.called->fields[machine.given(argument)]}, {}, true, out);
      })
      .Case([&](ir::CallResultOp result) {
        const std::string value = bind(use(result.getValue(), module.type(machine.method->returnType)), Binding::Assignment);
        emit(out, machine.frameName + "." + machine.called->returned + " = " + value + ";");
      })
      .Case([&](ir::CallReturnedOp) {
        const auto call = machine.callBefore.find(op.getParentOfType<mlir::func::FuncOp>().getSymName().str());
        if (op.getNumResults() != 0 && call->second)
          define(op, {machine.callName + "." + call->second->returned}, {}, true, out);
      })
      .Case([&](ir::CastRefOp cast) { pure(use(cast.getObject())); })
      .Case([&](ir::TraceResultOp) { define(op, {"rtsl::traced(rt)"}, {}, true, out); })
      .Case([&](ir::LightCountOp) { define(op, {"rtsl::lightCount(rt)"}, {}, true, out); })
      .Case([&](ir::IlluminateOp light) {
        std::vector<std::string> arguments = {"rt"};
        for (mlir::Value operand : op.getOperands())
          arguments.push_back(bind(use(operand), Binding::Assignment));
        Touches touches = touchesOf(&op);
        flush(touches, out);
        touches.add(consumed);
        define(op, {"rtsl::illuminate(" + join(arguments, ", ") + ")"}, touches, false, out);
      })
      .Case([&](ir::StoreOp stored) { store(stored, out); })
      .Case([&](ir::FrameStoreOp stored) {
        for (const FrameField &field : machine.frame)
          if (!field.isObject && field.slot == stored.getName()) {
            const std::string value = bind(use(stored.getValue(), field.type), Binding::Assignment);
            flush(touchesOf(&op), out);
            if (value != machine.frameName + "." + field.name)
              emit(out, machine.frameName + "." + field.name + " = " + value + ";");
          }
      })
      .Case([&](ir::SpawnOp spawn) {
        const std::string origin = bind(use(spawn.getOrigin(), "glm::vec3"), Binding::Assignment);
        spawned = origin + ", " + bind(use(spawn.getDirection(), "glm::vec3"), Binding::Assignment);
      })
      .Case([&](ir::ReturnOp end) { leave(end, out); })
      .Case([&](ir::BreakOp) { emit(out, "break;"); })
      .Case([&](ir::ContinueOp) { emit(out, "continue;"); })
      .Case([&](ir::IfOp inner) { choice(inner, out); })
      .Case([&](ir::LoopOp inner) { loop(inner, out); })
      .Case([&](ir::SwitchOp inner) { switchOver(inner, out); })
      .Case([&](mlir::vector::ExtractOp part) {
        auto position = part.getStaticPosition();
        if (position.size() != 1 || (!part.hasDynamicPosition() && position.front() > 3))
          return unsupported(op);
        const std::string vector = bind(use(part.getSource()), Binding::Primary);
        if (part.hasDynamicPosition())
          pure({"rtsl::at(" + vector + ", " + bind(use(part.getDynamicPosition().front()), Binding::Assignment) + ")"});
        else
          pure({vector + "." + "xyzw"[position.front()]});
      })
      .Case([&](mlir::vector::InsertOp part) {
        auto position = part.getStaticPosition();
        if (position.size() != 1 || (!part.hasDynamicPosition() && position.front() > 3))
          return unsupported(op);
        Insertion whole;
        if (auto before = insertions.find(part.getDest()); before != insertions.end() && pending.count(part.getDest()))
          whole = before->second;
        const std::string vector = use(part.getDest(), typeOf(part.getResult())).text;
        if (whole.parts.empty()) {
          whole.before = part.getDest();
          whole.vector = vector;
        }
        Insertion::Part &last = whole.parts.emplace_back();
        last.value = bind(use(part.getValueToStore()), Binding::Assignment);
        if (part.hasDynamicPosition())
          last.index = bind(use(part.getDynamicPosition().front()), Binding::Assignment);
        else
          last.component = "xyzw"[position.front()];
        insertions[part.getResult()] = whole;
        pure({whole.text()});
      })
      .Case([&](mlir::vector::FromElementsOp made) {
        const std::string type = typeOf(made.getResult());
        if (type.empty())
          return unsupported(op);
        std::vector<std::string> parts;
        for (mlir::Value part : made.getElements())
          parts.push_back(bind(use(part), Binding::Assignment));
        pure({type + "(" + join(parts, ", ") + ")"});
      })
      .Case([&](mlir::vector::BroadcastOp same) {
        const std::string type = typeOf(same.getResult());
        if (type.empty() || !same.getSourceType().isIntOrFloat())
          return unsupported(op);
        pure({type + "(" + bind(use(same.getSource()), Binding::Assignment) + ")"});
      })
      .Case([&](mlir::vector::ShuffleOp chosen) {
        const std::string type = typeOf(chosen.getResult());
        if (type.empty())
          return unsupported(op);
        const std::string first = named(chosen.getV1(), out);
        const std::string second = chosen.getV1() == chosen.getV2() ? first : named(chosen.getV2(), out);
        const std::int64_t width = chosen.getV1VectorType().getNumElements();
        std::vector<std::string> parts;
        for (std::int64_t component : chosen.getMask())
          parts.push_back(component < width ? first + "." + "xyzw"[component] : second + "." + "xyzw"[component - width]);
        pure({type + "(" + join(parts, ", ") + ")"});
      })
      .Case([&](arith::XOrIOp negation) {
        if (!op.getResult(0).getType().isInteger(1) || !mlir::matchPattern(negation.getRhs(), mlir::m_One()))
          return unsupported(op);
        pure(opposite(negation.getLhs(), use(negation.getLhs())));
      })
      .Case([&](arith::AndIOp) {
        op.getResult(0).getType().isInteger(1) ? infix("&&", Binding::And) : unsupported(op);
      })
      .Case([&](arith::OrIOp) {
        op.getResult(0).getType().isInteger(1) ? infix("||", Binding::Or) : unsupported(op);
      })
      .Case([&](arith::IndexCastUIOp index) { pure(use(index.getIn())); })
      .Case([&](arith::AddIOp) { infix("+", Binding::Sum); }) // of a light's number
      .Case([&](arith::CmpIOp compare) {
        compare.getPredicate() == arith::CmpIPredicate::ult ? infix("<", Binding::Relation) : unsupported(op);
      })
      .Case([&](arith::SelectOp select) {
        const std::string type = typeOf(select.getResult());
        const std::string condition = bind(use(select.getCondition()), Binding::Or);
        const std::string first = bind(use(select.getTrueValue(), type), Binding::Assignment);
        const std::string second = bind(use(select.getFalseValue(), type), Binding::Assignment);
        pure({choose(condition, first, second, type), Binding::Assignment});
      })
      .Case<arith::ConstantOp, ir::NullRefOp, ir::NextOp, ir::StateOp, ir::YieldOp, ir::ConditionOp,
            ir::TraceReturnedOp, ir::EnterOp, ir::LeaveOp, ir::FrameObjectOp, ir::PayloadOp, ir::FieldOp, ir::TableOp>([](auto) {})
      .Case([&](ir::ElementOp element) { elementIndices[element] = bind(use(element.getIndex()), Binding::Assignment); })
      .Default([&](mlir::Operation *) { unsupported(op); });
}

//===----------------------------------------------------------------------===//
// The end of a state
//===----------------------------------------------------------------------===//

void StateWriter::spawnPayload(ir::SpawnPayloadOp op) {
  std::vector<std::string> arguments = {bind(use(op.getOrigin(), "glm::vec3"), Binding::Assignment),
                                        bind(use(op.getDirection(), "glm::vec3"), Binding::Assignment),
                                        bind(use(op.getTmin()), Binding::Assignment),
                                        bind(use(op.getTmax()), Binding::Assignment), place(op.getPayload()).text};
  const mlir::Value options[] = {op.getRoot(), op.getMask(), op.getTime()};
  for (mlir::Value optional : options)
    if (optional)
      arguments.push_back(bind(use(optional), Binding::Assignment));
  spawned = join(arguments, ", ");
}

/// A call behind which the state ends: its arguments are looked at there, for what is saved is saved before.
std::string StateWriter::call(ir::ReturnOp op) {
  mlir::Operation *at = op;
  while (at && !llvm::isa<ir::EnterOp>(at))
    at = at->getPrevNode();
  auto enter = llvm::dyn_cast_or_null<ir::EnterOp>(at);
  const CalledMethod *called = enter ? module.calledMethod(enter.getCallee().str()) : nullptr;
  if (!called) {
    unsupported(*op);
    return {};
  }
  std::vector<std::string> arguments = {"rt"}, given;
  if (machine.hasFrame())
    arguments.push_back(machine.frameName);
  arguments.push_back("Step::" + machine.stepOf.at(enter.getResume()->str()));
  arguments.push_back(bind(use(enter.getOperands().front()), Binding::Assignment));
  for (auto [variable, value] : llvm::zip(called->given, enter.getOperands().drop_front()))
    given.push_back(llvm::isa<ir::PtrType>(value.getType())
                        ? "&" + place(value).text
                        : bind(use(value, module.type(variable->type)), Binding::Assignment));
  arguments.push_back(module.structureOf(*called) + "{" + join(given, ", ") + "}");
  return "return rtsl::callThen(" + join(arguments, ", ") + ");";
}

void StateWriter::leave(ir::ReturnOp op, Statements &out) {
  auto next = op.getValues().empty() ? ir::NextOp() : op.getValues().front().getDefiningOp<ir::NextOp>();
  if (!next || next.getTransition() == ir::Transition::Done)
    return emit(out, "return rtsl::done;");
  if (next.getTransition() == ir::Transition::Last)
    return emit(out, "return rtsl::traceLast(rt, " + spawned + ");");
  if (next.getTransition() == ir::Transition::Return)
    return emit(out, "return rtsl::returnToCaller(rt);");
  if (next.getTransition() == ir::Transition::Jump)
    return emit(out, call(op));
  const std::string &step = machine.stepOf.at(next.getState()->str());
  emit(out, "return rtsl::traceThen(rt, Step::" + step + ", " + spawned + ");");
}

} // namespace rtsl::cpp
