//===- Emitter.h - concise construction of IR -----------------------------===//
//
// `Emitter` is a builder with a current location. `Num` is a value with operators, so that a
// formula in the compiler reads like the formula in a book: each operator makes one operation, in
// the order of the C++ expression, and constants fold.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"
#include "language/formulas/Operations.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/IR/ImplicitLocOpBuilder.h"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <vector>

namespace rtsl::lowering {

using mlir::Value;

class Library;

class Emitter : public mlir::ImplicitLocOpBuilder {
public:
  explicit Emitter(mlir::MLIRContext *context)
      : ImplicitLocOpBuilder(mlir::UnknownLoc::get(context), context) {}

  // Constants
  Value floatConstant(float value);
  Value intConstant(std::int64_t value);
  Value boolConstant(bool value);
  /// `value` in every component of a scalar or vector type, float or integer.
  Value constant(mlir::Type type, double value);
  /// Zero, false or null of a value type.
  Value zero(mlir::Type type);

  // Vectors
  Value vector(llvm::ArrayRef<Value> components); // at least one
  Value splat(Value scalar, unsigned count);
  Value extract(Value vector, unsigned component);
  Value extract(Value vector, Value component); // i32, in range
  Value insert(Value vector, Value scalar, unsigned component);
  Value insert(Value vector, Value scalar, Value component);
  Value shuffle(Value vector, llvm::ArrayRef<std::int64_t> components); // at least two

  // Memory
  Value variable(llvm::StringRef name, mlir::Type type); // at the insertion point
  Value load(Value address);
  void store(Value value, Value address);
  void copy(Value from, Value to);
  Value field(Value address, llvm::StringRef name);
  Value element(Value address, Value index);
  Value element(Value address, unsigned index);

  // Control. A region that does not end by itself is closed with rtsl.yield.
  using Block = llvm::function_ref<void()>;
  void ifThen(Value condition, Block then, Block otherwise = nullptr);
  /// The condition's block returns the condition, or null for an endless loop.
  void loop(bool testAfter, llvm::function_ref<Value()> condition, Block body, Block step);
  struct Arm {
    std::vector<std::int64_t> values;
    bool isDefault = false;
    std::function<void()> body;
  };
  void switchOver(Value value, const std::vector<Arm> &arms);
  void illuminance(Value point, Value normal, Value cosAngle,
                   Block body); // normal and cosAngle may be null
  void returnValues(mlir::ValueRange values);
  /// The current block has its terminator: no operation may follow.
  bool isTerminated() const;

  template <typename Op, typename... Args>
  auto make(Args &&...args) {
    return Op::create(*this, getLoc(), std::forward<Args>(args)...);
  }
  template <typename Op, typename... Args>
  Value fold(Args &&...args) {
    if constexpr (roundsToSingle<Op>)
      if (hidesConstants())
        return make<Op>(std::forward<Args>(args)...);
    return createOrFold<Op>(std::forward<Args>(args)...);
  }

  /// Owns the functions of long formulas; null: these are emitted in place.
  Library *library = nullptr;

  /// Whether arithmetic must not be folded in single precision, or at all (HideConstants.h).
  bool hidesConstants() const;

private:
  /// Operations whose result on constants depends on the precision.
  template <typename Op>
  static constexpr bool roundsToSingle =
      llvm::is_one_of<Op, mlir::arith::AddFOp, mlir::arith::SubFOp, mlir::arith::MulFOp,
                      mlir::arith::DivFOp, mlir::arith::SIToFPOp, mlir::arith::UIToFPOp,
                      mlir::math::FmaOp, mlir::math::SqrtOp, ir::RefractOp>::value;

  void fill(mlir::Region &region, Block body);
};

/// Erases unused operations: constants that have been folded, loads of a discarded expression.
/// Variables and their names remain.
void eraseUnused(mlir::Region &region);

/// f32 for vector<3xf32>; a scalar type itself.
mlir::Type scalarType(mlir::Type type);
/// Components of a vector type; 0 for a scalar.
unsigned vectorWidth(mlir::Type type);
/// A scalar, or a vector of `scalar` as wide as `shape`.
mlir::Type withScalar(mlir::Type shape, mlir::Type scalar);

/// A scalar or vector of f32, i32 or i1 with operators. Next to a vector, a scalar or a C++ number
/// stands for a vector that has it in each component. Comparisons of integers are signed unless
/// their name says otherwise. The operations are those that formulas use
/// (language/formulas/Operations.h); Library.h has the rest of them.
class Num {
public:
  Num() = default;
  Num(Emitter &emitter, Value value) : emitter(&emitter), value(value) {}

