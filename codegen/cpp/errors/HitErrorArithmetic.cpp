#include "codegen/cpp/errors/HitErrorWriter.h"

#include "mlir/Dialect/Math/IR/Math.h"
#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::cpp {

namespace arith = mlir::arith;
namespace math = mlir::math;
namespace vector = mlir::vector;
using mlir::Value;

void HitErrorWriter::infix(mlir::Operation &op, Operator sign, Statements &out) {
  const Code left = whole(op.getOperand(0));
  define(op.getResult(0), binary(sign, left, whole(op.getOperand(1))), out);
}

/// An operator of ints that may overflow, which C++ defines for unsigned numbers only.
void HitErrorWriter::wrapping(mlir::Operation &op, Operator sign, Statements &out) {
  defineEach(op, out, [&](unsigned i) {
    const Code left = staticCast("unsigned", part(op.getOperand(0), i));
    return staticCast("int", binary(sign, left, staticCast("unsigned", part(op.getOperand(1), i))));
  });
}

void HitErrorWriter::logical(mlir::Operation &op, Operator ofBools, Operator ofBits,
                             Statements &out) {
  const bool isBool = scalarOf(op.getResult(0).getType()).isInteger(1);
  defineEach(op, out, [&](unsigned i) {
    const Code left = part(op.getOperand(0), i);
    return binary(isBool ? ofBools : ofBits, left, part(op.getOperand(1), i));
  });
}

void HitErrorWriter::call(mlir::Operation &op, const std::string &function, Statements &out) {
  defineEach(op, out, [&](unsigned i) {
    std::vector<Code> arguments;
    for (Value operand : op.getOperands())
      arguments.push_back(part(operand, i));
    return cpp::call(function, std::move(arguments));
  });
}

void HitErrorWriter::castTo(mlir::Operation &op, const std::string &type, Statements &out) {
  defineEach(op, out, [&](unsigned i) { return staticCast(type, part(op.getOperand(0), i)); });
}

//===----------------------------------------------------------------------===//
// Comparisons
//===----------------------------------------------------------------------===//

/// `a < b || a > b`: false if the values are equal or one is a NaN.
static Code differ(const Code &a, const Code &b) {
  return parentheses(
      binary(Operator::Or, binary(Operator::Less, a, b), binary(Operator::Greater, a, b)));
}

/// Comparisons of floats. Unordered ones hold for a NaN: they are the opposite of ordered ones.
static Code compare(arith::CmpFPredicate predicate, const Code &a, const Code &b) {
  using P = arith::CmpFPredicate;
  auto ordered = [&](Operator op) { return binary(op, a, b); };
  auto unordered = [&](Operator opposite) {
    return unary(UnaryOperator::Not, binary(opposite, a, b));
  };
  auto both = [&](Operator op, Operator ofEach) {
    return parentheses(binary(op, binary(ofEach, a, a), binary(ofEach, b, b)));
  };
  switch (predicate) {
  case P::OEQ:
    return ordered(Operator::Equal);
  case P::OGT:
    return ordered(Operator::Greater);
  case P::OGE:
    return ordered(Operator::GreaterEqual);
  case P::OLT:
    return ordered(Operator::Less);
  case P::OLE:
    return ordered(Operator::LessEqual);
  case P::UNE:
    return ordered(Operator::NotEqual);
  case P::ONE:
    return differ(a, b);
  case P::UEQ:
    return unary(UnaryOperator::Not, differ(a, b));
  case P::UGT:
    return unordered(Operator::LessEqual);
  case P::UGE:
    return unordered(Operator::Less);
  case P::ULT:
    return unordered(Operator::GreaterEqual);
  case P::ULE:
    return unordered(Operator::Greater);
  case P::ORD:
    return both(Operator::And, Operator::Equal);
  case P::UNO:
    return both(Operator::Or, Operator::NotEqual);
  case P::AlwaysFalse:
    return boolean(false);
  case P::AlwaysTrue:
    return boolean(true);
  }
  return boolean(false);
}

static Operator operatorOf(arith::CmpIPredicate predicate) {
  using P = arith::CmpIPredicate;
  switch (predicate) {
  case P::eq:
    return Operator::Equal;
  case P::ne:
    return Operator::NotEqual;
  case P::slt:
  case P::ult:
    return Operator::Less;
  case P::sle:
  case P::ule:
    return Operator::LessEqual;
  case P::sgt:
  case P::ugt:
    return Operator::Greater;
  case P::sge:
  case P::uge:
    return Operator::GreaterEqual;
  }
  return Operator::Equal;
}

