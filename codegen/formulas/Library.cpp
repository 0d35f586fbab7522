//===- Library.cpp - functions for formulas, and operations on numbers ----===//
#include "codegen/formulas/Library.h"

#include "codegen/ir/NamedLocation.h"
#include "codegen/ir/Rtsl.h"

namespace rtsl::lowering {

std::string typeWord(mlir::Type type) {
  mlir::Type scalar = scalarType(type);
  std::string prefix = scalar.isF32() ? "" : scalar.isInteger(1) ? "b" : "i";
  unsigned width = vectorWidth(type);
  if (width == 0)
    return scalar.isF32() ? "float" : scalar.isInteger(1) ? "bool" : "int";
  if (width >= 2 && width <= 4)
    return prefix + "vec" + std::to_string(width);
  return (scalar.isF32() ? "float" : prefix + "vec") + std::to_string(width); // a color
}

// The body may change the result type of the function.
mlir::func::FuncOp Library::define(const std::string &symbol, mlir::FunctionType type, Body body) {
  auto [place, isNew] = functions.try_emplace(symbol);
  if (!isNew)
    return place->second;
  Emitter emitter(module.getContext());
  emitter.library = this;
  emitter.setLoc(ir::builtinLocation(module.getContext(), symbol));
  emitter.setInsertionPointToEnd(module.getBody());
  auto function = emitter.make<mlir::func::FuncOp>(symbol, type);
  function.setPrivate();
  // std::map keeps its nodes: the body may define further functions.
  place->second = function;
  emitter.setInsertionPointToStart(function.addEntryBlock());
  body(emitter, function);
  eraseUnused(function.getBody());
  return function;
}

static llvm::SmallVector<mlir::Type, 4> typesOf(llvm::ArrayRef<Num> values) {
  llvm::SmallVector<mlir::Type, 4> types;
  for (Num value : values)
    types.push_back(value.type());
  return types;
}

template <typename Values>
static llvm::SmallVector<Value, 4> valuesOf(const Values &nums) {
  return llvm::SmallVector<Value, 4>(nums.begin(), nums.end());
}

Library::Numbers Library::call(const std::string &name, const Numbers &arguments,
                               llvm::function_ref<Numbers(const Numbers &)> body) {
  Emitter &emitter = arguments.front().at();
  auto function = define("rtsl." + name + "." + typeWord(arguments.front().type()),
                         emitter.getFunctionType(typesOf(arguments), {}),
                         [&](Emitter &inner, mlir::func::FuncOp function) {
                           Numbers parameters;
                           for (Value value : function.getArguments())
                             parameters.push_back({inner, value});
                           const Numbers results = body(parameters);
                           function.setFunctionType(
                               inner.getFunctionType(typesOf(arguments), typesOf(results)));
                           inner.returnValues(valuesOf(results));
                         });
  auto call = emitter.make<mlir::func::CallOp>(function, valuesOf(arguments));
  Numbers values;
  for (Value value : call.getResults())
    values.push_back({emitter, value});
  return values;
}

//===----------------------------------------------------------------------===//
// Matrices are passed and returned in memory
//===----------------------------------------------------------------------===//

static ir::ArrayType matrixType(const Columns &m) {
  return ir::ArrayType::get(static_cast<unsigned>(m.size()), m.front().type());
}

static std::string matrixWord(const Columns &m) {
  std::size_t columns = m.size();
  unsigned rows = m.front().width();
  std::string word = "mat" + std::to_string(columns);
  return columns == rows ? word : word + "x" + std::to_string(rows);
}

static Columns loadColumns(Emitter &emitter, Value address, unsigned count) {
  Columns columns;
  for (unsigned i = 0; i < count; ++i)
    columns.push_back({emitter, emitter.load(emitter.element(address, i))});
  return columns;
}

static void storeColumns(Emitter &emitter, const Columns &columns, Value address) {
  for (unsigned i = 0; i < columns.size(); ++i)
    emitter.store(columns[i], emitter.element(address, i));
}

Columns Library::callMatrix(const std::string &name, const Columns &m,
                            llvm::function_ref<Columns(const Columns &)> body) {
  Emitter &emitter = m.front().at();
  ir::ArrayType type = matrixType(m);
  auto pointer = ir::PtrType::get(type);
  auto count = static_cast<unsigned>(m.size());
  auto function =
      define("rtsl." + name + "." + matrixWord(m), emitter.getFunctionType({pointer, pointer}, {}),
             [&](Emitter &inner, mlir::func::FuncOp function) {
               storeColumns(inner, body(loadColumns(inner, function.getArgument(1), count)),
                            function.getArgument(0));
               inner.returnValues({});
             });
  Value argument = emitter.variable("matrix", type);
  storeColumns(emitter, m, argument);
  Value result = emitter.variable(name, type);
  emitter.make<mlir::func::CallOp>(function, mlir::ValueRange{result, argument});
  return loadColumns(emitter, result, count);
}

Num Library::callMatrixToScalar(const std::string &name, const Columns &m,
                                llvm::function_ref<Num(const Columns &)> body) {
  Emitter &emitter = m.front().at();
  ir::ArrayType type = matrixType(m);
  auto count = static_cast<unsigned>(m.size());
  auto function = define("rtsl." + name + "." + matrixWord(m),
                         emitter.getFunctionType({ir::PtrType::get(type)}, {emitter.getF32Type()}),
                         [&](Emitter &inner, mlir::func::FuncOp function) {
                           Value result = body(loadColumns(inner, function.getArgument(0), count));
                           inner.returnValues(result);
                         });
  Value argument = emitter.variable("matrix", type);
  storeColumns(emitter, m, argument);
  auto call = emitter.make<mlir::func::CallOp>(function, argument);
  return {emitter, call.getResult(0)};
}

//===----------------------------------------------------------------------===//
// Functions that are a single operation of the IR
//===----------------------------------------------------------------------===//

static ir::Elementary operationOf(formulas::Elementary function) {
  switch (function) {
#define RTSL_ELEMENTARY_UNARY(Id, name)                                                            \
  case formulas::Elementary::Id:                                                                   \
    return ir::Elementary::Id;
#define RTSL_ELEMENTARY_BINARY RTSL_ELEMENTARY_UNARY
#include "math/ElementaryFunctions.def"
  }
  llvm_unreachable("no elementary function of this number of operands");
}

Num elementary(formulas::Elementary function, Num x) {
  Value operand = x;
  return {x.at(), x.at().make<ir::ElementaryOp>(x.type(), operationOf(function), operand)};
}

// `pow(color, float)`: a scalar operand applies to every component.
Num elementary(formulas::Elementary function, Num x, Num y) {
  if (y.width() == 0 && x.width() != 0)
    y = y.splat(x.width());
  const Value operands[] = {x, y};
  return {x.at(), x.at().make<ir::ElementaryOp>(x.type(), operationOf(function), operands)};
}

Num refract(Num i, Num n, Num eta) {
  Value incident = i, normal = n, index = eta;
  return {i.at(), i.at().fold<ir::RefractOp>(i.type(), incident, normal, index)};
}

void multiplyExtended(Num x, Num y, formulas::IntegerSign sign, Num &high, Num &low) {
  Emitter &emitter = x.at();
  Value a = x, b = y;
  mlir::Operation *product;
  if (sign == formulas::IntegerSign::Unsigned)
    product = emitter.make<mlir::arith::MulUIExtendedOp>(a, b);
  else
    product = emitter.make<mlir::arith::MulSIExtendedOp>(a, b);
  high = {emitter, product->getResult(1)};
  low = {emitter, product->getResult(0)};
}

} // namespace rtsl::lowering
