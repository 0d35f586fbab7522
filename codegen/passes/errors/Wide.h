//===- Wide.h - concise double precision ----------------------------------===//
//
// The counterpart of Num (codegen/formulas/Emitter.h) in double precision: a value of f64, or a
// vector of them, with operators.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/formulas/Emitter.h"

#include "mlir/Dialect/Math/IR/Math.h"

namespace rtsl {

class Wide {
public:
  Wide(lowering::Emitter &emitter, mlir::Value value) : emitter(&emitter), value(value) {}

  operator mlir::Value() const { return value; }
  lowering::Emitter &at() const { return *emitter; }

  /// `constant` in every component.
  Wide like(double constant) const {
    mlir::Type type = value.getType();
    mlir::TypedAttr attribute = emitter->getF64FloatAttr(constant);
    if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
      attribute = mlir::DenseElementsAttr::get(vector, mlir::Attribute(attribute));
    return {*emitter, emitter->make<mlir::arith::ConstantOp>(attribute)};
  }
  template <typename Op, typename... Values>
  Wide apply(Values... others) const {
    return {*emitter, emitter->fold<Op>(value, mlir::Value(others)...)};
  }

private:
  lowering::Emitter *emitter;
  mlir::Value value;
};

inline Wide operator+(Wide a, Wide b) {
  return a.apply<mlir::arith::AddFOp>(b);
}
inline Wide operator-(Wide a, Wide b) {
  return a.apply<mlir::arith::SubFOp>(b);
}
inline Wide operator*(Wide a, Wide b) {
  return a.apply<mlir::arith::MulFOp>(b);
}
inline Wide operator/(Wide a, Wide b) {
  return a.apply<mlir::arith::DivFOp>(b);
}
inline Wide operator-(Wide a) {
  return a.apply<mlir::arith::NegFOp>();
}
inline Wide operator+(Wide a, double b) {
  return a + a.like(b);
}
inline Wide operator+(double a, Wide b) {
  return b.like(a) + b;
}
inline Wide operator-(double a, Wide b) {
  return b.like(a) - b;
}
inline Wide operator*(double a, Wide b) {
  return b.like(a) * b;
}
inline Wide operator*(Wide a, double b) {
  return a * a.like(b);
}
inline Wide operator/(double a, Wide b) {
  return b.like(a) / b;
}
inline Wide sqrt(Wide a) {
  return a.apply<mlir::math::SqrtOp>();
}
inline Wide abs(Wide a) {
  return a.apply<mlir::math::AbsFOp>();
}

/// A condition, or one for each component.
inline mlir::Value isBelow(Wide a, Wide b) {
  return a.at().fold<mlir::arith::CmpFOp>(mlir::arith::CmpFPredicate::OLT, mlir::Value(a),
                                          mlir::Value(b));
}
inline mlir::Value isAtMost(Wide a, Wide b) {
  return a.at().fold<mlir::arith::CmpFOp>(mlir::arith::CmpFPredicate::OLE, mlir::Value(a),
                                          mlir::Value(b));
}
inline Wide choose(mlir::Value condition, Wide a, Wide b) {
  return {a.at(), a.at().fold<mlir::arith::SelectOp>(condition, mlir::Value(a), mlir::Value(b))};
}
inline Wide greater(Wide a, Wide b) {
  return choose(isBelow(a, b), b, a);
}

/// f64, in the shape of a type.
inline mlir::Type wideType(mlir::Type shape) {
  return lowering::withScalar(shape, mlir::Float64Type::get(shape.getContext()));
}
inline Wide widened(lowering::Emitter &emitter, mlir::Value single) {
  return {emitter, emitter.fold<mlir::arith::ExtFOp>(wideType(single.getType()), single)};
}
inline mlir::Value narrowed(Wide wide) {
  lowering::Emitter &emitter = wide.at();
  mlir::Type type = lowering::withScalar(mlir::Value(wide).getType(), emitter.getF32Type());
  return emitter.fold<mlir::arith::TruncFOp>(type, mlir::Value(wide));
}

} // namespace rtsl
