#include "codegen/cpp/states/values/ValueOperations.h"

#include "codegen/cpp/cleanup/ConditionalAssignments.h"
#include "codegen/cpp/states/statements/StatePrinter.h"

#include "mlir/IR/Matchers.h"
#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::cpp {

namespace arith = mlir::arith;
namespace vector = mlir::vector;

bool ValueOperations::print(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case<vector::ExtractOp, vector::InsertOp, vector::FromElementsOp, vector::BroadcastOp,
            vector::ShuffleOp>([&](auto one) { write(one, out); })
      .Case<arith::XOrIOp, arith::AndIOp, arith::OrIOp, arith::AddIOp, arith::CmpIOp,
            arith::SelectOp>([&](auto one) { write(one, out); })
      .Case([&](ir::CastRefOp cast) {
        state.values.make(op, state.values.use(cast.getObject()), out);
      })
      .Case([&](arith::IndexCastUIOp index) {
        state.values.make(op, state.values.use(index.getIn()), out);
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

//===----------------------------------------------------------------------===//
// Vectors
//===----------------------------------------------------------------------===//

/// Is it one component of a vector that is written with a name, or with an index?
template <typename Op>
static bool isOfOneComponent(Op op) {
  const auto position = op.getStaticPosition();
  return position.size() == 1 && (op.hasDynamicPosition() || position.front() <= 3);
}

void ValueOperations::write(vector::ExtractOp op, Statements &out) {
  if (!isOfOneComponent(op))
    return state.unsupported(*op);
  const Code from = state.values.use(op.getSource());
  if (op.hasDynamicPosition())
    state.values.make(
        *op, cpp::call("rtsl::at", {from, state.values.use(op.getDynamicPosition().front())}), out);
  else
    state.values.make(
        *op, component(from, static_cast<std::size_t>(op.getStaticPosition().front())), out);
}

void ValueOperations::write(vector::InsertOp op, Statements &out) {
  if (!isOfOneComponent(op))
    return state.unsupported(*op);
  Insertion whole;
  if (const Insertion *before = state.values.insertion(op.getDest());
      before && state.values.isPending(op.getDest()))
    whole = *before;
  const Code into = state.values.use(op.getDest(), state.types.of(op.getResult()));
  if (whole.parts.empty()) {
    whole.before = op.getDest();
    whole.vector = into;
  }
  Insertion::Part &last = whole.parts.emplace_back();
  last.value = state.values.use(op.getValueToStore());
  if (op.hasDynamicPosition())
    last.index = state.values.use(op.getDynamicPosition().front());
  else
    last.component = static_cast<std::size_t>(op.getStaticPosition().front());
  state.values.makeInsertion(*op, std::move(whole), out);
}

void ValueOperations::write(vector::FromElementsOp op, Statements &out) {
  const Type *type = state.types.of(op.getResult());
  if (!type)
    return state.unsupported(*op);
  std::vector<Code> parts;
  for (mlir::Value part : op.getElements())
    parts.push_back(state.values.use(part));
  state.values.make(*op, construct(context.types.of(type), std::move(parts)), out);
}

void ValueOperations::write(vector::BroadcastOp op, Statements &out) {
  const Type *type = state.types.of(op.getResult());
  if (!type || !op.getSourceType().isIntOrFloat())
    return state.unsupported(*op);
  state.values.make(*op, construct(context.types.of(type), {state.values.use(op.getSource())}),
                    out);
}

void ValueOperations::write(vector::ShuffleOp op, Statements &out) {
  const Type *type = state.types.of(op.getResult());
  if (!type)
    return state.unsupported(*op);
  const Code first = state.values.named(op.getV1(), out);
  const Code second = op.getV1() == op.getV2() ? first : state.values.named(op.getV2(), out);
  const std::int64_t width = op.getV1VectorType().getNumElements();
  std::vector<Code> parts;
  for (std::int64_t at : op.getMask())
    parts.push_back(component(at < width ? first : second,
                              static_cast<std::size_t>(at < width ? at : at - width)));
  state.values.make(*op, construct(context.types.of(type), std::move(parts)), out);
}

//===----------------------------------------------------------------------===//
// Conditions and choices
//===----------------------------------------------------------------------===//

void ValueOperations::infix(mlir::Operation &op, Operator sign, Statements &out) {
  const Code left = state.values.use(op.getOperand(0));
  state.values.make(op, binary(sign, left, state.values.use(op.getOperand(1))), out);
}

static bool isBool(mlir::Operation *op) {
  return op->getResult(0).getType().isInteger(1);
}

void ValueOperations::write(arith::XOrIOp op, Statements &out) {
  if (!isBool(op) || !mlir::matchPattern(op.getRhs(), mlir::m_One()))
    return state.unsupported(*op);
  state.values.make(*op, state.expressions.opposite(op.getLhs(), state.values.use(op.getLhs())),
                    out);
}

void ValueOperations::write(arith::AndIOp op, Statements &out) {
  isBool(op) ? infix(*op, Operator::And, out) : state.unsupported(*op);
}

void ValueOperations::write(arith::OrIOp op, Statements &out) {
  isBool(op) ? infix(*op, Operator::Or, out) : state.unsupported(*op);
}

void ValueOperations::write(arith::AddIOp op, Statements &out) { // of a light's number
  infix(*op, Operator::Add, out);
}

void ValueOperations::write(arith::CmpIOp op, Statements &out) {
  op.getPredicate() == arith::CmpIPredicate::ult ? infix(*op, Operator::Less, out)
                                                 : state.unsupported(*op);
}

void ValueOperations::write(arith::SelectOp op, Statements &out) {
  const Type *type = state.types.of(op.getResult());
  const Code condition = state.values.use(op.getCondition());
  const Code first = state.values.use(op.getTrueValue(), type);
  const bool isBools = type && type->isVector() && type->element->is(TypeKind::Bool);
  state.values.make(*op,
                    choose(condition, first, state.values.use(op.getFalseValue(), type),
                           isBools ? context.types.of(type) : std::string(), isBools),
                    out);
}

} // namespace rtsl::cpp
