//===- StateWriter.cpp - the body of a state ------------------------------===//
#include "codegen/cpp/StateWriter.h"

#include "codegen/passes/continuation/Names.h"
#include "sema/Casting.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/Matchers.h"
#include "llvm/ADT/TypeSwitch.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

namespace arith = mlir::arith;
using typed::ExprKind;

unsigned lineOf(mlir::Location location) {
  if (auto file = llvm::dyn_cast<mlir::FileLineColLoc>(location))
    return file.getLine();
  if (auto name = llvm::dyn_cast<mlir::NameLoc>(location))
    return lineOf(name.getChildLoc());
  if (auto call = llvm::dyn_cast<mlir::CallSiteLoc>(location))
    return lineOf(call.getCallee());
  if (auto fused = llvm::dyn_cast<mlir::FusedLoc>(location))
    for (mlir::Location part : fused.getLocations())
      if (unsigned line = lineOf(part))
        return line;
  return 0;
}

StateWriter::StateWriter(ModulePrinter &module, const SourceTable &source, Machine &machine)
    : module(module), source(source), machine(machine), printer(module, machine.method) {
  always = module.namesInScope(*machine.definition);
  while (always.count(machine.frameName))
    machine.frameName += '_';
  always.insert(machine.frameName);
}

void StateWriter::Touches::add(const Touches &other) {
  reads.insert(other.reads.begin(), other.reads.end());
  writes.insert(other.writes.begin(), other.writes.end());
  readsAny |= other.readsAny;
  writesAny |= other.writesAny;
}

/// Would it show if the two changed places?
bool StateWriter::meet(const Touches &a, const Touches &b) {
  auto common = [](const std::set<std::string> &x, const std::set<std::string> &y) {
    return std::any_of(x.begin(), x.end(), [&](const std::string &key) { return y.count(key) != 0; });
  };
  // Unknown methods reach the ray's state and draw random numbers; variables and the frame are this function's own.
  auto isOpen = [](const std::set<std::string> &keys) {
    return std::any_of(keys.begin(), keys.end(), [](const std::string &key) {
      return key.compare(0, 6, "state ") == 0 || key == "random";
    });
  };
  auto writesMeet = [&](const Touches &x, const Touches &y) {
    return common(x.writes, y.reads) || common(x.writes, y.writes) ||
           (x.writesAny && (y.readsAny || y.writesAny || isOpen(y.reads) || isOpen(y.writes))) ||
           (x.readsAny && isOpen(y.writes));
  };
  return writesMeet(a, b) || writesMeet(b, a);
}

void StateWriter::unsupported(mlir::Operation &op) {
  if (hasRefused) // one message a method says enough
    return;
  hasRefused = true;
  std::string what = op.getName().stripDialect().str();
  if (llvm::isa<ir::VarOp, ir::TableOp>(op))
    what = "an array or a struct";
  const unsigned line = lineOf(op.getLoc());
  module.unsupported(machine.method->range,
                     fmt::format("{} in states in C++{} (--trace=recurse keeps `trace` as a call)", what,
                                 line ? fmt::format(", of line {}", line) : ""));
}

//===----------------------------------------------------------------------===//
// Names and types
//===----------------------------------------------------------------------===//

std::string StateWriter::freshName(std::string wanted) {
  std::string clean;
  for (char c : wanted)
    clean += std::isalnum(static_cast<unsigned char>(c)) || c == '_' ? c : '_';
  while (clean.find("__") != std::string::npos)
    clean.erase(clean.find("__"), 1);
  if (clean.empty() || std::isdigit(static_cast<unsigned char>(clean.front())))
    clean = "value" + clean;
  std::string name = clean;
  for (unsigned i = 2; isReserved(name) || always.count(name) || !taken.insert(name).second; ++i)
    name = clean + (i == 2 && (isReserved(clean) || always.count(clean)) ? "_" : std::to_string(i));
  return name;
}