/// Comparisons of ints; the unsigned predicates come last.
static Code compare(arith::CmpIPredicate predicate, const Code &a, const Code &b) {
  const bool isUnsigned = predicate >= arith::CmpIPredicate::ult;
  return isUnsigned
             ? binary(operatorOf(predicate), staticCast("unsigned", a), staticCast("unsigned", b))
             : binary(operatorOf(predicate), a, b);
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

bool HitErrorWriter::writeOperator(mlir::Operation &op, Statements &out) {
  auto comparison = [&](auto compared) {
    defineEach(op, out, [&](unsigned i) {
      const Code left = part(compared.getLhs(), i);
      return compare(compared.getPredicate(), left, part(compared.getRhs(), i));
    });
  };
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](arith::AddFOp) { infix(op, Operator::Add, out); })
      .Case([&](arith::SubFOp) { infix(op, Operator::Subtract, out); })
      .Case([&](arith::MulFOp) { infix(op, Operator::Multiply, out); })
      .Case([&](arith::DivFOp) { infix(op, Operator::Divide, out); })
      .Case([&](arith::NegFOp) {
        defineEach(op, out, [&](unsigned i) {
          return unary(UnaryOperator::Minus, parentheses(part(op.getOperand(0), i)));
        });
      })
      .Case([&](arith::AddIOp) { wrapping(op, Operator::Add, out); })
      .Case([&](arith::SubIOp) { wrapping(op, Operator::Subtract, out); })
      .Case([&](arith::MulIOp) { wrapping(op, Operator::Multiply, out); })
      .Case([&](arith::AndIOp) { logical(op, Operator::And, Operator::BitAnd, out); })
      .Case([&](arith::OrIOp) { logical(op, Operator::Or, Operator::BitOr, out); })
      .Case([&](arith::XOrIOp) { logical(op, Operator::NotEqual, Operator::BitXor, out); })
      .Case<arith::CmpFOp, arith::CmpIOp>([&](auto compared) { comparison(compared); })
      .Case([&](arith::SelectOp choice) {
        defineEach(op, out, [&](unsigned i) {
          const Code condition = part(choice.getCondition(), i);
          const Code first = part(choice.getTrueValue(), i);
          return conditional(condition, first, part(choice.getFalseValue(), i));
        });
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

bool HitErrorWriter::writeConversion(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](arith::SIToFPOp) { castTo(op, isDouble(op) ? "double" : "float", out); })
      .Case([&](arith::UIToFPOp) {
        defineEach(op, out, [&](unsigned i) {
          return staticCast(isDouble(op) ? "double" : "float",
                            staticCast("unsigned", part(op.getOperand(0), i)));
        });
      })
      .Case([&](arith::BitcastOp cast) {
        const bool isFloat = scalarOf(cast.getType()).isF32();
        call(op, isFloat ? "rtsl::bitsAs<float>" : "rtsl::bitsAs<int>", out);
      })
      .Case([&](arith::IndexCastUIOp) { castTo(op, "unsigned", out); })
      .Case([&](arith::ExtUIOp) { castTo(op, "int", out); })
      .Case([&](arith::ExtFOp) { castTo(op, "double", out); })
      .Case([&](arith::TruncFOp) { castTo(op, "float", out); })
      .Case([&](ir::ToSintOp) { call(op, "rtsl::toInt", out); })
      .Case([&](ir::ToUintOp) {
        defineEach(op, out, [&](unsigned i) {
          return staticCast("int", cpp::call("rtsl::toUint", {part(op.getOperand(0), i)}));
        });
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

bool HitErrorWriter::writeFunction(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](math::SqrtOp) { call(op, isDouble(op) ? "std::sqrt" : "rtsl::squareRoot", out); })
      .Case([&](math::FmaOp) { call(op, isDouble(op) ? "std::fma" : "rtsl::fma", out); })
      .Case([&](math::AbsFOp) { call(op, isDouble(op) ? "std::abs" : "rtsl::abs", out); })
      .Case([&](math::FloorOp) { call(op, "rtsl::floor", out); })
      .Case([&](math::CeilOp) { call(op, "rtsl::ceil", out); })
      .Case([&](math::TruncOp) { call(op, "rtsl::trunc", out); })
      .Case([&](math::RoundEvenOp) { call(op, "rtsl::roundEven", out); })
      .Case([&](ir::ElementaryOp function) {
        const bool isAtan2 = function.getFunction() == ir::Elementary::Atan2;
        call(op,
             "rtsl::" + (isAtan2 ? "atan" : ir::stringifyElementary(function.getFunction()).str()),
             out);
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

bool HitErrorWriter::writeVector(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](vector::ExtractOp chosen) {
        if (!chosen.hasDynamicPosition())
          return define(
              chosen,
              part(chosen.getSource(), static_cast<unsigned>(chosen.getStaticPosition()[0])), out);
        const Code from = whole(chosen.getSource());
        define(chosen, subscript(from, staticCast("int", whole(chosen.getDynamicPosition()[0]))),
               out);
      })
      .Case([&](vector::InsertOp insert) {
        const auto at = static_cast<unsigned>(insert.getStaticPosition()[0]);
        defineEach(op, out, [&](unsigned i) {
          return i == at ? whole(insert.getValueToStore()) : part(insert.getDest(), i);
        });
      })
      .Case([&](vector::FromElementsOp made) {
        defineEach(op, out, [&](unsigned i) { return whole(made.getElements()[i]); });
      })
      .Case([&](vector::BroadcastOp same) {
        defineEach(op, out, [&](unsigned) { return whole(same.getSource()); });
      })
      .Case([&](vector::ShuffleOp chosen) {
        const auto width = static_cast<unsigned>(chosen.getV1VectorType().getNumElements());
        defineEach(op, out, [&](unsigned i) {
          const auto from = static_cast<unsigned>(chosen.getMask()[i]);
          return from < width ? part(chosen.getV1(), from) : part(chosen.getV2(), from - width);
        });
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

} // namespace rtsl::cpp
