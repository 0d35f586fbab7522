//===- ConstantBuiltins.cpp - folding of built-in functions ---------------===//
//
// Componentwise functions whose result is exact or correctly rounded on every machine. Elementary
// functions are left to the code generator, which calls the same implementation as the shaders do.
//
//===----------------------------------------------------------------------===//
#include "math/Elementary.h"
#include "sema/fold/ConstantFold.h"

#include <algorithm>
#include <limits>

namespace rtsl {

using typed::Builtin;
using typed::Constant;
using Scalar = Constant::Scalar;

// The same choice between operands as at run time: a NaN loses only if the comparison makes it so.
static float minimum(float x, float y) {
  return y < x ? y : x;
}
static float maximum(float x, float y) {
  return x < y ? y : x;
}

static std::optional<float> foldElementary1(Builtin builtin, float x) {
  switch (builtin) {
  case Builtin::Sin:
    return device::sin(x);
  case Builtin::Cos:
    return device::cos(x);
  case Builtin::Tan:
    return device::tan(x);
  case Builtin::SinPi:
    return device::sinpi(x);
  case Builtin::CosPi:
    return device::cospi(x);
  case Builtin::Asin:
    return device::asin(x);
  case Builtin::Acos:
    return device::acos(x);
  case Builtin::Atan:
    return device::atan(x);
  case Builtin::Sinh:
    return device::sinh(x);
  case Builtin::Cosh:
    return device::cosh(x);
  case Builtin::Tanh:
    return device::tanh(x);
  case Builtin::Asinh:
    return device::asinh(x);
  case Builtin::Acosh:
    return device::acosh(x);
  case Builtin::Atanh:
    return device::atanh(x);
  case Builtin::Exp:
    return device::exp(x);
  case Builtin::Exp2:
    return device::exp2(x);
  case Builtin::Log:
    return device::log(x);
  case Builtin::Log2:
    return device::log2(x);
  case Builtin::Expm1:
    return device::expm1(x);
  case Builtin::Log1p:
    return device::log1p(x);
  case Builtin::InverseSqrt:
    return device::inversesqrt(x);
  default:
    return std::nullopt;
  }
}

static std::optional<float> foldFloat1(Builtin builtin, float x) {
  switch (builtin) {
  case Builtin::Radians:
    return x * 0.017453292519943295f;
  case Builtin::Degrees:
    return x * 57.29577951308232f;
  case Builtin::Abs:
    return std::fabs(x);
  case Builtin::Sign:
    return x > 0.0f ? 1.0f : x < 0.0f ? -1.0f : x;
  case Builtin::Floor:
    return std::floor(x);
  case Builtin::Trunc:
    return std::trunc(x);
  case Builtin::Ceil:
    return std::ceil(x);
  case Builtin::Fract:
    return x - std::floor(x);
  case Builtin::Round:
  case Builtin::RoundEven:
    return std::nearbyint(x);
  case Builtin::Sqrt:
    return std::sqrt(x);
  default:
    return foldElementary1(builtin, x);
  }
}

static std::optional<float> foldFloat2(Builtin builtin, float x, float y) {
  switch (builtin) {
  case Builtin::Mod:
    return x - y * std::floor(x / y);
  case Builtin::Min:
    return minimum(x, y);
  case Builtin::Max:
    return maximum(x, y);
  case Builtin::Step:
    return y < x ? 0.0f : 1.0f;
  case Builtin::Pow:
    return device::pow(x, y);
  case Builtin::Atan2:
    return device::atan2(x, y);
  default:
    return std::nullopt;
  }
}

static std::optional<float> foldFloat3(Builtin builtin, float x, float y, float z) {
  switch (builtin) {
  case Builtin::Clamp:
    return minimum(maximum(x, y), z);
  case Builtin::Mix:
    return x * (1.0f - z) + y * z;
  case Builtin::SmoothStep: {
    const float t = minimum(maximum((z - x) / (y - x), 0.0f), 1.0f);
    return (t * t) * (3.0f - 2.0f * t);
  }
  case Builtin::Fma:
    return std::fma(x, y, z);
  default:
    return std::nullopt;
  }
}

static std::optional<Scalar> foldInteger(Builtin builtin, bool isSigned, const Scalar *v,
                                         std::size_t count) {
  auto less = [&](Scalar a, Scalar b) { return isSigned ? a.i < b.i : a.u < b.u; };
  switch (builtin) {
  case Builtin::Abs:
    return v[0].i < 0 ? makeUInt(0u - v[0].u) : v[0];
  case Builtin::Sign:
    return makeInt(v[0].i > 0 ? 1 : v[0].i < 0 ? -1 : 0);
  case Builtin::Min:
    return less(v[1], v[0]) ? v[1] : v[0];
  case Builtin::Max:
    return less(v[0], v[1]) ? v[1] : v[0];
  case Builtin::Clamp: {
    const Scalar low = less(v[0], v[1]) ? v[1] : v[0];
    return less(v[2], low) ? v[2] : low;
  }
  case Builtin::BitCount:
    return makeInt(__builtin_popcount(v[0].u));
  default:
    return std::nullopt;
  }
}

/// By squaring, from the lowest bit of the exponent; the reciprocal is taken at the end.
static float foldIntegerPower(float x, std::int32_t exponent) {
  float result = 1.0f, base = x;
  for (std::uint32_t rest = exponent < 0 ? 0u - static_cast<std::uint32_t>(exponent)
                                         : static_cast<std::uint32_t>(exponent);
       rest != 0; rest >>= 1) {
    if (rest & 1)
      result = result * base;
    base = base * base;
  }
  return exponent < 0 ? 1.0f / result : result;
}

static std::optional<Scalar> foldComponent(Builtin builtin, TypeKind kind, const Scalar *v,
                                           std::size_t count) {
  switch (builtin) {
  case Builtin::IsNan:
    return makeBool(std::isnan(v[0].f));
  case Builtin::IsInf:
    return makeBool(std::isinf(v[0].f));
  case Builtin::FloatBitsToInt:
  case Builtin::FloatBitsToUint: // all NaNs have the same bits
    return std::isnan(v[0].f) ? makeUInt(0x7fc00000u) : v[0];
  case Builtin::IntBitsToFloat:
  case Builtin::UintBitsToFloat:
    return v[0]; // the same 32 bits
  case Builtin::Not:
    return makeBool(!v[0].b);
  case Builtin::MixSelect:
    return v[2].b ? v[1] : v[0];
  case Builtin::LessThan:
    return makeBool(kind == TypeKind::Float ? v[0].f < v[1].f
                    : kind == TypeKind::Int ? v[0].i < v[1].i
                                            : v[0].u < v[1].u);
  case Builtin::GreaterThan:
    return makeBool(kind == TypeKind::Float ? v[0].f > v[1].f
                    : kind == TypeKind::Int ? v[0].i > v[1].i
                                            : v[0].u > v[1].u);
  case Builtin::LessThanEqual:
    return makeBool(kind == TypeKind::Float ? v[0].f <= v[1].f
                    : kind == TypeKind::Int ? v[0].i <= v[1].i
                                            : v[0].u <= v[1].u);
  case Builtin::GreaterThanEqual:
    return makeBool(kind == TypeKind::Float ? v[0].f >= v[1].f
                    : kind == TypeKind::Int ? v[0].i >= v[1].i
                                            : v[0].u >= v[1].u);
  case Builtin::Equal:
    return makeBool(kind == TypeKind::Float  ? v[0].f == v[1].f
                    : kind == TypeKind::Bool ? v[0].b == v[1].b
                                             : v[0].u == v[1].u);
  case Builtin::NotEqual:
    return makeBool(kind == TypeKind::Float  ? v[0].f != v[1].f
                    : kind == TypeKind::Bool ? v[0].b != v[1].b
                                             : v[0].u != v[1].u);
  default:
    break;
  }
  if (builtin == Builtin::PowInt)
    return makeFloat(foldIntegerPower(v[0].f, v[1].i));
  if (kind == TypeKind::Int || kind == TypeKind::UInt)
    return foldInteger(builtin, kind == TypeKind::Int, v, count);
  if (kind != TypeKind::Float)
    return std::nullopt;
  const std::optional<float> result = count == 1   ? foldFloat1(builtin, v[0].f)
                                      : count == 2 ? foldFloat2(builtin, v[0].f, v[1].f)
                                      : count == 3 ? foldFloat3(builtin, v[0].f, v[1].f, v[2].f)
                                                   : std::nullopt;
  if (!result)
    return std::nullopt;
  return makeFloat(*result);
}

static float foldDot(const std::vector<Scalar> &a, const std::vector<Scalar> &b) {
  float sum = a[0].f * b[0].f;
  for (std::size_t i = 1; i != a.size(); ++i)
    sum = sum + a[i].f * b[i].f;
  return sum;
}

/// a b - c d with an error of 1.5 ulp (Kahan; Jeannerod, Louvet and Muller 2013).
static float differenceOfProducts(float a, float b, float c, float d) {
  const float product = c * d;
  const float error = std::fma(-c, d, product);
  return std::fma(a, b, -product) + error;
}

/// Geometric functions, where no scaling against overflow is required.
static std::optional<Constant> foldGeometric(Builtin builtin, const std::vector<Constant> &args) {
  const std::vector<Scalar> &a = args[0].scalars;
  const std::vector<Scalar> &b = args[args.size() > 1 ? 1 : 0].scalars;
  // The sum of squares neither overflows nor loses significant digits.
  auto isGoodSquare = [](float square) {
    return square >= 0x1p-96f && square <= std::numeric_limits<float>::max();
  };
  Constant result;
  switch (builtin) {
  case Builtin::Dot:
    return Constant{{makeFloat(foldDot(a, b))}};
  case Builtin::Cross:
    for (std::size_t i = 0; i != 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      result.scalars.push_back(makeFloat(differenceOfProducts(a[j].f, b[k].f, a[k].f, b[j].f)));
    }
    return result;
  case Builtin::Length:
  case Builtin::Distance: {
    std::vector<Scalar> v = a;
    for (std::size_t i = 0; builtin == Builtin::Distance && i != v.size(); ++i)
      v[i] = makeFloat(a[i].f - b[i].f);
    if (v.size() == 1)
      return Constant{{makeFloat(std::fabs(v[0].f))}};
    const float square = foldDot(v, v);
    if (!isGoodSquare(square))
      return std::nullopt;
    return Constant{{makeFloat(std::sqrt(square))}};
  }
  case Builtin::Normalize: {
    const float square = foldDot(a, a);
    if (a.size() == 1 || !isGoodSquare(square))
      return std::nullopt;
    const float length = std::sqrt(square);
    for (const Scalar &component : a)
      result.scalars.push_back(makeFloat(component.f / length));
    return result;
  }
  default:
    return std::nullopt;
  }
}

/// Functions of whole vectors and matrices.
static std::optional<Constant> foldWhole(const typed::BuiltinExpr &call,
                                         const std::vector<Constant> &args) {
  if (args.empty())
    return std::nullopt;
  const std::vector<Scalar> &v = args[0].scalars;
  const Type *type = call.args[0]->type;
  switch (call.builtin) {
  case Builtin::Any:
    return Constant{{makeBool(std::any_of(v.begin(), v.end(), [](Scalar s) { return s.b; }))}};
  case Builtin::All:
    return Constant{{makeBool(std::all_of(v.begin(), v.end(), [](Scalar s) { return s.b; }))}};
  case Builtin::MinComponent:
  case Builtin::MaxComponent: {
    const Builtin pair = call.builtin == Builtin::MinComponent ? Builtin::Min : Builtin::Max;
    Scalar result = v[0];
    for (std::size_t i = 1; i < v.size(); ++i) {
      const Scalar both[] = {result, v[i]};
      if (std::optional<Scalar> next = foldComponent(pair, type->scalar()->kind, both, 2))
        result = *next;
    }
    return Constant{{result}};
  }
  case Builtin::Inside: {
    bool inside = true;
    for (std::size_t i = 0; i != v.size(); ++i)
      for (unsigned bound = 1; bound <= 2; ++bound) {
        const std::vector<Scalar> &limit = args[bound].scalars;
        const Scalar both[] = {v[i], limit[limit.size() == 1 ? 0 : i]};
        const Builtin test = bound == 1 ? Builtin::GreaterThanEqual : Builtin::LessThanEqual;
        inside = inside && foldComponent(test, type->scalar()->kind, both, 2)->b;
      }
    return Constant{{makeBool(inside)}};
  }
  case Builtin::DominantAxis: {
    int axis = 0;
    for (std::size_t i = 1; i < v.size(); ++i)
      if (std::fabs(v[i].f) > std::fabs(v[static_cast<std::size_t>(axis)].f))
        axis = static_cast<int>(i);
    return Constant{{makeInt(axis)}};
  }
  case Builtin::Transpose: {
    Constant result;
    for (std::uint32_t r = 0; r != type->rows(); ++r)
      for (std::uint32_t c = 0; c != type->columns(); ++c)
        result.scalars.push_back(v[c * type->rows() + r]);
    return result;
  }
  case Builtin::MatrixCompMult: {
    Constant result;
    for (std::size_t i = 0; i != v.size(); ++i)
      result.scalars.push_back(makeFloat(v[i].f * args[1].scalars[i].f));
    return result;
  }
  default:
    return std::nullopt;
  }
}

std::optional<Constant> evaluateBuiltin(const typed::BuiltinExpr &call,
                                        const std::vector<Constant> &args) {
  if (call.type->is(TypeKind::Color))
    return std::nullopt;
  for (const typed::ExprPtr &arg : call.args)
    if (!arg->type->scalar())
      return std::nullopt;
  if (std::optional<Constant> whole = foldWhole(call, args))
    return whole;
  if (!args.empty())
    if (std::optional<Constant> geometric = foldGeometric(call.builtin, args))
      return geometric;
  if (args.empty() || args.size() > 3 || call.type->isMatrix() || !call.type->scalar())
    return std::nullopt;
  // The arguments of `mix`, except its selector, have one scalar type; scalars beside vectors are
  // broadcast.
  const TypeKind kind = call.args[0]->type->scalar()->kind;
  Constant result;
  for (std::uint32_t i = 0; i != call.type->componentCount(); ++i) {
    Scalar component[3];
    for (std::size_t a = 0; a != args.size(); ++a) {
      if (args[a].scalars.size() != 1 && args[a].scalars.size() != call.type->componentCount())
        return std::nullopt;
      component[a] = args[a].scalars[args[a].scalars.size() == 1 ? 0 : i];
    }
    std::optional<Scalar> value = foldComponent(call.builtin, kind, component, args.size());
    if (!value)
      return std::nullopt;
    result.scalars.push_back(*value);
  }
  return result;
}

} // namespace rtsl