  operator Value() const { return value; }
  mlir::Type type() const { return value.getType(); }
  Emitter &at() const { return *emitter; }
  bool isFloat() const { return scalarType(type()).isF32(); }
  bool isBool() const { return scalarType(type()).isInteger(1); }
  unsigned width() const { return vectorWidth(type()); } // 0: scalar
  /// Components: the width, 1 for a scalar.
  unsigned count() const { return width() == 0 ? 1 : width(); }

  Num like(double constant) const { return {*emitter, emitter->constant(type(), constant)}; }
  /// A scalar constant.
  Num real(float constant) const { return {*emitter, emitter->floatConstant(constant)}; }
  Num integer(std::int32_t constant) const { return {*emitter, emitter->intConstant(constant)}; }
  /// A vector of floats.
  Num constants(const std::vector<double> &values) const;
  /// A vector of scalars, at least one.
  static Num vector(const std::vector<Num> &components);
  /// A component; a scalar is its own component 0.
  Num operator[](unsigned component) const;
  Num splat(unsigned count) const { return {*emitter, emitter->splat(value, count)}; }
  Num shuffle(std::initializer_list<std::int64_t> components) const;

  Num bits() const;    // f32 -> i32, the same bits
  Num asFloat() const; // i32 -> f32, the same bits

  class Variable;

private:
  Emitter *emitter = nullptr;
  Value value;
};

Num operator+(Num a, Num b);
Num operator-(Num a, Num b);
Num operator*(Num a, Num b);
Num operator/(Num a, Num b); // floats only
Num operator-(Num a);
Num operator&(Num a, Num b);
Num operator|(Num a, Num b);
Num operator^(Num a, Num b);
Num operator!(Num a);            // of bools
Num shiftLeft(Num a, Num count); // count in 0..31
Num shiftRight(Num a, Num count);
Num shiftRightSigned(Num a, Num count);

inline Num operator+(Num a, double b) {
  return a + a.like(b);
}
inline Num operator+(double a, Num b) {
  return b.like(a) + b;
}
inline Num operator-(Num a, double b) {
  return a - a.like(b);
}
inline Num operator-(double a, Num b) {
  return b.like(a) - b;
}
inline Num operator*(Num a, double b) {
  return a * a.like(b);
}
inline Num operator*(double a, Num b) {
  return b.like(a) * b;
}
inline Num operator/(Num a, double b) {
  return a / a.like(b);
}
inline Num operator/(double a, Num b) {
  return b.like(a) / b;
}
inline Num operator&(Num a, std::int64_t b) {
  return a & a.like(static_cast<double>(b));
}
inline Num operator|(Num a, std::int64_t b) {
  return a | a.like(static_cast<double>(b));
}
inline Num operator^(Num a, std::int64_t b) {
  return a ^ a.like(static_cast<double>(b));
}
inline Num shiftLeft(Num a, int count) {
  return shiftLeft(a, a.like(count));
}
inline Num shiftRight(Num a, int count) {
  return shiftRight(a, a.like(count));
}
inline Num shiftRightSigned(Num a, int count) {
  return shiftRightSigned(a, a.like(count));
}

// Comparisons: false if an operand is NaN, except `notEqual`, which is then true.
Num less(Num a, Num b);
Num lessEqual(Num a, Num b);
Num equal(Num a, Num b);
Num notEqual(Num a, Num b);
Num lessUnsigned(Num a, Num b);
inline Num less(Num a, double b) {
  return less(a, a.like(b));
}
inline Num less(double a, Num b) {
  return less(b.like(a), b);
}
inline Num lessEqual(Num a, double b) {
  return lessEqual(a, a.like(b));
}
inline Num lessEqual(double a, Num b) {
  return lessEqual(b.like(a), b);
}
inline Num equal(Num a, double b) {
  return equal(a, a.like(b));
}
inline Num notEqual(Num a, double b) {
  return notEqual(a, a.like(b));
}

/// `condition ? a : b`, for each component if the condition is a vector.
Num select(Num condition, Num a, Num b);
inline Num select(Num condition, Num a, double b) {
  return select(condition, a, a.like(b));
}
inline Num select(Num condition, double a, Num b) {
  return select(condition, b.like(a), b);
}

// One IEEE operation each.
Num fma(Num a, Num b, Num c);
Num sqrt(Num a);
Num floor(Num a);
Num ceil(Num a);
Num trunc(Num a);
Num roundEven(Num a); // halves to the even neighbour
Num abs(Num a);       // integers too; the most negative integer stays

Num toInt(Num a);    // f32 -> i32: truncates and saturates, NaN gives 0
Num toFloat(Num a);  // signed
Num fromBool(Num a); // i32: 0 or 1

/// The value of a scalar integer, if it is a constant.
std::optional<std::int32_t> constantOf(Num value);

} // namespace rtsl::lowering
