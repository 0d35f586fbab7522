//===- StateOrder.cpp - what a state evaluates when ------------------------===//
//
// The value of an operation waits until it is used, and is then part of the expression that uses it, unless something in
// between would change it: then it gets a variable before.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/StateWriter.h"

#include "codegen/passes/continuation/Names.h"

#include "mlir/Dialect/Vector/IR/VectorOps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace rtsl::cpp {

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

std::string StateWriter::keyOf(mlir::Value address) {
  mlir::Operation *op = address.getDefiningOp();
  while (llvm::isa_and_nonnull<ir::FieldOp, ir::ElementOp>(op))
    op = op->getOperand(0).getDefiningOp();
  if (auto object = llvm::dyn_cast_or_null<ir::FrameObjectOp>(op))
    return "object " + object.getName().str();
  if (llvm::isa_and_nonnull<ir::PayloadOp>(op))
    return "payload";
  if (auto argument = llvm::dyn_cast_or_null<ir::CallArgumentOp>(op))
    return "argument " + std::to_string(argument.getOffset());
  if (auto state = llvm::dyn_cast_or_null<ir::StateOp>(op))
    return "state " + state.getName().str();
  if (llvm::isa_and_nonnull<ir::VarOp>(op))
    return fmt::format("var {}", static_cast<const void *>(op));
  return {};
}

void StateWriter::note(mlir::Value address, Touches &touches, bool isWritten) {
  (isWritten ? touches.writes : touches.reads).insert(keyOf(address));
}

bool changes(ir::EvaluateOp op, std::size_t operand) {
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
        touches.writesAny |= !call.getWrites();
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
  statement.hasSpace = !out.empty() && spaces.erase(currentLine) != 0;
  if (currentLine != 0)
    statement.comment += module.lineDirective(machine.method->range, currentLine);
  statement.text = std::move(text);
  statement.mentions = std::move(mentioned);
  mentioned.clear();
  out.push_back(std::move(statement));
}

/// Can the variable of a value become that of `value`, which the author calls the same? It can if nobody reads it any more.
bool StateWriter::isReplacedBy(mlir::Value before, mlir::Value value) {
  const auto variable = before ? declared.find(before) : declared.end();
  mlir::Operation *op = value.getDefiningOp();
  if (variable == declared.end() || before.getParentBlock() != op->getBlock() || nameOfValue(before) != nameOfValue(value) ||
      typeOf(before) != typeOf(value))
    return false;
  const std::string &name = variable->second;
  return llvm::all_of(before.getUsers(),
                      [&](mlir::Operation *user) { return user->getBlock() == op->getBlock() && !op->isBeforeInBlock(user); }) &&
         llvm::none_of(pending, [&](const auto &waiting) { return mentions(waiting.second.code.text, name); }) &&
         llvm::none_of(elementIndices, [&](const auto &index) { return mentions(index.second, name); });
}

/// Gives a value that waits for its use a variable now. `isNew`: it was just made, so no text that still reads the variable
/// before it is under way to a statement.
void StateWriter::materialise(mlir::Value value, Statements &out, bool isNew) {
  Pending waiting = std::move(pending[value]);
  pending.erase(value);
  const std::set<mlir::Operation *> before = std::move(mentioned);
  mentioned.clear();
  const std::string type = typeOf(value);
  if (type.empty())
    unsupported(*value.getDefiningOp());
  const std::string wanted = nameOfValue(value);
  const auto found = insertions.find(value);
  const Insertion *whole = found != insertions.end() ? &found->second : nullptr;
  const mlir::Value last = whole ? whole->before : latest[wanted];
  bool isAgain = isNew && (whole || !continuation::authorsName(value).empty()) && !isOwnName(wanted) && isReplacedBy(last, value);
  const std::string name = isAgain ? declared[last] : "";
  for (std::size_t i = 1; whole && i < whole->parts.size(); ++i) // the first has changed it then
    isAgain = isAgain && !mentions(whole->parts[i].value, name) && !mentions(whole->parts[i].index, name);
  const std::string &own = declared[value] = isAgain ? name : freshName(wanted);
  latest[wanted] = value;
  mentioned = waiting.mentions;
  if (!isAgain) {
    const std::string &begin = whole ? whole->vector : waiting.code.text;
    emit(out, fmt::format("{} {};", type, declarator(type, own, begin)));
    out.back().isDeclaration = true;
    out.back().made = value;
    out.back().value = begin;
  } else if (!whole) {
    emit(out, assignment(own, waiting.code.text, value));
  }
  for (std::size_t i = 0; whole && i < whole->parts.size(); ++i) {
    mentioned = waiting.mentions;
    emit(out, Insertion::place(own, whole->parts[i]) + " = " + whole->parts[i].value + ";");
  }
  mentioned = before;
}

