//===- RtslFolds.cpp - folding of operations on constants -----------------===//
//
// Elementary functions are computed by math, the code that shaders run too: the value does not
// depend on whether it was folded, or on which host.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/dialect/RtslOps.h"
#include "math/Elementary.h"
#include "math/Refraction.h"

#include "mlir/Dialect/CommonFolders.h"
#include "mlir/IR/Matchers.h"
#include "llvm/ADT/APSInt.h"

namespace rtsl::ir {

using llvm::APFloat;
using llvm::APInt;
using mlir::FloatAttr;
using mlir::IntegerAttr;
using mlir::OpFoldResult;

//===----------------------------------------------------------------------===//
// Elementary functions
//===----------------------------------------------------------------------===//

float evaluate(Elementary function, llvm::ArrayRef<float> x) {
  switch (function) {
#define RTSL_ELEMENTARY_UNARY(Id, name)                                                            \
  case Elementary::Id:                                                                             \
    return device::name(x[0]);
#define RTSL_ELEMENTARY_BINARY(Id, name)                                                           \
  case Elementary::Id:                                                                             \
    return device::name(x[0], x[1]);
#include "math/ElementaryFunctions.def"
  }
  llvm_unreachable("not an elementary function");
}

OpFoldResult ElementaryOp::fold(FoldAdaptor adaptor) {
  Elementary function = getFunction();
  if (getOperands().size() == 1)
    return mlir::constFoldUnaryOp<FloatAttr, APFloat, void>(
        adaptor.getOperands(),
        [&](const APFloat &x) { return APFloat(evaluate(function, {x.convertToFloat()})); });
  return mlir::constFoldBinaryOp<FloatAttr, APFloat, void>(
      adaptor.getOperands(), [&](const APFloat &x, const APFloat &y) {
        return APFloat(evaluate(function, {x.convertToFloat(), y.convertToFloat()}));
      });
}

/// The components of a float constant and their number; 0 if it is not one.
static unsigned floatsOf(mlir::Attribute constant, float (&numbers)[4]) {
  if (auto scalar = llvm::dyn_cast_or_null<FloatAttr>(constant)) {
    numbers[0] = scalar.getValue().convertToFloat();
    return 1;
  }
  auto vector = llvm::dyn_cast_or_null<mlir::DenseFPElementsAttr>(constant);
  if (!vector || vector.getNumElements() > 4)
    return 0;
  unsigned count = 0;
  for (const APFloat &number : vector.getValues<APFloat>())
    numbers[count++] = number.convertToFloat();
  return count;
}

OpFoldResult RefractOp::fold(FoldAdaptor adaptor) {
  float incident[4], normal[4], eta[4], refracted[4];
  const unsigned count = floatsOf(adaptor.getIncident(), incident);
  if (count == 0 || floatsOf(adaptor.getNormal(), normal) != count ||
      floatsOf(adaptor.getEta(), eta) != 1)
    return {};
  switch (count) {
  case 1:
    device::refract<1>(incident, normal, eta[0], refracted);
    return FloatAttr::get(getType(), APFloat(refracted[0]));
  case 2:
    device::refract<2>(incident, normal, eta[0], refracted);
    break;
  case 3:
    device::refract<3>(incident, normal, eta[0], refracted);
    break;
  default:
    device::refract<4>(incident, normal, eta[0], refracted);
  }
  return mlir::DenseElementsAttr::get(llvm::cast<mlir::ShapedType>(getType()),
                                      llvm::ArrayRef<float>(refracted, count));
}

//===----------------------------------------------------------------------===//
// Integers
//===----------------------------------------------------------------------===//

static mlir::Attribute foldToInt(mlir::Attribute input, mlir::Type type, bool isSigned) {
  return mlir::constFoldCastOp<FloatAttr, IntegerAttr, APFloat, APInt, void>(
      input, type, [&](const APFloat &value, bool &) {
        // Saturates, and gives 0 for NaN, exactly like the op.
        llvm::APSInt result(32, !isSigned);
        bool isExact;
        value.convertToInteger(result, APFloat::rmTowardZero, &isExact);
        return APInt(result);
      });
}

OpFoldResult ToSintOp::fold(FoldAdaptor adaptor) {
  return foldToInt(adaptor.getInput(), getType(), /*isSigned=*/true);
}
OpFoldResult ToUintOp::fold(FoldAdaptor adaptor) {
  return foldToInt(adaptor.getInput(), getType(), /*isSigned=*/false);
}

/// Folds constants with `compute`, whose divisor is never zero.
template <typename Compute>
static mlir::Attribute foldDivision(llvm::ArrayRef<mlir::Attribute> operands, Compute compute) {
  return mlir::constFoldBinaryOp<IntegerAttr, APInt, void>(
      operands, [&](const APInt &a, const APInt &b) {
        return b.isZero() ? APInt::getZero(32) : compute(a, b);
      });
}

// Dividing the smallest number by -1, APInt::sdiv gives the smallest number again, and srem gives
// 0.
OpFoldResult SDivOp::fold(FoldAdaptor adaptor) {
  if (mlir::matchPattern(adaptor.getRhs(), mlir::m_One()))
    return getLhs();
  return foldDivision(adaptor.getOperands(),
                      [](const APInt &a, const APInt &b) { return a.sdiv(b); });
}
OpFoldResult UDivOp::fold(FoldAdaptor adaptor) {
  if (mlir::matchPattern(adaptor.getRhs(), mlir::m_One()))
    return getLhs();
  return foldDivision(adaptor.getOperands(),
                      [](const APInt &a, const APInt &b) { return a.udiv(b); });
}
OpFoldResult SRemOp::fold(FoldAdaptor adaptor) {
  return foldDivision(adaptor.getOperands(),
                      [](const APInt &a, const APInt &b) { return a.srem(b); });
}
OpFoldResult URemOp::fold(FoldAdaptor adaptor) {
  return foldDivision(adaptor.getOperands(),
                      [](const APInt &a, const APInt &b) { return a.urem(b); });
}

//===----------------------------------------------------------------------===//
// References
//===----------------------------------------------------------------------===//

/// The reference that a chain of casts begins with.
static mlir::Value withoutCasts(mlir::Value object) {
  while (auto cast = object.getDefiningOp<CastRefOp>())
    object = cast.getObject();
  return object;
}

OpFoldResult CastRefOp::fold(FoldAdaptor) {
  mlir::Value origin = withoutCasts(getObject());
  if (origin.getType() == getType())
    return origin;
  if (origin == getObject())
    return {};
  getObjectMutable().assign(origin);
  return getResult();
}

OpFoldResult ClassIdOp::fold(FoldAdaptor) {
  if (withoutCasts(getObject()).getDefiningOp<NullRefOp>())
    return IntegerAttr::get(getType(), 0);
  return {};
}

OpFoldResult EqualRefOp::fold(FoldAdaptor) {
  mlir::Value lhs = withoutCasts(getLhs()), rhs = withoutCasts(getRhs());
  if (lhs == rhs || (lhs.getDefiningOp<NullRefOp>() && rhs.getDefiningOp<NullRefOp>()))
    return mlir::BoolAttr::get(getContext(), true);
  return {};
}

} // namespace rtsl::ir
