//===- StateOrder.cpp - what a state evaluates when ------------------------===//
//
// The value of an operation is pending until it is used, and is then part of the expression that
// uses it, unless something in between would change it: then it gets a variable before.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/states/StateWriter.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/passes/continuation/common/Names.h"

#include "mlir/Dialect/Vector/IR/VectorOps.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

void StateWriter::Touches::add(const Touches &other) {
  reads.insert(other.reads.begin(), other.reads.end());
  writes.insert(other.writes.begin(), other.writes.end());
  readsAny |= other.readsAny;
  writesAny |= other.writesAny;
}

/// Could exchanging the two be noticed?
bool StateWriter::meet(const Touches &a, const Touches &b) {
  auto common = [](const std::set<Location> &x, const std::set<Location> &y) {
    return std::any_of(x.begin(), x.end(),
                       [&](const Location &location) { return y.count(location) != 0; });
  };
  // Unknown methods reach the ray's state and draw random numbers; variables and the frame are this
  // function's own.
  auto isOpen = [](const std::set<Location> &locations) {
    return std::any_of(locations.begin(), locations.end(), [](const Location &location) {
      return location.kind == Location::Kind::State || location.kind == Location::Kind::Random;
    });
  };
  auto writesMeet = [&](const Touches &x, const Touches &y) {
    return common(x.writes, y.reads) || common(x.writes, y.writes) ||
           (x.writesAny && (y.readsAny || y.writesAny || isOpen(y.reads) || isOpen(y.writes))) ||
           (x.readsAny && isOpen(y.writes));
  };
  return writesMeet(a, b) || writesMeet(b, a);
}

StateWriter::Location StateWriter::locationOf(mlir::Value address) {
  using Kind = Location::Kind;
  mlir::Operation *op = ir::baseOperation(address);
  if (auto object = llvm::dyn_cast_or_null<ir::FrameObjectOp>(op))
    return {Kind::Object, object.getName().str()};
  if (auto argument = llvm::dyn_cast_or_null<ir::CallArgumentOp>(op))
    return {Kind::Argument, std::to_string(argument.getOffset())};
  if (auto state = llvm::dyn_cast_or_null<ir::StateOp>(op))
    return {Kind::State, state.getName().str()};
  if (llvm::isa_and_nonnull<ir::VarOp>(op))
    return {Kind::Variable, fmt::format("{}", static_cast<const void *>(op))};
  return {Kind::Payload, {}};
}

void StateWriter::note(mlir::Value address, Touches &touches, bool isWritten) {
  (isWritten ? touches.writes : touches.reads).insert(locationOf(address));
}

bool changes(ir::EvaluateOp op, std::size_t operand) {
  auto changed = ir::attr::changes.of(op);
  return changed && llvm::is_contained(changed.asArrayRef(), static_cast<std::int32_t>(operand));
}

StateWriter::Touches StateWriter::touchesOf(mlir::Operation *op) {
  Touches touches;
  op->walk([&](mlir::Operation *inner) {
    if (auto load = llvm::dyn_cast<ir::LoadOp>(inner))
      touches.reads.insert(locationOf(load.getAddress()));
    else if (auto store = llvm::dyn_cast<ir::StoreOp>(inner))
      touches.writes.insert(locationOf(store.getAddress()));
    else if (auto frameLoad = llvm::dyn_cast<ir::FrameLoadOp>(inner))
      touches.reads.insert({Location::Kind::Frame, frameLoad.getName().str()});
    else if (auto frameStore = llvm::dyn_cast<ir::FrameStoreOp>(inner))
      touches.writes.insert({Location::Kind::Frame, frameStore.getName().str()});
    else if (llvm::isa<ir::RandOp>(inner))
      touches.writes.insert({Location::Kind::Random, {}});
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
      if (!ir::attr::plain.isOn(call)) {
        touches.readsAny = true;
        touches.writes.insert({Location::Kind::Random, {}});
        touches.writesAny |= !call.getWrites();
      }
      if (call.getWrites())
        for (auto name : call.getWrites()->getAsRange<mlir::StringAttr>())
          touches.writes.insert({Location::Kind::State, name.getValue().str()});
    } else if (llvm::isa<ir::IlluminateOp>(inner)) {
      touches.readsAny = touches.writesAny = true;
    }
  });
  return touches;
}

Statement &StateWriter::emit(Statements &out, Statement statement) {
  if (auto comment = comments.find(currentLine); comment != comments.end()) {
    statement.comment = comment->second;
    comments.erase(comment);
  }
  statement.hasSpace = !out.empty() && spaces.erase(currentLine) != 0;
  if (currentLine != 0)
    statement.place = context.lineDirective(machine.method->range, currentLine);
  return out.emplace_back(std::move(statement));
}

/// Can the variable of a value become that of `value`, which the author calls the same? It can if
/// nothing reads it any more.
bool StateWriter::isReplacedBy(mlir::Value before, mlir::Value value) {
  const auto variable = before ? declared.find(before) : declared.end();
  mlir::Operation *op = value.getDefiningOp();
  if (variable == declared.end() || before.getParentBlock() != op->getBlock() ||
      nameOfValue(before) != nameOfValue(value) || typeOf(before) != typeOf(value))
    return false;
  const std::string &own = variable->second;
  return llvm::all_of(before.getUsers(),
                      [&](mlir::Operation *user) {
                        return user->getBlock() == op->getBlock() && !op->isBeforeInBlock(user);
                      }) &&
         llvm::none_of(pending,
                       [&](const auto &waiting) { return mentions(waiting.second.code, own); }) &&
         llvm::none_of(elementIndices,
                       [&](const auto &index) { return mentions(index.second, own); });
}