/// What the operations of the IR are called among people.
static std::string nameFor(mlir::Value value) {
  if (std::string name = continuation::authorsName(value); !name.empty())
    return name.substr(0, name.find('.') == std::string::npos ? name.size() : name.find('.'));
  mlir::Operation *op = value.getDefiningOp();
  if (llvm::isa_and_nonnull<ir::RandOp>(op))
    return "random";
  if (llvm::isa_and_nonnull<ir::TraceResultOp>(op))
    return "traced";
  if (auto load = llvm::dyn_cast_or_null<ir::FrameLoadOp>(op))
    return load.getName().str();
  if (auto load = llvm::dyn_cast_or_null<ir::LoadOp>(op)) {
    std::string name = continuation::sourceName(value);
    name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
    return name;
  }
  return "value";
}

const std::string &StateWriter::nameOf(ir::VarOp variable) {
  std::string &name = variableNames[variable];
  if (name.empty())
    name = freshName(variable.getName().str());
  return name;
}

/// Does the text have the word?
static bool mentions(const std::string &text, const std::string &word) {
  auto isPart = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if ((at == 0 || !isPart(text[at - 1])) && (at + word.size() == text.size() || !isPart(text[at + word.size()])))
      return true;
  return false;
}

static std::string scalarType(mlir::Type type) {
  if (type.isF32())
    return "float";
  if (type.isInteger(1))
    return "bool";
  if (type.isInteger(32))
    return "int";
  return {};
}

static std::string stateType(llvm::StringRef name) {
  static const std::map<std::string, std::string> types = {
#define RTSL_STATE_VARIABLE(name, type) {#name, #type},
#include "runtime/device/StateVariables.def"
  };
  const std::string &word = types.at(name.str());
  if (word == "color")
    return "Color";
  if (word == "uint2")
    return "glm::uvec2";
  return word == "float" || word == "int" ? word : "glm::" + word;
}

