//===- StateValues.cpp - values that the passes have made -----------------===//
//
// Expressions are the author's where they stay whole (StateExpressions.cpp). What is left are
// components of vectors that are written one by one, and conditions and choices that control flow
// has become.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/cleanup/ConditionalAssignments.h"
#include "codegen/cpp/states/StateWriter.h"

#include "mlir/IR/Matchers.h"

namespace rtsl::cpp {

namespace arith = mlir::arith;
namespace vector = mlir::vector;

//===----------------------------------------------------------------------===//
// Vectors
//===----------------------------------------------------------------------===//

/// Is it one component of a vector that is written with a name, or with an index?
template <typename Op>
static bool isOfOneComponent(Op op) {
  const auto position = op.getStaticPosition();
  return position.size() == 1 && (op.hasDynamicPosition() || position.front() <= 3);
}

void StateWriter::write(vector::ExtractOp op, Statements &out) {
  if (!isOfOneComponent(op))
    return unsupported(*op);
  const Code from = use(op.getSource());
  if (op.hasDynamicPosition())
    make(*op, cpp::call("rtsl::at", {from, use(op.getDynamicPosition().front())}), out);
  else
    make(*op, component(from, static_cast<std::size_t>(op.getStaticPosition().front())), out);
}

void StateWriter::write(vector::InsertOp op, Statements &out) {
  if (!isOfOneComponent(op))
    return unsupported(*op);
  Insertion whole;
  if (auto before = insertions.find(op.getDest());
      before != insertions.end() && pending.count(op.getDest()))
    whole = before->second;
  const Code into = use(op.getDest(), typeOf(op.getResult()));
  if (whole.parts.empty()) {
    whole.before = op.getDest();
    whole.vector = into;
  }
  Insertion::Part &last = whole.parts.emplace_back();
  last.value = use(op.getValueToStore());
  if (op.hasDynamicPosition())
    last.index = use(op.getDynamicPosition().front());
  else
    last.component = static_cast<std::size_t>(op.getStaticPosition().front());
  insertions[op.getResult()] = whole;
  make(*op, whole.code(), out);
}

void StateWriter::write(vector::FromElementsOp op, Statements &out) {
  const Type *type = typeOf(op.getResult());
  if (!type)
    return unsupported(*op);
  std::vector<Code> parts;
  for (mlir::Value part : op.getElements())
    parts.push_back(use(part));
  make(*op, construct(context.types.of(type), std::move(parts)), out);
}

void StateWriter::write(vector::BroadcastOp op, Statements &out) {
  const Type *type = typeOf(op.getResult());
  if (!type || !op.getSourceType().isIntOrFloat())
    return unsupported(*op);
  make(*op, construct(context.types.of(type), {use(op.getSource())}), out);
}

void StateWriter::write(vector::ShuffleOp op, Statements &out) {
  const Type *type = typeOf(op.getResult());
  if (!type)
    return unsupported(*op);
  const Code first = named(op.getV1(), out);
  const Code second = op.getV1() == op.getV2() ? first : named(op.getV2(), out);
  const std::int64_t width = op.getV1VectorType().getNumElements();
  std::vector<Code> parts;
  for (std::int64_t at : op.getMask())
    parts.push_back(component(at < width ? first : second,
                              static_cast<std::size_t>(at < width ? at : at - width)));
  make(*op, construct(context.types.of(type), std::move(parts)), out);
}

//===----------------------------------------------------------------------===//
// Conditions and choices
//===----------------------------------------------------------------------===//

void StateWriter::infix(mlir::Operation &op, Operator sign, Statements &out) {
  const Code left = use(op.getOperand(0));
  make(op, binary(sign, left, use(op.getOperand(1))), out);
}

static bool isBool(mlir::Operation *op) {
  return op->getResult(0).getType().isInteger(1);
}

void StateWriter::write(arith::XOrIOp op, Statements &out) {
  if (!isBool(op) || !mlir::matchPattern(op.getRhs(), mlir::m_One()))
    return unsupported(*op);
  make(*op, opposite(op.getLhs(), use(op.getLhs())), out);
}

void StateWriter::write(arith::AndIOp op, Statements &out) {
  isBool(op) ? infix(*op, Operator::And, out) : unsupported(*op);
}

void StateWriter::write(arith::OrIOp op, Statements &out) {
  isBool(op) ? infix(*op, Operator::Or, out) : unsupported(*op);
}

void StateWriter::write(arith::AddIOp op, Statements &out) { // of a light's number
  infix(*op, Operator::Add, out);
}

void StateWriter::write(arith::CmpIOp op, Statements &out) {
  op.getPredicate() == arith::CmpIPredicate::ult ? infix(*op, Operator::Less, out)
                                                 : unsupported(*op);
}

void StateWriter::write(arith::SelectOp op, Statements &out) {
  const Type *type = typeOf(op.getResult());
  const Code condition = use(op.getCondition());
  const Code first = use(op.getTrueValue(), type);
  const bool isBools = type && type->isVector() && type->element->is(TypeKind::Bool);
  make(*op,
       choose(condition, first, use(op.getFalseValue(), type),
              isBools ? context.types.of(type) : std::string(), isBools),
       out);
}

} // namespace rtsl::cpp