/// A value for a text that has it more than once.
std::string StateWriter::named(mlir::Value value, Statements &out) {
  if (auto waiting = pending.find(value); waiting != pending.end() && !waiting->second.isTrivial)
    materialise(value, out);
  return bind(use(value, typeOf(value)), Binding::Primary);
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
    auto isUsedInside = [&, value = value] {
      return llvm::any_of(value.getUsers(), [&](mlir::Operation *user) { return op.isAncestor(user); });
    };
    if (!waiting.isPure || meet(waiting.touches, inside) ||
        (isLoop && waiting.usesLeft == 1 && !isConstant && isUsedInside()))
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
    const bool isName = std::all_of(code.text.begin(), code.text.end(),
                                    [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
    if (!isPure) // a name: of what a call returned that stands before
      emit(out, (isName ? "static_cast<void>(" + code.text + ")" : code.text) + ";");
    return;
  }
  auto *user = *value.user_begin();
  auto stores = [&] {
    return llvm::isa<ir::FrameStoreOp>(user) ||
           (llvm::isa<ir::StoreOp>(user) && user->getBlock() == op.getBlock());
  };
  const std::string given = continuation::authorsName(value);
  const bool isLoose =
      isOwnName(given) || (value.getType().isInteger(1) && continuation::isNamedByCaller(value));
  const bool isNamed = llvm::isa<ir::ExpressionOp, ir::EvaluateOp, ir::RandOp>(op) &&
                       !given.empty() && !(uses == 1 && isLoose);
  const auto whole = insertions.find(value);
  const bool isLong = whole != insertions.end() && whole->second.parts.size() > 1 && !llvm::isa<mlir::vector::InsertOp>(user);
  const bool isRead = llvm::isa<ir::LoadOp, ir::FrameLoadOp, ir::CallArgumentOp, ir::CallReturnedOp>(op);
  auto expression = llvm::dyn_cast<ir::ExpressionOp>(op);
  const bool isTrivial = isRead || llvm::isa<ir::LightCountOp>(op) ||
                         (expression && expression.getNumOperands() == 0 && expression.getCost() <= 6);
  pending[value] = {std::move(code), std::move(touches), mentioned, uses, isPure, isTrivial};
  if (uses == 1 ? (isNamed && !stores()) || isLong : isNamed || !isTrivial)
    materialise(value, out, /*isNew=*/true);
}

std::string StateWriter::Insertion::text() const {
  std::string text = vector;
  for (const Part &part : parts)
    text = part.component.empty() ? fmt::format("rtsl::with({}, {}, {})", text, part.index, part.value)
                                  : fmt::format("rtsl::with<{}>({}, {})", std::string("xyzw").find(part.component), text, part.value);
  return text;
}

std::string StateWriter::Insertion::place(const std::string &vector, const Part &part) {
  return part.component.empty() ? fmt::format("rtsl::at({}, {})", vector, part.index) : vector + "." + part.component;
}

} // namespace rtsl::cpp
