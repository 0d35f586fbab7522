//===- Library.h - functions for formulas, and operations on numbers ------===//
//
// The building blocks of formulas of built-in functions (language/formulas), in addition to the
// operators of Emitter.h. Short formulas are emitted in place. For long ones, and rare paths,
// `outline` makes a private function of the module, `@rtsl.normalize.vec3`, when it is first
// needed.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/formulas/Emitter.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

#include <array>
#include <functional>
#include <map>
#include <string>
#include <type_traits>

namespace rtsl::lowering {

/// A matrix: its columns.
using Columns = formulas::Columns<Num>;

//===----------------------------------------------------------------------===//
// Functions of the module
//===----------------------------------------------------------------------===//

/// The private functions of a module for long formulas. Emitters that refer to it make them.
class Library {
public:
  explicit Library(mlir::ModuleOp module) : module(module) {}

  using Numbers = llvm::SmallVector<Num, 4>;
  /// Calls `@rtsl.<name>.<type of the first argument>`; defines it with `body` if it does not exist
  /// yet.
  Numbers call(const std::string &name, const Numbers &arguments,
               llvm::function_ref<Numbers(const Numbers &)> body);
  /// The same for a function of a matrix, to a matrix of its shape or to a float.
  Columns callMatrix(const std::string &name, const Columns &m,
                     llvm::function_ref<Columns(const Columns &)> body);
  Num callMatrixToScalar(const std::string &name, const Columns &m,
                         llvm::function_ref<Num(const Columns &)> body);

private:
  using Body = llvm::function_ref<void(Emitter &, mlir::func::FuncOp)>;
  mlir::func::FuncOp define(const std::string &symbol, mlir::FunctionType type, Body body);

  mlir::ModuleOp module;
  std::map<std::string, mlir::func::FuncOp> functions;
};

namespace detail {
template <typename Body, std::size_t... I>
auto invoke(const Body &body, const Library::Numbers &arguments, std::index_sequence<I...>) {
  return body(arguments[I]...);
}
} // namespace detail

/// `body(arguments...)`, a number or an array of them, as a function call.
template <typename Body, typename... Arguments>
auto outline(const char *name, const Body &body, Num first, Arguments... others) {
  using Result = std::invoke_result_t<Body, Num, Arguments...>;
  Library *library = first.at().library;
  if (!library)
    return body(first, others...);
  const Library::Numbers results =
      library->call(name, {first, others...}, [&](const Library::Numbers &parameters) {
        constexpr std::make_index_sequence<1 + sizeof...(Arguments)> all;
        const Result values = detail::invoke(body, parameters, all);
        if constexpr (std::is_same_v<Result, Num>)
          return Library::Numbers{values};
        else
          return Library::Numbers(values.begin(), values.end());
      });
  if constexpr (std::is_same_v<Result, Num>) {
    return results.front();
  } else {
    Result values;
    std::copy(results.begin(), results.end(), values.begin());
    return values;
  }
}

/// The same for a matrix; the result is a matrix of its shape or a float.
template <typename Body>
auto outline(const char *name, const Body &body, const Columns &m) {
  Library *library = m.front().at().library;
  if (!library)
    return body(m);
  if constexpr (std::is_same_v<std::invoke_result_t<Body, const Columns &>, Num>)
    return library->callMatrixToScalar(name, m, body);
  else
    return library->callMatrix(name, m, body);
}

/// `float`, `ivec2`, `vec3`, `float16`: the type in the names of such functions.
std::string typeWord(mlir::Type type);

//===----------------------------------------------------------------------===//
// Control
//===----------------------------------------------------------------------===//

/// A variable of a value type.
class Num::Variable {
public:
  Variable(const char *name, Num shape)
      : emitter(&shape.at()), address(emitter->variable(name, shape.type())) {}
  void operator=(Num x) { emitter->store(x, address); }
  Num value() const { return {*emitter, emitter->load(address)}; }

private:
  Emitter *emitter;
  Value address;
};

template <typename Body>
void ifThen(Num condition, const Body &body) {
  condition.at().ifThen(condition, body);
}

/// `x` has the type of the result.
template <typename First, typename Second>
Num choose(Num condition, Num x, const First &whenTrue, const Second &whenFalse) {
  Num::Variable result("result", x);
  condition.at().ifThen(condition, [&] { result = whenTrue(); }, [&] { result = whenFalse(); });
  return result.value();
}

/// `x` is any number.
template <typename Condition, typename Body>
void repeatWhile(Num x, const Condition &condition, const Body &body) {
  x.at().loop(false, [&]() -> Value { return condition(); }, body, nullptr);
}

//===----------------------------------------------------------------------===//
// Functions that are a single operation of the IR
//===----------------------------------------------------------------------===//

/// A scalar next to a vector stands for a vector.
Num elementary(formulas::Elementary function, Num x);
Num elementary(formulas::Elementary function, Num x, Num y);
Num refract(Num i, Num n, Num eta);
void multiplyExtended(Num x, Num y, formulas::IntegerSign sign, Num &high, Num &low);

} // namespace rtsl::lowering
