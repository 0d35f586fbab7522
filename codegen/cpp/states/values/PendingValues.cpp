#include "codegen/cpp/states/values/PendingValues.h"

#include "codegen/cpp/states/statements/StatePrinter.h"
#include "codegen/ir/NamedLocation.h"
#include "codegen/passes/continuation/common/Names.h"
#include "language/Costs.h"

#include "mlir/Dialect/Vector/IR/VectorOps.h"

namespace rtsl::cpp {

const Insertion *PendingValues::insertion(mlir::Value value) const {
  const auto found = insertions.find(value);
  return found != insertions.end() ? &found->second : nullptr;
}

Code PendingValues::use(mlir::Value value, const Type *type) {
  if (auto found = declared.find(value); found != declared.end())
    return name(found->second);
  auto found = pending.find(value);
  if (found == pending.end())
    return state.expressions.constant(value, type);
  Code code = found->second.code;
  consumed.add(found->second.accesses);
  if (--found->second.usesLeft == 0)
    pending.erase(value);
  return code;
}

/// Is it the result of `&&` or `||`? The compiler names these, not the author.
static bool isOfShortCircuit(mlir::Value value) {
  return ir::nameIn(value.getLoc()).isOfShortCircuit;
}

/// Can `value` be assigned to the variable of `before`, a value of the same name? It can if nothing
/// reads that variable any more.
bool PendingValues::isReplacedBy(mlir::Value before, mlir::Value value) {
  const auto variable = before ? declared.find(before) : declared.end();
  mlir::Operation *op = value.getDefiningOp();
  if (variable == declared.end() || before.getParentBlock() != op->getBlock() ||
      state.names.ofValue(before) != state.names.ofValue(value) ||
      state.types.of(before) != state.types.of(value))
    return false;
  const std::string &own = variable->second;
  return llvm::all_of(before.getUsers(),
                      [&](mlir::Operation *user) {
                        return user->getBlock() == op->getBlock() && !op->isBeforeInBlock(user);
                      }) &&
         llvm::none_of(pending,
                       [&](const auto &waiting) { return mentions(waiting.second.code, own); }) &&
         !state.lvalues.indicesMention(own);
}

/// Declares a variable for a pending value. `isNew`: the value was just made, so no pending
/// expression reads the previous value of its variable.
void PendingValues::materialise(mlir::Value value, Statements &out, bool isNew) {
  const Pending waiting = std::move(pending[value]);
  pending.erase(value);
  const Type *type = state.types.of(value);
  if (!type)
    state.unsupported(*value.getDefiningOp());
  const std::string wanted = state.names.ofValue(value);
  const Insertion *whole = insertion(value);
  const mlir::Value last = whole ? whole->before : latest[wanted];
  bool isAgain = isNew && (whole || !continuation::authorsName(value).empty()) &&
                 !isOfShortCircuit(value) && isReplacedBy(last, value);
  const std::string before = isAgain ? declared[last] : "";
  for (std::size_t i = 1; whole && i < whole->parts.size();
       ++i) // the first part has changed it by then
    isAgain = isAgain && !mentions(whole->parts[i].value, before) &&
              !mentions(whole->parts[i].index, before);
  const std::string own = isAgain ? before : state.names.fresh(wanted);
  declared[value] = own;
  latest[wanted] = value;
  if (!isAgain) {
    const std::string typeName = type ? context.types.of(type) : std::string();
    Statement &made =
        state.emitter.emit(out, declaration(typeName, own, whole ? whole->vector : waiting.code));
    made.written.identity = value.getAsOpaquePointer();
    made.written.isTemporary = isOfShortCircuit(value);
  } else if (!whole) {
    state.emitter.emit(out, state.memory.assignment(name(own), waiting.code, value));
  }
  for (std::size_t i = 0; whole && i < whole->parts.size(); ++i)
    state.emitter.emit(
        out, assign(Insertion::lvalue(name(own), whole->parts[i]), whole->parts[i].value));
}

Code PendingValues::named(mlir::Value value, Statements &out) {
  if (auto waiting = pending.find(value); waiting != pending.end() && !waiting->second.isTrivial)
    materialise(value, out);
  return use(value, state.types.of(value));
}

void PendingValues::flush(const ir::MemoryAccesses &accesses, Statements &out) {
  llvm::SmallVector<mlir::Value> first;
  for (auto &[value, waiting] : pending)
    if (conflict(waiting.accesses, accesses))
      first.push_back(value);
  for (mlir::Value value : first)
    materialise(value, out);
}

void PendingValues::flushBefore(mlir::Operation &op, Statements &out) {
  const ir::MemoryAccesses inside = ir::accessesOf(&op);
  const bool isLoop = llvm::isa<ir::LoopOp>(op);
  llvm::SmallVector<mlir::Value> first;
  for (auto &[value, waiting] : pending) {
    const bool isConstant = waiting.isTrivial && waiting.accesses.reads.empty();
    auto isUsedInside = [&, value = value] {
      return llvm::any_of(value.getUsers(),
                          [&](mlir::Operation *user) { return op.isAncestor(user); });
    };
    if (!waiting.isPure || conflict(waiting.accesses, inside) ||
        (isLoop && waiting.usesLeft == 1 && !isConstant && isUsedInside()))
      first.push_back(value);
  }
  for (mlir::Value value : first)
    materialise(value, out);
}

void PendingValues::define(mlir::Operation &op, Code code, ir::MemoryAccesses accesses, bool isPure,
                           Statements &out) {
  mlir::Value value = op.getResult(0);
  const auto uses = static_cast<unsigned>(std::distance(value.use_begin(), value.use_end()));
  if (uses == 0) {
    if (!isPure && code) // a name: the result of a call that was already emitted
      state.emitter.emit(out, isName(code) ? discarded(code) : code);
    return;
  }
  auto *user = *value.user_begin();
  auto stores = [&] {
    return llvm::isa<ir::FrameStoreOp>(user) ||
           (llvm::isa<ir::StoreOp>(user) && user->getBlock() == op.getBlock());
  };
  const std::string authors = continuation::authorsName(value);
  const bool isLoose = isOfShortCircuit(value) ||
                       (value.getType().isInteger(1) && continuation::isNamedByCaller(value));
  const bool isNamed = llvm::isa<ir::ExpressionOp, ir::EvaluateOp, ir::RandOp>(op) &&
                       !authors.empty() && !(uses == 1 && isLoose);
  const Insertion *whole = insertion(value);
  const bool isLong = whole && whole->parts.size() > 1 && !llvm::isa<mlir::vector::InsertOp>(user);
  const bool isRead =
      llvm::isa<ir::LoadOp, ir::FrameLoadOp, ir::CallArgumentOp, ir::CallReturnedOp>(op);
  auto expression = llvm::dyn_cast<ir::ExpressionOp>(op);
  const bool isTrivial = isRead || llvm::isa<ir::LightCountOp, ir::LightMayPassOp>(op) ||
                         (expression && expression.getNumOperands() == 0 &&
                          expression.getCost() <= cost::withoutVariable);
  pending[value] = {std::move(code), std::move(accesses), uses, isPure, isTrivial};
  if (uses == 1 ? (isNamed && !stores()) || isLong : isNamed || !isTrivial)
    materialise(value, out, /*isNew=*/true);
}

void PendingValues::make(mlir::Operation &op, Code code, Statements &out) {
  define(op, std::move(code), consumed, true, out);
}

void PendingValues::makeAnywhere(mlir::Operation &op, Code code, Statements &out) {
  define(op, std::move(code), {}, true, out);
}

void PendingValues::makeInsertion(mlir::Operation &op, Insertion insertion, Statements &out) {
  const Code code = insertion.code();
  insertions[op.getResult(0)] = std::move(insertion);
  make(op, code, out);
}

} // namespace rtsl::cpp