/// Gives a pending value a variable now. `isNew`: it was just made, so no pending expression
/// still reads the variable before it.
void StateWriter::materialise(mlir::Value value, Statements &out, bool isNew) {
  const Pending waiting = std::move(pending[value]);
  pending.erase(value);
  const Type *type = typeOf(value);
  if (!type)
    unsupported(*value.getDefiningOp());
  const std::string wanted = nameOfValue(value);
  const auto found = insertions.find(value);
  const Insertion *whole = found != insertions.end() ? &found->second : nullptr;
  const mlir::Value last = whole ? whole->before : latest[wanted];
  bool isAgain = isNew && (whole || !continuation::authorsName(value).empty()) &&
                 !isOwnName(wanted) && isReplacedBy(last, value);
  const std::string before = isAgain ? declared[last] : "";
  for (std::size_t i = 1; whole && i < whole->parts.size(); ++i) // the first has changed it then
    isAgain = isAgain && !mentions(whole->parts[i].value, before) &&
              !mentions(whole->parts[i].index, before);
  const std::string own = isAgain ? before : freshName(wanted);
  declared[value] = own;
  latest[wanted] = value;
  if (!isAgain) {
    const std::string typeName = type ? context.types.of(type) : std::string();
    Statement &made = emit(out, declaration(typeName, own, whole ? whole->vector : waiting.code));
    made.written.identity = value.getAsOpaquePointer();
    made.written.isTemporary = isOwnName(own);
  } else if (!whole) {
    emit(out, assignment(name(own), waiting.code, value));
  }
  for (std::size_t i = 0; whole && i < whole->parts.size(); ++i)
    emit(out, assign(Insertion::place(name(own), whole->parts[i]), whole->parts[i].value));
}

/// A value for an expression that has it more than once.
Code StateWriter::named(mlir::Value value, Statements &out) {
  if (auto waiting = pending.find(value); waiting != pending.end() && !waiting->second.isTrivial)
    materialise(value, out);
  return use(value, typeOf(value));
}

/// Evaluates pending values that would notice something that touches this, before it happens.
void StateWriter::flush(const Touches &touches, Statements &out) {
  llvm::SmallVector<mlir::Value> first;
  for (auto &[value, waiting] : pending)
    if (meet(waiting.touches, touches))
      first.push_back(value);
  for (mlir::Value value : first)
    materialise(value, out);
}

/// Before a construct with regions: values that an inner statement would change are not pending in
/// another region, and a value that is used once is not evaluated in each iteration of a loop.
void StateWriter::flushBefore(mlir::Operation &op, Statements &out) {
  const Touches inside = touchesOf(&op);
  const bool isLoop = llvm::isa<ir::LoopOp>(op);
  llvm::SmallVector<mlir::Value> first;
  for (auto &[value, waiting] : pending) {
    const bool isConstant = waiting.isTrivial && waiting.touches.reads.empty();
    auto isUsedInside = [&, value = value] {
      return llvm::any_of(value.getUsers(),
                          [&](mlir::Operation *user) { return op.isAncestor(user); });
    };
    if (!waiting.isPure || meet(waiting.touches, inside) ||
        (isLoop && waiting.usesLeft == 1 && !isConstant && isUsedInside()))
      first.push_back(value);
  }
  for (mlir::Value value : first)
    materialise(value, out);
}

/// The value of an operation becomes pending, or gets a variable.
void StateWriter::define(mlir::Operation &op, Code code, Touches touches, bool isPure,
                         Statements &out) {
  mlir::Value value = op.getResult(0);
  const auto uses = static_cast<unsigned>(std::distance(value.use_begin(), value.use_end()));
  if (uses == 0) {
    if (!isPure && code) // a name: of what a call returned that stands before
      emit(out, isName(code) ? discarded(code) : code);
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
  const bool isLong = whole != insertions.end() && whole->second.parts.size() > 1 &&
                      !llvm::isa<mlir::vector::InsertOp>(user);
  const bool isRead =
      llvm::isa<ir::LoadOp, ir::FrameLoadOp, ir::CallArgumentOp, ir::CallReturnedOp>(op);
  auto expression = llvm::dyn_cast<ir::ExpressionOp>(op);
  const bool isTrivial =
      isRead || llvm::isa<ir::LightCountOp>(op) ||
      (expression && expression.getNumOperands() == 0 && expression.getCost() <= 6);
  pending[value] = {std::move(code), std::move(touches), uses, isPure, isTrivial};
  if (uses == 1 ? (isNamed && !stores()) || isLong : isNamed || !isTrivial)
    materialise(value, out, /*isNew=*/true);
}

Code StateWriter::Insertion::code() const {
  Code code = vector;
  for (const Part &part : parts)
    code = part.component
               ? cpp::call(withParameters("rtsl::with", {std::to_string(*part.component)}),
                           {code, part.value})
               : cpp::call("rtsl::with", {code, part.index, part.value});
  return code;
}

Code StateWriter::Insertion::place(const Code &vector, const Part &part) {
  return part.component ? component(vector, *part.component)
                        : cpp::call("rtsl::at", {vector, part.index});
}

} // namespace rtsl::cpp