const Type *StateWriter::declaredType(mlir::Value address) {
  mlir::Operation *op = address.getDefiningOp();
  if (llvm::isa_and_nonnull<ir::PayloadOp>(op))
    return machine.method->parameters.front()->type;
  if (auto field = llvm::dyn_cast_or_null<ir::FieldOp>(op)) {
    const Type *base = declaredType(field.getBase());
    if (base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return part.type;
    return nullptr;
  }
  if (auto element = llvm::dyn_cast_or_null<ir::ElementOp>(op)) {
    const Type *base = declaredType(element.getBase());
    return base && base->is(TypeKind::Array) ? base->element : nullptr;
  }
  auto number = op ? op->getAttrOfType<mlir::IntegerAttr>("rtsl.declared") : mlir::IntegerAttr();
  return number ? source.types[static_cast<std::size_t>(number.getInt())] : nullptr;
}

std::string StateWriter::varType(ir::VarOp variable) {
  auto [at, isNew] = variableTypes.try_emplace(variable);
  if (!isNew)
    return at->second;
  if (const Type *declared = declaredType(variable))
    return variableTypes[variable] = module.type(declared);
  std::string type;
  for (mlir::Operation *user : variable->getUsers())
    if (auto store = llvm::dyn_cast<ir::StoreOp>(user); store && type.empty())
      type = typeOf(store.getValue());
  if (type.empty())
    type = scalarType(llvm::cast<ir::PtrType>(variable.getType()).getPointee());
  return variableTypes[variable] = type;
}

std::string StateWriter::typeOf(mlir::Value value) {
  mlir::Operation *op = value.getDefiningOp();
  if (!op)
    return {};
  if (llvm::isa<ir::PtrType>(value.getType())) {
    const Type *declared = declaredType(value);
    return declared ? module.type(declared) : std::string();
  }
  return llvm::TypeSwitch<mlir::Operation *, std::string>(op)
      .Case([&](ir::ExpressionOp expression) {
        const SourceTable::Entry &entry = source.entries[expression.getSource()];
        return entry.kind == SourceTable::Kind::AngleCosine ? "float" : module.type(entry.expr->type);
      })
      .Case([&](ir::EvaluateOp call) { return module.type(source.entries[call.getSource()].expr->type); })
      .Case([&](ir::LoadOp load) {
        if (auto variable = load.getAddress().getDefiningOp<ir::VarOp>())
          return varType(variable);
        if (auto state = load.getAddress().getDefiningOp<ir::StateOp>())
          return stateType(state.getName());
        if (const Type *declared = declaredType(load.getAddress()))
          return module.type(declared);
        return scalarType(value.getType());
      })
      .Case([&](ir::FrameLoadOp load) {
        for (const FrameField &field : machine.frame)
          if (!field.isObject && field.slot == load.getName())
            return field.type;
        return std::string();
      })
      .Case<ir::TraceResultOp>([](auto) { return std::string("Color"); })
      .Case([&](arith::SelectOp select) {
        std::string type = typeOf(select.getTrueValue());
        return type.empty() ? typeOf(select.getFalseValue()) : type;
      })
      .Case([&](mlir::vector::InsertOp insert) { return typeOf(insert.getDest()); })
      .Default([&](mlir::Operation *) { return scalarType(value.getType()); });
}

//===----------------------------------------------------------------------===//
// What is evaluated when
//===----------------------------------------------------------------------===//

std::string StateWriter::keyOf(mlir::Value address) {
  mlir::Operation *op = address.getDefiningOp();
  while (llvm::isa_and_nonnull<ir::FieldOp, ir::ElementOp>(op))
    op = op->getOperand(0).getDefiningOp();
  if (auto object = llvm::dyn_cast_or_null<ir::FrameObjectOp>(op))
    return "object " + object.getName().str();
  if (llvm::isa_and_nonnull<ir::PayloadOp>(op))
    return "payload";
  if (auto state = llvm::dyn_cast_or_null<ir::StateOp>(op))
    return "state " + state.getName().str();
  if (llvm::isa_and_nonnull<ir::VarOp>(op))
    return fmt::format("var {}", static_cast<const void *>(op));
  return {};
}

void StateWriter::note(mlir::Value address, Touches &touches, bool isWritten) {
  (isWritten ? touches.writes : touches.reads).insert(keyOf(address));
}

static bool changes(ir::EvaluateOp op, std::size_t operand) {
  auto changed = op->getAttrOfType<mlir::DenseI32ArrayAttr>("rtsl.changes");
  return changed && llvm::is_contained(changed.asArrayRef(), static_cast<std::int32_t>(operand));
}

StateWriter::Touches StateWriter::touchesOf(mlir::Operation *op) {
  Touches touches;
  op->walk([&](mlir::Operation *inner) {
    if (auto load = llvm::dyn_cast<ir::LoadOp>(inner))
      touches.reads.insert(keyOf(load.getAddress()));
    else if (auto store = llvm::dyn_cast<ir::StoreOp>(inner))
      touches.writes.insert(keyOf(store.getAddress()));
    else if (auto frameLoad = llvm::dyn_cast<ir::FrameLoadOp>(inner))
      touches.reads.insert("frame " + frameLoad.getName().str());
    else if (auto frameStore = llvm::dyn_cast<ir::FrameStoreOp>(inner))
      touches.writes.insert("frame " + frameStore.getName().str());
    else if (llvm::isa<ir::RandOp>(inner))
      touches.writes.insert("random");
    else if (auto clear = llvm::dyn_cast<ir::ClearOp>(inner))
      note(clear.getAddress(), touches, true);
    else if (auto copy = llvm::dyn_cast<ir::CopyOp>(inner)) {
      note(copy.getSource(), touches, false);
      note(copy.getTarget(), touches, true);
    } else if (auto call = llvm::dyn_cast<ir::EvaluateOp>(inner)) {
      for (auto [index, operand] : llvm::enumerate(call.getOperands()))
        if (llvm::isa<ir::PtrType>(operand.getType())) {
          note(operand, touches, false);
          if (changes(call, index))
            note(operand, touches, true);
        }
      if (!call->hasAttr("rtsl.plain")) {
        touches.readsAny = true;
        touches.writes.insert("random");
        touches.writesAny = !call.getWrites();
      }
      if (call.getWrites())
        for (auto name : call.getWrites()->getAsRange<mlir::StringAttr>())
          touches.writes.insert("state " + name.getValue().str());
    } else if (llvm::isa<ir::IlluminateOp>(inner)) {
      touches.readsAny = touches.writesAny = true;
    }
  });
  return touches;
}

void StateWriter::emit(Statements &out, std::string text) {
  Statement statement;
  if (auto comment = comments.find(currentLine); comment != comments.end()) {
    statement.comment = module.commentText(comment->second);
    comments.erase(comment);
  }
  if (currentLine != 0)
    statement.comment += module.lineDirective(machine.method->range, currentLine);
  statement.text = std::move(text);
  statement.mentions = std::move(mentioned);
  mentioned.clear();
  out.push_back(std::move(statement));
}

/// Gives a value that waits for its use a variable now.
void StateWriter::materialise(mlir::Value value, Statements &out) {
  Pending waiting = std::move(pending[value]);
  pending.erase(value);
  const std::set<mlir::Operation *> before = std::move(mentioned);
  mentioned.clear();
  const std::string type = typeOf(value);
  if (type.empty())
    unsupported(*value.getDefiningOp());
  const std::string name = freshName(nameFor(value));
  emit(out, fmt::format("{} {};", type, declarator(type, name, waiting.code.text)));
  declared[value] = name;
  mentioned = before;
}

/// Before something that touches this happens, what waits and would notice is evaluated.
void StateWriter::flush(const Touches &touches, Statements &out) {
  llvm::SmallVector<mlir::Value> first;
  for (auto &[value, waiting] : pending)
    if (meet(waiting.touches, touches))
      first.push_back(value);
  for (mlir::Value value : first)
    materialise(value, out);
}

/// Before a construct with regions: what an inner statement would change cannot wait for another region, and nothing that
/// is used once waits to be evaluated in each round of a loop.
void StateWriter::flushBefore(mlir::Operation &op, Statements &out) {
  const Touches inside = touchesOf(&op);
  const bool isLoop = llvm::isa<ir::LoopOp>(op);
  llvm::SmallVector<mlir::Value> first;
  for (auto &[value, waiting] : pending) {
    const bool isConstant = waiting.isTrivial && waiting.touches.reads.empty();
    if (!waiting.isPure || meet(waiting.touches, inside) || (isLoop && waiting.usesLeft == 1 && !isConstant))
      first.push_back(value);
  }
  for (mlir::Value value : first)
    materialise(value, out);
}

/// An operation has given a value: it waits for its use, or gets a variable.
void StateWriter::define(mlir::Operation &op, Code code, Touches touches, bool isPure, Statements &out) {
  mlir::Value value = op.getResult(0);
  const auto uses = static_cast<unsigned>(std::distance(value.use_begin(), value.use_end()));
  if (uses == 0) {
    if (!isPure)
      emit(out, code.text + ";");
    return;
  }
  auto *user = *value.user_begin();
  auto stores = [&] {
    return llvm::isa<ir::FrameStoreOp>(user) ||
           (llvm::isa<ir::StoreOp>(user) && user->getBlock() == op.getBlock());
  };
  const bool isNamed = llvm::isa<ir::ExpressionOp, ir::EvaluateOp, ir::RandOp>(op) &&
                       !continuation::authorsName(value).empty();
  const bool isRead = llvm::isa<ir::LoadOp, ir::FrameLoadOp>(op);
  auto expression = llvm::dyn_cast<ir::ExpressionOp>(op);
  const bool isTrivial = isRead || llvm::isa<ir::LightCountOp>(op) ||
                         (expression && expression.getNumOperands() == 0 && expression.getCost() <= 6);
  pending[value] = {std::move(code), std::move(touches), uses, isPure, isTrivial};
  if (uses == 1 ? isNamed && !stores() : isNamed || !isTrivial)
    materialise(value, out);
}

Code StateWriter::use(mlir::Value value, const std::string &type) {
  if (auto found = declared.find(value); found != declared.end())
    return {found->second};
  auto found = pending.find(value);
  if (found == pending.end())
    return constant(value, type);
  Code code = found->second.code;
  consumed.add(found->second.touches);
  if (--found->second.usesLeft == 0)
    pending.erase(value);
  return code;
}

Code StateWriter::constant(mlir::Value value, const std::string &type) {
  mlir::Attribute attribute;
  if (!mlir::matchPattern(value, mlir::m_Constant(&attribute))) {
    if (value.getDefiningOp<ir::NullRefOp>())
      return {type.empty() ? "{}" : type + "{}"};
    if (value.getDefiningOp())
      unsupported(*value.getDefiningOp());
    return {"0"};
  }
  if (auto integer = llvm::dyn_cast<mlir::IntegerAttr>(attribute)) {
    if (integer.getType().isInteger(1))
      return {integer.getValue().isZero() ? "false" : "true"};
    return {std::to_string(integer.getInt())};
  }
  if (auto number = llvm::dyn_cast<mlir::FloatAttr>(attribute))
    return {floatText(number.getValue().convertToFloat())};
  auto dense = llvm::dyn_cast<mlir::DenseElementsAttr>(attribute);
  if (!type.empty() && dense && dense.isSplat() && dense.getElementType().isF32())
    return {type + "(" + floatText(dense.getSplatValue<float>()) + ")"};
  unsupported(*value.getDefiningOp());
  return {"0"};
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

Code StateWriter::place(mlir::Value address) {
  if (auto state = address.getDefiningOp<ir::StateOp>())
    return {"rt." + state.getName().str()};
  if (auto variable = address.getDefiningOp<ir::VarOp>()) {
    mentioned.insert(variable);
    return {nameOf(variable)};
  }
  if (auto object = address.getDefiningOp<ir::FrameObjectOp>())
    for (const FrameField &field : machine.frame)
      if (field.isObject && field.slot == object.getName())
        return {machine.frameName + "." + field.name};
  if (address.getDefiningOp<ir::PayloadOp>())
    return {module.names.of(machine.method->parameters.front().get())};
  if (auto field = address.getDefiningOp<ir::FieldOp>())
    if (const Type *base = declaredType(field.getBase()); base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return {place(field.getBase()).text + "." + module.names.of(&part)};
  if (auto element = address.getDefiningOp<ir::ElementOp>())
    return {place(element.getBase()).text + "[" + elementIndices[element] + "]"};
  unsupported(*address.getDefiningOp());
  return {"0"};
}

/// `isCompound`: on return, whether the first operand is the target of `target op= value`, which may be printed so.
Code StateWriter::expression(const SourceTable::Entry &entry, mlir::ValueRange operands, bool &isCompound) {
  isCompound = false;
  printer.replaced.clear();
  for (auto [leaf, operand] : llvm::zip(entry.leaves, operands)) {
    if (!leaf)
      continue;
    const Code code = llvm::isa<ir::PtrType>(operand.getType()) ? place(operand) : use(operand, module.type(leaf->type));
    printer.replaced[leaf] = code;
  }
  nameConstants(*entry.expr);
  switch (entry.kind) {
  case SourceTable::Kind::Value:
  case SourceTable::Kind::Into:
    return printer.expr(*entry.expr);
  case SourceTable::Kind::AngleCosine:
    return {"rtsl::cosOfAngle(" + printer.argument(*entry.expr) + ")"};
  case SourceTable::Kind::Compound: {
    const auto &assign = static_cast<const typed::AssignExpr &>(*entry.expr);
    isCompound = printer.plainOperator(assign.op, *assign.target, *assign.value) != nullptr;
    return printer.binary(assign.op, *assign.target, *assign.value);
  }
  case SourceTable::Kind::Step: {
    const auto &step = static_cast<const typed::IncDecExpr &>(*entry.expr);
    const Type *scalar = step.target->type->scalar();
    const std::string target = printer.operand(*step.target, Binding::Sum);
    if (scalar->is(TypeKind::Int))
      return {fmt::format("rtsl::{}({}, 1)", step.increment ? "add" : "sub", target)};
    return {fmt::format("{} {} {}", target, step.increment ? "+" : "-", scalar->is(TypeKind::Float) ? "1.0f" : "1u"),
            Binding::Sum};
  }
  }
  return {"0"};
}

Code negated(const Code &code) {
  if (code.binding != Binding::Unary || code.text.front() != '!')
    return {"!" + bind(code, Binding::Unary), Binding::Unary};
  const std::string inner = code.text.substr(1);
  int depth = 0; // do parentheses hold all of it?
  std::size_t end = 0;
  do
    depth += inner[end] == '(' ? 1 : inner[end] == ')' ? -1 : 0;
  while (depth != 0 && ++end != inner.size());
  if (inner.front() == '(' && end + 1 == inner.size())
    return {inner.substr(1, inner.size() - 2), Binding::Assignment};
  return {inner, Binding::Primary};
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

void StateWriter::operation(mlir::Operation &op, Statements &out) {
  consumed = {};
  if (unsigned line = lineOf(op.getLoc()))
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
      .Case([&](ir::RandOp) {
        Touches touches = touchesOf(&op);
        flush(touches, out);
        define(op, {"rtsl::rand(rt)"}, touches, false, out);
      })
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
        if (part.hasDynamicPosition() || position.size() != 1 || position.front() > 3)
          return unsupported(op);
        pure({bind(use(part.getSource()), Binding::Primary) + "." + "xyzw"[position.front()]});
      })
      .Case([&](mlir::vector::InsertOp part) {
        auto position = part.getStaticPosition();
        if (part.hasDynamicPosition() || position.size() != 1 || position.front() > 3)
          return unsupported(op);
        const std::string vector = use(part.getDest(), typeOf(part.getDest())).text;
        const std::string value = bind(use(part.getValueToStore()), Binding::Assignment);
        insertions[part.getResult()] = {vector, value, static_cast<unsigned>(position.front())};
        pure({fmt::format("rtsl::with<{}>({}, {})", position.front(), vector, value)});
      })
      .Case([&](arith::XOrIOp negation) {
        if (!op.getResult(0).getType().isInteger(1) || !mlir::matchPattern(negation.getRhs(), mlir::m_One()))
          return unsupported(op);
        pure(negated(use(negation.getLhs())));
      })
      .Case([&](arith::AndIOp) {
        op.getResult(0).getType().isInteger(1) ? infix("&&", Binding::And) : unsupported(op);
      })
      .Case([&](arith::OrIOp) {
        op.getResult(0).getType().isInteger(1) ? infix("||", Binding::Or) : unsupported(op);
      })
      .Case([&](arith::AddIOp) { infix("+", Binding::Sum); }) // of a light's number
      .Case([&](arith::CmpIOp compare) {
        compare.getPredicate() == arith::CmpIPredicate::ult ? infix("<", Binding::Relation) : unsupported(op);
      })
      .Case([&](arith::SelectOp select) {
        const std::string type = typeOf(select.getResult());
        const std::string condition = bind(use(select.getCondition()), Binding::Or);
        const std::string first = bind(use(select.getTrueValue(), type), Binding::Assignment);
        pure({condition + " ? " + first + " : " + bind(use(select.getFalseValue(), type), Binding::Assignment),
              Binding::Assignment});
      })
      .Case<arith::ConstantOp, ir::NullRefOp, ir::NextOp, ir::StateOp, ir::YieldOp, ir::ConditionOp,
            ir::TraceReturnedOp, ir::FrameObjectOp, ir::PayloadOp, ir::FieldOp, ir::TableOp>([](auto) {})
      .Case([&](ir::ElementOp element) { elementIndices[element] = bind(use(element.getIndex()), Binding::Assignment); })
      .Default([&](mlir::Operation *) { unsupported(op); });
}

/// Constant arrays and structs of a function are declared where a state names them.
void StateWriter::nameConstants(const typed::Expr &expr) {
  std::set<const typed::Expr *> elsewhere;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (printer.replaced.count(&inner))
      forEachExpr(inner, [&](const typed::Expr &part) { elsewhere.insert(&part); });
  });
  forEachExpr(expr, [&](const typed::Expr &inner) {
    auto *named = dynCast<typed::VariableExpr>(&inner);
    if (named && named->variable->isConst && named->variable->kind != typed::Variable::Kind::Global &&
        !elsewhere.count(&inner) && std::find(constants.begin(), constants.end(), named->variable) == constants.end())
      constants.push_back(named->variable);
  });
}

