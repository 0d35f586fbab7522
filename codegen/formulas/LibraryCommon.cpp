//===- LibraryCommon.cpp - min, mix, mod, frexp and the like --------------===//
#include "codegen/formulas/Library.h"

#include "mlir/IR/Matchers.h"

#include <cmath>
#include <optional>

namespace rtsl::lowering {

Num minimum(Num x, Num y) {
  return select(less(y, x), y, x);
}
Num maximum(Num x, Num y) {
  return select(less(x, y), y, x);
}
Num minimumUnsigned(Num x, Num y) {
  return select(lessUnsigned(y, x), y, x);
}
Num maximumUnsigned(Num x, Num y) {
  return select(lessUnsigned(x, y), y, x);
}
Num clamp(Num x, Num low, Num high) {
  return minimum(maximum(x, low), high);
}
Num mix(Num a, Num b, Num t) {
  return a * (1.0 - t) + b * t;
}

Num step(Num edge, Num x) {
  Num below = less(x, edge);
  Num one(x.at(), x.at().constant(withScalar(below.type(), x.at().getF32Type()), 1));
  return select(below, 0.0, one);
}

Num smoothstep(Num edge0, Num edge1, Num x) {
  Num t = (x - edge0) / (edge1 - edge0);
  t = clamp(t, t.like(0), t.like(1));
  return (t * t) * (3.0 - 2.0 * t);
}

Num sign(Num x) {
  return select(less(0.0, x), 1.0, select(less(x, 0.0), -1.0, x));
}
Num fract(Num x) {
  return x - floor(x);
}
Num mod(Num x, Num y) {
  return x - y * floor(x / y);
}

Num copySign(Num magnitude, Num sign) {
  return ((magnitude.bits() & 0x7fffffff) | (sign.bits() & 0x80000000)).asFloat();
}

Num modf(Num x, Num &whole) {
  whole = trunc(x);
  Num fraction = select(equal(x, whole), 0.0, x - whole);
  return copySign(fraction, x);
}

Num isNan(Num x) {
  return notEqual(x, x);
}
Num isInf(Num x) {
  return equal(abs(x), static_cast<double>(INFINITY));
}

Num choose(Num condition, mlir::Type type, const std::function<Num()> &whenTrue,
           const std::function<Num()> &whenFalse) {
  Emitter &emitter = condition.at();
  Value result = emitter.variable("result", type);
  emitter.ifThen(
      condition, [&] { emitter.store(whenTrue(), result); },
      [&] { emitter.store(whenFalse(), result); });
  return {emitter, emitter.load(result)};
}

Num minComponent(Num v) {
  Num result = v[0];
  for (unsigned i = 1; i < v.count(); ++i)
    result = minimum(result, v[i]);
  return result;
}

Num maxComponent(Num v) {
  Num result = v[0];
  for (unsigned i = 1; i < v.count(); ++i)
    result = maximum(result, v[i]);
  return result;
}

Num dominantAxis(Num v) {
  Num magnitude = abs(v);
  Num largest = magnitude[0];
  Num axis(v.at(), v.at().intConstant(0));
  for (unsigned i = 1; i < v.count(); ++i) {
    Num isLarger = less(largest, magnitude[i]);
    axis = select(isLarger, i, axis);
    largest = select(isLarger, magnitude[i], largest);
  }
  return axis;
}

Num inside(Num x, Num low, Num high) {
  return all(lessEqual(low, x)) & all(lessEqual(x, high));
}

//===----------------------------------------------------------------------===//
// Parts of a number
//===----------------------------------------------------------------------===//

// x = significand * 2^exponent with the significand in [0.5, 1). Zero, infinities and NaN have
// exponent 0.
Num Library::frexp(Num x, Num &exponent) {
  mlir::Type exponents = withScalar(x.type(), x.at().getI32Type());
  auto results = call("frexp", {x}, {x.type(), exponents}, [](llvm::ArrayRef<Num> arguments) {
    Num x = arguments[0];
    // A subnormal becomes normal by an exact factor.
    Num isSmall = less(abs(x), 0x1p-126);
    Num bits = select(isSmall, x * 0x1p24, x).bits();
    Num exponent = (shiftRight(bits, 23) & 0xff) - 126.0;
    exponent = select(isSmall, exponent - 24.0, exponent);
    Num significand = ((bits & 0x807fffff) | 0x3f000000).asFloat();
    Num hasParts = less(0.0, abs(x)) & less(abs(x), static_cast<double>(INFINITY));
    return llvm::SmallVector<Num, 2>{select(hasParts, significand, x),
                                     select(hasParts, exponent, 0.0)};
  });
  exponent = results[1];
  return results[0];
}

// x * 2^exponent, rounded once. Three factors reach every result: the factors above 1 are exact; a
// factor below 2^-126 is taken in steps of 2^-102, and where such a step rounds, what follows makes
// the result zero.
Num Library::ldexp(Num x, Num exponent) {
  return callOne("ldexp", {x, exponent}, x.type(), [](llvm::ArrayRef<Num> arguments) {
    Num result = arguments[0];
    Num rest = clamp(arguments[1], arguments[1].like(-280), arguments[1].like(280));
    for (int i = 0; i < 3; ++i) {
      Num part = i == 2 ? rest : select(less(rest, -126.0), -102.0, minimum(rest, rest.like(127)));
      result = result * shiftLeft(part + 127.0, 23).asFloat();
      rest = rest - part;
    }
    return result;
  });
}

//===----------------------------------------------------------------------===//
// Powers
//===----------------------------------------------------------------------===//

static std::optional<std::int32_t> constantOf(Num value) {
  llvm::APInt constant;
  if (mlir::matchPattern(static_cast<Value>(value), mlir::m_ConstantInt(&constant)))
    return static_cast<std::int32_t>(constant.getSExtValue());
  return std::nullopt;
}

// By squaring, from the lowest bit of |exponent| on: result *= base for a set bit, base *= base. A
// negative exponent takes the reciprocal at the end. Each step rounds, so the error is below
// |exponent| ulp.
Num Library::powInt(Num x, Num exponent) {
  std::optional<std::int32_t> constant = constantOf(exponent);
  if (constant && *constant >= -64 && *constant <= 64) {
    // The same operations as below, but for a factor of 1 at the start.
    Num result = x.like(1), base = x;
    bool isOne = true;
    for (auto n = static_cast<unsigned>(std::abs(*constant)); n != 0; n >>= 1) {
      if (n & 1) {
        result = isOne ? base : result * base;
        isOne = false;
      }
      if (n > 1)
        base = base * base;
    }
    return *constant < 0 ? 1.0 / result : result;
  }
  return callOne("powInt", {x, exponent}, x.type(), [](llvm::ArrayRef<Num> arguments) {
    Num x = arguments[0], exponent = arguments[1];
    Emitter &emitter = x.at();
    Value result = emitter.variable("result", x.type());
    Value base = emitter.variable("base", x.type());
    Value rest = emitter.variable("rest", exponent.type());
    emitter.store(x.like(1), result);
    emitter.store(x, base);
    emitter.store(abs(exponent), rest);
    auto value = [&](Value address) { return Num(emitter, emitter.load(address)); };
    emitter.loop(
        false, [&]() -> Value { return notEqual(value(rest), 0.0); },
        [&] {
          emitter.ifThen(notEqual(value(rest) & 1, 0.0),
                         [&] { emitter.store(value(result) * value(base), result); });
          emitter.store(value(base) * value(base), base);
          emitter.store(shiftRight(value(rest), 1), rest);
        },
        nullptr);
    return select(less(exponent, 0.0), 1.0 / value(result), value(result));
  });
}

} // namespace rtsl::lowering
