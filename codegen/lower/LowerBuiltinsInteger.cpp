//===- LowerBuiltinsInteger.cpp - comparisons, bits and packing -----------===//
#include "codegen/lower/Lowering.h"

namespace rtsl::lowering {

using typed::Builtin;

static bool isUnsigned(const typed::Expr &expr) {
  return expr.type->scalar()->is(TypeKind::UInt);
}

std::optional<Parts> FunctionLowering::lowerIntegerBuiltin(const typed::BuiltinExpr &expr) {
  auto result = [](Num value) { return Parts{value}; };
  llvm::SmallVector<Num, 4> operands;
  auto evaluate = [&] {
    for (const typed::ExprPtr &arg : expr.args)
      operands.push_back(number(*arg));
    emitter.setLoc(module.location(expr.range));
  };
  auto compare = [&](ast::BinaryOp op) {
    evaluate();
    return result(arithmetic(op, operands[0], operands[1], !isUnsigned(*expr.args[0])));
  };
  // Two operands, then places for results.
  llvm::SmallVector<Place, 2> places;
  auto evaluateWithOutputs = [&] {
    for (std::size_t i = 0; i < expr.args.size(); ++i)
      if (i < 2)
        operands.push_back(number(*expr.args[i]));
      else
        places.push_back(place(*expr.args[i]));
    emitter.setLoc(module.location(expr.range));
  };
  auto asInt = [&](Num bools) {
    return num(emitter.fold<mlir::arith::ExtUIOp>(operands[0].type(), static_cast<Value>(bools)));
  };

  switch (expr.builtin) {
  case Builtin::LessThan:
    return compare(ast::BinaryOp::Less);
  case Builtin::LessThanEqual:
    return compare(ast::BinaryOp::LessEqual);
  case Builtin::GreaterThan:
    return compare(ast::BinaryOp::Greater);
  case Builtin::GreaterThanEqual:
    return compare(ast::BinaryOp::GreaterEqual);
  case Builtin::Equal:
    evaluate();
    return result(equal(operands[0], operands[1]));
  case Builtin::NotEqual:
    evaluate();
    return result(notEqual(operands[0], operands[1]));
  case Builtin::Any:
    evaluate();
    return result(any(operands[0]));
  case Builtin::All:
    evaluate();
    return result(all(operands[0]));
  case Builtin::Not:
    evaluate();
    return result(!operands[0]);

  case Builtin::UaddCarry: {
    evaluateWithOutputs();
    Num sum = operands[0] + operands[1];
    store({asInt(lessUnsigned(sum, operands[0]))}, places[0]);
    return result(sum);
  }
  case Builtin::UsubBorrow: {
    evaluateWithOutputs();
    store({asInt(lessUnsigned(operands[0], operands[1]))}, places[0]);
    return result(operands[0] - operands[1]);
  }
  case Builtin::UmulExtended:
  case Builtin::ImulExtended: {
    evaluateWithOutputs();
    Value a = operands[0], b = operands[1];
    mlir::Operation *product;
    if (expr.builtin == Builtin::UmulExtended)
      product = emitter.make<mlir::arith::MulUIExtendedOp>(a, b);
    else
      product = emitter.make<mlir::arith::MulSIExtendedOp>(a, b);
    store({product->getResult(1)}, places[0]); // msb
    store({product->getResult(0)}, places[1]); // lsb
    return Parts();
  }
  case Builtin::BitfieldExtract:
    evaluate();
    return result(bitfieldExtract(operands[0], operands[1], operands[2], !isUnsigned(expr)));
  case Builtin::BitfieldInsert:
    evaluate();
    return result(bitfieldInsert(operands[0], operands[1], operands[2], operands[3]));
  case Builtin::BitfieldReverse:
    evaluate();
    return result(module.library.bitfieldReverse(operands[0]));
  case Builtin::BitCount:
    evaluate();
    return result(module.library.bitCount(operands[0]));
  case Builtin::FindLSB:
    evaluate();
    return result(module.library.findLSB(operands[0]));
  case Builtin::FindMSB:
    evaluate();
    return result(module.library.findMSB(operands[0], !isUnsigned(*expr.args[0])));
  default:
    return std::nullopt;
  }
}

//===----------------------------------------------------------------------===//
// Packing: component 0 in the lowest bits
//===----------------------------------------------------------------------===//

static Num combine(Num components, unsigned bits) {
  auto mask = static_cast<std::int64_t>((1u << bits) - 1);
  Num word = components[0] & mask;
  for (unsigned i = 1; i < components.count(); ++i)
    word = word | shiftLeft(components[i] & mask, static_cast<int>(i * bits));
  return word;
}

static Num separate(Num word, unsigned bits, unsigned count) {
  auto mask = static_cast<std::int64_t>((1u << bits) - 1);
  llvm::SmallVector<Value, 4> components;
  for (unsigned i = 0; i < count; ++i)
    components.push_back(shiftRight(word, static_cast<int>(i * bits)) & mask);
  return {word.at(), word.at().vector(components)};
}

std::optional<Parts> FunctionLowering::lowerPackingBuiltin(const typed::BuiltinExpr &expr) {
  auto operand = [&] {
    Num value = number(*expr.args[0]);
    emitter.setLoc(module.location(expr.range));
    return value;
  };
  // NaN becomes the lower bound: max(low, x) keeps its first operand unless it is less.
  auto quantise = [&](Num x, double low, double scale) {
    Num clamped = minimum(maximum(x.like(low), x), x.like(1));
    Num rounded = roundEven(clamped * scale);
    return num(emitter.make<ir::ToSintOp>(withScalar(rounded.type(), emitter.getI32Type()),
                                          static_cast<Value>(rounded)));
  };
  auto toFloat = [&](Num integers) {
    return num(emitter.fold<mlir::arith::SIToFPOp>(
        withScalar(integers.type(), emitter.getF32Type()), static_cast<Value>(integers)));
  };
  auto signExtended = [](Num integers, int bits) {
    return shiftRightSigned(shiftLeft(integers, 32 - bits), 32 - bits);
  };
  auto snorm = [&](Num integers, double scale) {
    Num x = toFloat(integers) / scale;
    return clamp(x, x.like(-1), x.like(1));
  };

  switch (expr.builtin) {
  case Builtin::PackUnorm2x16:
    return Parts{combine(quantise(operand(), 0, 65535), 16)};
  case Builtin::PackSnorm2x16:
    return Parts{combine(quantise(operand(), -1, 32767), 16)};
  case Builtin::PackUnorm4x8:
    return Parts{combine(quantise(operand(), 0, 255), 8)};
  case Builtin::PackSnorm4x8:
    return Parts{combine(quantise(operand(), -1, 127), 8)};
  case Builtin::PackHalf2x16:
    return Parts{combine(module.library.halfFromFloat(operand()), 16)};
  case Builtin::UnpackUnorm2x16:
    return Parts{toFloat(separate(operand(), 16, 2)) / 65535.0};
  case Builtin::UnpackSnorm2x16:
    return Parts{snorm(signExtended(separate(operand(), 16, 2), 16), 32767)};
  case Builtin::UnpackUnorm4x8:
    return Parts{toFloat(separate(operand(), 8, 4)) / 255.0};
  case Builtin::UnpackSnorm4x8:
    return Parts{snorm(signExtended(separate(operand(), 8, 4), 8), 127)};
  case Builtin::UnpackHalf2x16:
    return Parts{module.library.floatFromHalf(separate(operand(), 16, 2))};
  default:
    return std::nullopt;
  }
}

} // namespace rtsl::lowering