bool writesTo(mlir::Operation *op, mlir::Value address) {
  if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    return store.getAddress() == address;
  if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    return clear.getAddress() == address;
  if (auto copy = llvm::dyn_cast<ir::CopyOp>(op))
    return copy.getTarget() == address;
  if (auto spawn = llvm::dyn_cast<ir::SpawnPayloadOp>(op))
    return spawn.getPayload() == address;
  if (auto evaluation = llvm::dyn_cast<ir::EvaluateOp>(op))
    for (auto [index, operand] : llvm::enumerate(evaluation.getOperands()))
      if (operand == address && changes(evaluation, index))
        return true;
  return llvm::isa<ir::FieldOp, ir::ElementOp>(op) &&
         llvm::any_of(op->getUsers(), [&](mlir::Operation *user) { return writesTo(user, op->getResult(0)); });
}

/// Variables that stay whole are read and written where they lie, by the author's expression.
void StateWriter::evaluate(ir::EvaluateOp op, Statements &out) {
  const SourceTable::Entry &entry = source.entries[op.getSource()];
  usesScratch |= module.effects.expression(*entry.expr).usesScratch;
  bool isCompound;
  const bool isWrite = entry.expr->kind == ExprKind::Assign || entry.expr->kind == ExprKind::IncDec;
  std::vector<std::string> before;
  printer.before = &before;
  Code code;
  if (isWrite) {
    printer.replaced.clear();
    for (auto [leaf, operand] : llvm::zip(entry.leaves, op.getOperands()))
      printer.replaced[leaf] = llvm::isa<ir::PtrType>(operand.getType()) ? place(operand) : use(operand, module.type(leaf->type));
    nameConstants(*entry.expr);
    code = {printer.expressionStatement(*entry.expr)};
    while (!code.text.empty() && (code.text.back() == '\n' || code.text.back() == ';'))
      code.text.pop_back();
  } else {
    code = expression(entry, op.getOperands(), isCompound);
  }
  printer.before = nullptr;
  Touches touches = touchesOf(op);
  if (entry.kind == SourceTable::Kind::Into) {
    auto variable = op.getOperand(0).getDefiningOp<ir::VarOp>();
    const std::string target = place(op.getOperand(0)).text;
    flush(touches, out);
    // Nothing has looked at what it held before.
    auto isItsClear = [&](const Statement &statement) { return statement.text == target + " = {};"; };
    if (!out.empty() && isItsClear(out.back()) && !mentions(code.text, target))
      out.pop_back();
    for (std::string &statement : before)
      emit(out, std::move(statement));
    mentioned = {};
    for (mlir::Value operand : op.getOperands())
      for (mlir::Value at = operand; at;) {
        mlir::Operation *defining = at.getDefiningOp();
        if (llvm::isa_and_nonnull<ir::VarOp>(defining))
          mentioned.insert(defining);
        at = llvm::isa_and_nonnull<ir::FieldOp, ir::ElementOp>(defining) ? defining->getOperand(0) : mlir::Value();
      }
    emit(out, target + " = " + code.text + ";");
    if (variable && !mentions(code.text, target)) {
      out.back().assigns = variable;
      out.back().value = code.text;
    }
    return;
  }
  flush(touches, out);
  const std::set<mlir::Operation *> mentionedHere = mentioned;
  for (std::string &statement : before) {
    mentioned = mentionedHere;
    emit(out, std::move(statement));
  }
  mentioned = mentionedHere;
  touches.add(consumed);
  if (op.getNumResults() == 0) {
    if (!code.text.empty())
      emit(out, code.text + ";");
    return;
  }
  define(*op, code, touches, /*isPure=*/op->hasAttr("rtsl.plain") && !op->hasAttr("rtsl.changes"), out);
}

