//===- Library.cpp - helper functions made on demand ----------------------===//
#include "codegen/formulas/Library.h"

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

mlir::func::FuncOp Library::define(const std::string &symbol, mlir::FunctionType type,
                                   const std::function<void(Emitter &, mlir::ValueRange)> &body) {
  auto [place, isNew] = functions.try_emplace(symbol);
  if (!isNew)
    return place->second;
  Emitter emitter(module.getContext());
  emitter.setLoc(mlir::NameLoc::get(emitter.getStringAttr(symbol)));
  emitter.setInsertionPointToEnd(module.getBody());
  auto function = emitter.make<mlir::func::FuncOp>(symbol, type);
  function.setPrivate();
  // std::map keeps its nodes: the body may define further functions.
  place->second = function;
  emitter.setInsertionPointToStart(function.addEntryBlock());
  body(emitter, function.getArguments());
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

llvm::SmallVector<Num, 2> Library::call(const std::string &name, llvm::ArrayRef<Num> arguments,
                                        llvm::ArrayRef<mlir::Type> results, const Body &body) {
  Emitter &emitter = arguments.front().at();
  auto function = define("rtsl." + name + "." + typeWord(arguments.front().type()),
                         emitter.getFunctionType(typesOf(arguments), results),
                         [&](Emitter &inner, mlir::ValueRange values) {
                           llvm::SmallVector<Num, 4> parameters;
                           for (Value value : values)
                             parameters.push_back({inner, value});
                           inner.returnValues(valuesOf(body(parameters)));
                         });
  auto call = emitter.make<mlir::func::CallOp>(function, valuesOf(arguments));
  llvm::SmallVector<Num, 2> values;
  for (Value value : call.getResults())
    values.push_back({emitter, value});
  return values;
}

Num Library::callOne(const std::string &name, llvm::ArrayRef<Num> arguments, mlir::Type result,
                     const std::function<Num(llvm::ArrayRef<Num>)> &body) {
  return call(name, arguments, result,
              [&](llvm::ArrayRef<Num> parameters) {
                return llvm::SmallVector<Num, 2>{body(parameters)};
              })
      .front();
}

//===----------------------------------------------------------------------===//
// Matrices live in memory where a function begins or ends
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

Columns Library::callMatrix(const std::string &name, const Columns &m, const MatrixBody &body) {
  Emitter &emitter = m.front().at();
  ir::ArrayType type = matrixType(m);
  auto pointer = ir::PtrType::get(type);
  auto count = static_cast<unsigned>(m.size());
  auto function =
      define("rtsl." + name + "." + matrixWord(m), emitter.getFunctionType({pointer, pointer}, {}),
             [&](Emitter &inner, mlir::ValueRange values) {
               storeColumns(inner, body(loadColumns(inner, values[1], count)), values[0]);
               inner.returnValues({});
             });
  Value argument = emitter.variable("matrix", type);
  storeColumns(emitter, m, argument);
  Value result = emitter.variable(name, type);
  emitter.make<mlir::func::CallOp>(function, mlir::ValueRange{result, argument});
  return loadColumns(emitter, result, count);
}

Num Library::callMatrixToScalar(const std::string &name, const Columns &m,
                                const std::function<Num(const Columns &)> &body) {
  Emitter &emitter = m.front().at();
  ir::ArrayType type = matrixType(m);
  auto count = static_cast<unsigned>(m.size());
  auto function = define("rtsl." + name + "." + matrixWord(m),
                         emitter.getFunctionType({ir::PtrType::get(type)}, {emitter.getF32Type()}),
                         [&](Emitter &inner, mlir::ValueRange values) {
                           Value result = body(loadColumns(inner, values[0], count));
                           inner.returnValues(result);
                         });
  Value argument = emitter.variable("matrix", type);
  storeColumns(emitter, m, argument);
  auto call = emitter.make<mlir::func::CallOp>(function, argument);
  return {emitter, call.getResult(0)};
}

} // namespace rtsl::lowering
