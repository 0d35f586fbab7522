//===- Call.h - the formula of a built-in function, by its row ------------===//
//
// Builtins.def names the formula of each function that has one. Its parameters say what it takes:
//
//   Number                     a scalar or a vector
//   const Columns<Number> &    a matrix
//   Number &                   an `out` argument
//   IntegerSign                after the others: of the first argument
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Color.h"
#include "language/formulas/Common.h"
#include "language/formulas/Comparison.h"
#include "language/formulas/Elementary.h"
#include "language/formulas/Geometry.h"
#include "language/formulas/Integers.h"
#include "language/formulas/Matrices.h"
#include "language/formulas/Packing.h"
#include "language/formulas/Primitives.h"

#include <cstddef>
#include <tuple>
#include <type_traits>

namespace rtsl::formulas {

/// The arguments and results of a call. A matrix is given by its columns, any other value by one
/// number.
template <typename Number>
struct Call {
  std::vector<Columns<Number>> arguments; // but for those that are `out`
  IntegerSign sign = IntegerSign::Signed;
  Columns<Number> result;      // empty: void
  std::vector<Number> outputs; // of the `out` arguments
};

/// Stands in the table for functions that have no formula: what they do depends on more than their
/// arguments.
template <typename Number>
inline constexpr std::nullptr_t none = nullptr;

namespace detail {

/// Takes the arguments of a call one by one, converted to the parameters of its formula.
template <typename Number>
struct Arguments {
  Call<Number> &call;
  std::size_t inputs = 0, outputs = 0;

  template <typename Parameter>
  Parameter next() {
    if constexpr (std::is_same_v<Parameter, IntegerSign>)
      return call.sign;
    else if constexpr (std::is_same_v<Parameter, Number &>)
      return call.outputs[outputs++];
    else if constexpr (std::is_same_v<Parameter, Number>)
      return call.arguments[inputs++].front();
    else
      return call.arguments[inputs++];
  }
};

template <typename Number, typename Result, typename... Parameters>
bool run(Call<Number> &call, Result (*formula)(Parameters...)) {
  call.outputs.resize((std::size_t(std::is_same_v<Parameters, Number &>) + ...));
  Arguments<Number> arguments{call};
  std::tuple<Parameters...> values{arguments.template next<Parameters>()...}; // from left to right
  if constexpr (std::is_void_v<Result>)
    std::apply(formula, values);
  else if constexpr (std::is_same_v<Result, Number>)
    call.result = {std::apply(formula, values)};
  else
    call.result = std::apply(formula, values);
  return true;
}
template <typename Number>
bool run(Call<Number> &, std::nullptr_t) {
  return false;
}

} // namespace detail

/// Computes a call of `builtin`, an enumerator for each row of Builtins.def. False if it has no
/// formula.
template <typename Builtin, typename Number>
bool evaluate(Builtin builtin, Call<Number> &call) {
  switch (builtin) {
#define RTSL_BUILTIN(id, name, effect, cost, where, formula, ...)                                  \
  case Builtin::id:                                                                                \
    return detail::run(call, formula<Number>);
#include "language/Builtins.def"
  }
  return false;
}

} // namespace rtsl::formulas