void StateWriter::clear(ir::ClearOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const std::string target = place(op.getAddress()).text;
  flush(touchesOf(op), out);
  emit(out, target + " = {};");
  if (variable) {
    out.back().assigns = variable;
    out.back().value = "{}";
  }
}

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

/// `target += y` for `target + y`, where `value` is the whole expression of the source that made it.
std::string StateWriter::assignment(const std::string &target, const std::string &value, mlir::Value made) {
  auto whole = made.getDefiningOp<ir::ExpressionOp>();
  if (whole && source.entries[whole.getSource()].kind == SourceTable::Kind::Compound) {
    const auto &assign = static_cast<const typed::AssignExpr &>(*source.entries[whole.getSource()].expr);
    const char *sign = printer.plainOperator(assign.op, *assign.target, *assign.value);
    const std::string begin = sign ? target + " " + sign + " " : std::string();
    if (sign && value.compare(0, begin.size(), begin) == 0)
      return target + " " + sign + "= " + value.substr(begin.size()) + ";";
  }
  return target + " = " + value + ";";
}

void StateWriter::store(ir::StoreOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const Type *declared = variable ? nullptr : declaredType(op.getAddress());
  const std::string type = variable ? varType(variable) : declared ? module.type(declared) : typeOf(op.getValue());
  const std::string target = place(op.getAddress()).text;
  // A component of what lies there.
  auto insertion = insertions.find(op.getValue());
  const bool isPart = insertion != insertions.end() && pending.count(op.getValue()) &&
                      insertion->second.vector == target;
  const std::string value = bind(use(op.getValue(), type), Binding::Assignment);
  flush(touchesOf(op), out);
  if (value == target)
    return;
  if (isPart) {
    const std::string part = target + "." + "xyzw"[insertion->second.component];
    mlir::Value scalar = op.getValue().getDefiningOp<mlir::vector::InsertOp>().getValueToStore();
    return emit(out, assignment(part, insertion->second.value, scalar));
  }
  // What it held before nobody has looked at.
  if (!out.empty() && !mentions(value, target))
    for (const char *zero : {"{}", "0.0f", "0", "0u", "false", "glm::vec2(0.0f)", "glm::vec3(0.0f)", "glm::vec4(0.0f)", "Color(0.0f)"})
      if (out.back().comment.empty() && out.back().text == target + " = " + zero + ";") {
        out.pop_back();
        break;
      }
  emit(out, assignment(target, value, op.getValue()));
  if (variable) {
    out.back().assigns = variable;
    out.back().value = value;
  }
  auto load = op.getValue().getDefiningOp<ir::LoadOp>();
  auto from = load ? load.getAddress().getDefiningOp<ir::FieldOp>() : ir::FieldOp();
  joinFields(op.getAddress(), from, target, value, out);
}

