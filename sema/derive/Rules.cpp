//===- Rules.cpp - the derivatives of the built-in functions --------------===//
#include "sema/derive/Rules.h"

#include "sema/model/Conversion.h"

namespace rtsl::derive {

using namespace typed;

namespace {

constexpr float pi = 3.14159274f;
constexpr float ln2 = 0.693147182f;

enum class Shape { ByComponent, Whole };

Shape shapeOf(Builtin function) {
  switch (function) {
#define RTSL_DERIVATIVE(id, shape, formula)                                                        \
  case Builtin::id:                                                                                \
    return Shape::shape;
#include "language/Derivatives.def"
  default:
    return Shape::Whole;
  }
}

Term squareRoot(const Term &a) {
  return call(Builtin::Sqrt, {a});
}
Term dot(const Term &a, const Term &b) {
  return a.isZero() ? Term() : call(Builtin::Dot, {a, b}, a.types().floatType);
}
Term cross(const Term &a, const Term &b) {
  return call(Builtin::Cross, {a, b});
}
Term isNegative(const Term &a) {
  return less(a, Term(zero(a.types().floatType, a.expr().range), a.types()));
}

Term oneLess(const Term &a) {
  auto one = makeExpr<LiteralExpr>(a.type(), a.expr().range);
  one->value.scalars.resize(1);
  one->value.scalars[0].i = 1;
  return a - Term(std::move(one), a.types());
}

/// One call: its arguments, their changes, its value and its type, by the names of the formulas.
struct Call {
  Term x, y, z, dx, dy, dz, r;
  const Type *type;

  TypeContext &types() const { return r.types(); }

  /// A cubic between 0 and 1 of t, which runs from x to y.
  Term smoothStep() const {
    const Term t = call(Builtin::Clamp, {(z - x) / (y - x), constant(0.0f, x), constant(1.0f, x)});
    return 6.0f * (t * (1.0f - t)) * ((dz - dx - t * (dy - dx)) / (y - x));
  }

  /// z x - (z d + sqrt(k)) y, where d = dot(y, x) and k = 1 - z^2 (1 - d^2); 0 where k < 0.
  Term refracted() const {
    const Term d = dot(y, x), dd = dot(dy, x) + dot(y, dx);
    const Term sine = 1.0f - d * d;
    const Term k = 1.0f - z * z * sine;
    const Term dk = 2.0f * (z * z * d * dd) - 2.0f * (z * sine * dz);
    const Term root = squareRoot(k);
    const Term change =
        dz * x + z * dx - (dz * d + z * dd + 0.5f * dk / root) * y - (z * d + root) * dy;
    return select(isNegative(k), Term(), change, type);
  }

  /// The change of the component that is chosen.
  Term extreme(Builtin function) const {
    Term value = component(x, 0), change = component(dx, 0);
    for (std::uint32_t i = 1; i < x.type()->count; ++i) {
      const Term next = component(x, i);
      const Term isBetter = function == Builtin::Min ? less(next, value) : less(value, next);
      change = select(isBetter, component(dx, i), change, type);
      value = call(function, {value, next});
    }
    return change;
  }

  Term change(Builtin function) const {
    switch (function) {
#define RTSL_DERIVATIVE(id, shape, formula)                                                        \
  case Builtin::id:                                                                                \
    return formula;
#include "language/Derivatives.def"
    default:
      return {};
    }
  }
};

} // namespace

bool hasRule(Builtin function) {
  switch (function) {
#define RTSL_DERIVATIVE(id, shape, formula) case Builtin::id:
#include "language/Derivatives.def"
    return true;
  default:
    return false;
  }
}

Term derivative(const BuiltinExpr &call, std::vector<Term> values, std::vector<Term> changes,
                TypeContext &types) {
  Call named;
  named.type = call.type;
  auto whole = makeExpr<BuiltinExpr>(call.type, call.range);
  whole->builtin = call.builtin;
  for (const Term &value : values)
    whole->args.push_back(Term(value).take());
  named.r = Term(std::move(whole), types);
  const bool byComponent = shapeOf(call.builtin) == Shape::ByComponent;
  Term *const arguments[] = {&named.x, &named.y, &named.z};
  Term *const changesOf[] = {&named.dx, &named.dy, &named.dz};
  for (std::size_t i = 0; i < values.size() && i < 3; ++i) {
    const bool fits = byComponent && values[i].type()->scalar() == types.floatType;
    *arguments[i] = fits ? fitted(std::move(values[i]), call.type) : std::move(values[i]);
    *changesOf[i] = fits ? fitted(std::move(changes[i]), call.type) : std::move(changes[i]);
  }
  return fitted(named.change(call.builtin), call.type);
}

} // namespace rtsl::derive
