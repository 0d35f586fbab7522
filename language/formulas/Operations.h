//===- Operations.h - what formulas are made of ---------------------------===//
//
// A formula is a template over `Number`, a scalar or vector of float, int or bool. Folding
// instantiates it with values (sema/fold/Number.h), lowering with values of the IR
// (codegen/formulas/Emitter.h), so that both compute the same bits.
//
// Each operation is one IEEE single operation, in the order written; integers wrap. Beside a
// vector, a scalar or a C++ number stands for a vector that has it in each component. uint is int
// with other comparisons, which are named.
//
// C++ leaves the order of evaluation of operands open. Where it would decide which of two
// operations is emitted first, a formula names the one that comes first in a variable.
//
//   x + y, x - y, x * y, -x            floats and ints
//   x / y                              floats
//   x & y, x | y, x ^ y                ints and bools; `!x` of bools
//   shiftLeft, shiftRight,
//   shiftRightSigned(x, count)         count in 0..31
//   less, lessEqual, equal             false if an operand is NaN; of ints signed
//   notEqual(x, y)                     true if an operand is NaN
//   lessUnsigned(x, y)                 ints
//   select(condition, x, y)            condition ? x : y, by component where it is a vector
//   fma, sqrt, floor, ceil, trunc, roundEven, abs
//   toInt, toFloat                     truncates and saturates, NaN gives 0; from a signed int
//   fromBool                           0 or 1, an int
//   multiplyExtended(x, y, sign, high, low)   the 64 bits of the product of two ints
//   refract(i, n, eta)                 math/Refraction.h
//   elementary(function, x [, y])      math/Elementary.h
//
//   x.width(), x.count()               0 and 1 for a scalar; components of a vector
//   x.like(c)                          c in the type of x
//   x.real(c), x.integer(c)            c as a scalar float, int
//   x.constants({...})                 a vector of floats
//   Number::vector({x, y, z})
//   x[i], x.shuffle({2, 0, 1})         a component; some of them in any order
//   x.bits(), x.asFloat()              the same 32 bits as an int, as a float
//   constantOf(x)                      the value of a scalar int, if it is known
//
// What is evaluated only where it is needed:
//
//   choose(condition, x, f, g)         condition ? f() : g(), of the type of x
//   ifThen(condition, f)
//   repeatWhile(x, condition, f)       x is any number at hand
//   Number::Variable v("v", x)         of the type of x; `v = y`, `v.value()`
//
//   outline("name", f, x...)           f(x...); lowering makes a function of the module of it
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <vector>

namespace rtsl::formulas {

/// Which integers are meant: `int` or `uint`.
enum class IntegerSign : std::uint8_t { Signed, Unsigned };

/// The functions of math/Elementary.h.
enum class Elementary : std::uint8_t {
#define RTSL_ELEMENTARY_UNARY(Id, name) Id,
#define RTSL_ELEMENTARY_BINARY(Id, name) Id,
#include "math/ElementaryFunctions.def"
};

/// A matrix: its columns.
template <typename Number>
using Columns = std::vector<Number>;

} // namespace rtsl::formulas