/// Field by field is how passes copy and clear a struct: `a.x = b.x; a.y = b.y;` is `a = b;`.
void StateWriter::joinFields(mlir::Value address, ir::FieldOp from, const std::string &target, const std::string &value, Statements &out) {
  auto field = address.getDefiningOp<ir::FieldOp>();
  const Type *type = field ? declaredType(field.getBase()) : nullptr;
  if (!type || !type->is(TypeKind::Struct))
    return;
  const std::vector<typed::Field> &fields = type->structure->fields;
  const std::string whole = place(field.getBase()).text;
  mentioned.clear();
  const std::string part = target.substr(whole.size()); // ".x"
  const bool isCopy = from && declaredType(from.getBase()) == type && value.size() > part.size() && value.compare(value.size() - part.size(), part.size(), part) == 0;
  const bool isZero = value == "0.0f" || value == "0" || value == "false" || value == module.type(declaredType(address)) + "(0.0f)";
  if (!isCopy && !isZero)
    return;
  Statement &last = out.back();
  last.whole = whole;
  last.from = isZero ? "{}" : value.substr(0, value.size() - part.size());
  if (out.size() < fields.size())
    return;
  std::set<mlir::Operation *> all;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Statement &one = out[out.size() - fields.size() + i];
    const std::string begin = whole + "." + module.names.of(&fields[i]) + " = ";
    if (one.whole != whole || one.from != last.from || one.text.compare(0, begin.size(), begin) != 0)
      return;
    all.insert(one.mentions.begin(), one.mentions.end());
  }
  Statement joined;
  joined.comment = out[out.size() - fields.size()].comment;
  joined.text = whole + " = " + last.from + ";";
  joined.mentions = std::move(all);
  if (auto variable = field.getBase().getDefiningOp<ir::VarOp>()) {
    joined.assigns = variable;
    joined.value = last.from;
  }
  out.resize(out.size() - fields.size());
  if (!out.empty() && out.back().text == whole + " = {};")
    out.pop_back();
  out.push_back(std::move(joined));
}

void StateWriter::leave(ir::ReturnOp op, Statements &out) {
  auto next = op.getValues().empty() ? ir::NextOp() : op.getValues().front().getDefiningOp<ir::NextOp>();
  if (!next || next.getTransition() == ir::Transition::Done)
    return emit(out, "return rtsl::done;");
  if (next.getTransition() == ir::Transition::Last)
    return emit(out, "return rtsl::traceLast(rt, " + spawned + ");");
  const std::string &step = machine.stepOf.at(next.getState()->str());
  if (next.getTransition() == ir::Transition::Jump)
    return unsupported(*op);
  emit(out, "return rtsl::traceThen(rt, Step::" + step + ", " + spawned + ");");
}

} // namespace rtsl::cpp
