//===- Library.h - what the built-in functions compute --------------------===//
//
// The built-in functions as formulas over IR, apart from the syntax tree. Each operation is one
// IEEE single operation in the order written; only where `fma` stands are two fused. What is short
// is emitted in place. What is long, or has a rare path, becomes a private function of the module,
// `@rtsl.normalize.vec3`, made when it is first needed.
//
// Errors that are stated are in ulp of the result, for results that are neither subnormal nor too
// large.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/formulas/Emitter.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

#include <functional>
#include <map>
#include <string>

namespace rtsl::lowering {

/// A matrix: its columns.
using Columns = llvm::SmallVector<Num, 4>;

class Library {
public:
  explicit Library(mlir::ModuleOp module) : module(module) {}

  // LibraryGeometry.cpp
  Num length(Num v);
  Num normalize(Num v);
  Num perpendicularTo(Num v);

  // LibraryCommon.cpp
  Num powInt(Num x, Num exponent); // exponent: a scalar
  Num frexp(Num x, Num &exponent);
  Num ldexp(Num x, Num exponent);

  // LibraryMatrix.cpp
  Num determinant(const Columns &m);
  Columns inverse(const Columns &m);

  // LibraryInteger.cpp
  Num bitCount(Num x);
  Num bitfieldReverse(Num x);
  Num findLSB(Num x);
  Num findMSB(Num x, bool isSigned);

  // LibraryPacking.cpp
  Num halfFromFloat(Num x); // f32 -> the 16 bits of a half in an i32
  Num floatFromHalf(Num bits);

  using Body = std::function<llvm::SmallVector<Num, 2>(llvm::ArrayRef<Num> arguments)>;
  using MatrixBody = std::function<Columns(const Columns &)>;

private:
  /// Calls `@rtsl.<name>.<type of the first argument>`, made with `body` if it is not there yet.
  llvm::SmallVector<Num, 2> call(const std::string &name, llvm::ArrayRef<Num> arguments,
                                 llvm::ArrayRef<mlir::Type> results, const Body &body);
  Num callOne(const std::string &name, llvm::ArrayRef<Num> arguments, mlir::Type result,
              const std::function<Num(llvm::ArrayRef<Num>)> &body);
  Columns callMatrix(const std::string &name, const Columns &m, const MatrixBody &body);
  Num callMatrixToScalar(const std::string &name, const Columns &m,
                         const std::function<Num(const Columns &)> &body);
  mlir::func::FuncOp define(const std::string &symbol, mlir::FunctionType type,
                            const std::function<void(Emitter &, mlir::ValueRange)> &body);

  mlir::ModuleOp module;
  std::map<std::string, mlir::func::FuncOp> functions;
};

/// `float`, `ivec2`, `vec3`, `float16`: how helper functions call a type.
std::string typeWord(mlir::Type type);

// Of two numbers; the operands' shapes may differ as for operators.
Num minimum(Num x, Num y); // y < x ? y : x
Num maximum(Num x, Num y); // x < y ? y : x
Num minimumUnsigned(Num x, Num y);
Num maximumUnsigned(Num x, Num y);
Num clamp(Num x, Num low, Num high); // min(max(x, low), high)
Num mix(Num a, Num b, Num t);        // a*(1-t) + b*t
Num step(Num edge, Num x);           // x < edge ? 0 : 1
Num smoothstep(Num edge0, Num edge1, Num x);
Num sign(Num x);             // of zero: itself; of NaN: NaN
Num fract(Num x);            // x - floor(x); 1 for a tiny negative x
Num mod(Num x, Num y);       // x - y*floor(x/y)
Num modf(Num x, Num &whole); // both have the sign of x; the fraction of an infinity is 0
Num copySign(Num magnitude, Num sign);
Num isNan(Num x);
Num isInf(Num x);

/// `choose(c, a, b)`: evaluates only the one that is needed.
Num choose(Num condition, mlir::Type type, const std::function<Num()> &whenTrue,
           const std::function<Num()> &whenFalse);

Num minComponent(Num v); // from the first component on
Num maxComponent(Num v);
Num dominantAxis(Num v); // i32
Num inside(Num x, Num low, Num high);

Num dot(Num a, Num b); // ((x x' + y y') + z z') + w w', each operation rounded
Num cross(Num a, Num b);
Num faceforward(Num n, Num i, Num reference);
Num reflect(Num i, Num n); // i - (2 dot(n, i)) n
/// a b - c d within 1.5 ulp, and exactly 0 for a b == c d: Kahan's algorithm, analysed by
/// Jeannerod, Louvet and Muller, "Further analysis of Kahan's algorithm for the accurate
/// computation of 2 x 2 determinants" (2013).
Num differenceOfProducts(Num a, Num b, Num c, Num d);

Columns transpose(const Columns &m);
Columns outerProduct(Num column, Num row);
Num multiply(const Columns &m, Num v); // sums from the first column on
Num multiply(Num v, const Columns &m); // dot(v, column)
Columns multiply(const Columns &a, const Columns &b);

Num bitfieldExtract(Num value, Num offset, Num bits, bool isSigned);
Num bitfieldInsert(Num base, Num insert, Num offset, Num bits);

} // namespace rtsl::lowering
