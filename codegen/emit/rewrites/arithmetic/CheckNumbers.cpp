//===- CheckNumbers.cpp - where a number stops being finite ----------------===//
#include "codegen/emit/rewrites/arithmetic/CheckNumbers.h"

#include "codegen/emit/RuntimeFunctions.h"
#include "codegen/ir/SourcePlace.h"

#include "mlir/Dialect/LLVMIR/LLVMDialect.h"
#include "mlir/IR/BuiltinOps.h"

#include <map>
#include <tuple>

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;

namespace {

constexpr llvm::StringLiteral checkFunction = "rtsl_check_number";
constexpr llvm::StringLiteral checkStoredFunction = "rtsl_check_stored_number";

bool isFloat(mlir::Type type) {
  return mlir::getElementTypeOrSelf(type).isF32();
}

/// Whether an operation computes a number, rather than moving it. Functions of shaders are checked
/// inside.
bool computes(mlir::Operation *op) {
  if (op->getNumResults() != 1 || !isFloat(op->getResult(0).getType()))
    return false;
  if (auto call = llvm::dyn_cast<LLVM::CallOp>(op))
    return call.getCallee() && isRuntimeFunction(*call.getCallee());
  return llvm::isa<LLVM::FAddOp, LLVM::FSubOp, LLVM::FMulOp, LLVM::FDivOp, LLVM::FRemOp,
                   LLVM::FMAOp, LLVM::SqrtOp>(op);
}

class Checks {
public:
  Checks(mlir::ModuleOp module, std::vector<Place> &places)
      : module(module), places(places), builder(module.getContext()) {}

  void run() {
    llvm::SmallVector<mlir::Operation *> computed, stores;
    module.walk([&](mlir::Operation *op) {
      if (computes(op))
        computed.push_back(op);
      else if (auto store = llvm::dyn_cast<LLVM::StoreOp>(op);
               store && isFloat(store.getValue().getType()))
        stores.push_back(op);
    });
    if (computed.empty() && stores.empty())
      return;
    declare();
    for (mlir::Operation *op : stores)
      checkStore(llvm::cast<LLVM::StoreOp>(op));
    for (mlir::Operation *op : computed)
      checkResult(op);
  }

private:
  void declare() {
    builder.setInsertionPointToStart(module.getBody());
    const mlir::Type f32 = builder.getF32Type(), i32 = builder.getI32Type();
    LLVM::LLVMFuncOp::create(builder, module.getLoc(), checkFunction,
                             LLVM::LLVMFunctionType::get(f32, {f32, f32, f32, f32, i32}));
    LLVM::LLVMFuncOp::create(builder, module.getLoc(), checkStoredFunction,
                             LLVM::LLVMFunctionType::get(f32, {f32, i32}));
  }

  mlir::Value placeNumber(mlir::Location location) {
    const ir::SourcePlace place = ir::placeOf(location);
    const auto [known, isNew] =
        numbers.try_emplace(std::make_tuple(place.file, place.line, place.column), places.size());
    if (isNew)
      places.push_back({place.file, place.line, place.column, 1});
    return LLVM::ConstantOp::create(builder, location, builder.getI32Type(),
                                    builder.getI32IntegerAttr(static_cast<int32_t>(known->second)));
  }

  mlir::Value component(mlir::Location location, mlir::Value value, unsigned index) {
    if (!llvm::isa<mlir::VectorType>(value.getType()))
      return value;
    mlir::Value at =
        LLVM::ConstantOp::create(builder, location, builder.getI32Type(),
                                 builder.getI32IntegerAttr(static_cast<int32_t>(index)));
    return LLVM::ExtractElementOp::create(builder, location, value, at);
  }

  /// The value after `check`, a function of each of its components, of the same component of each
  /// of `sources`, and of the place.
  mlir::Value checked(mlir::Location location, llvm::StringRef check, mlir::Value value,
                      llvm::ArrayRef<mlir::Value> sources) {
    const mlir::Value place = placeNumber(location);
    const auto vector = llvm::dyn_cast<mlir::VectorType>(value.getType());
    const unsigned count = vector ? static_cast<unsigned>(vector.getNumElements()) : 1;
    mlir::Value result = value;
    for (unsigned i = 0; i < count; ++i) {
      llvm::SmallVector<mlir::Value> arguments = {component(location, value, i)};
      for (mlir::Value source : sources)
        arguments.push_back(component(location, source, i));
      arguments.push_back(place);
      mlir::Value after =
          LLVM::CallOp::create(builder, location, mlir::TypeRange{builder.getF32Type()}, check,
                               arguments)
              .getResult();
      if (!vector) {
        result = after;
        continue;
      }
      mlir::Value at = LLVM::ConstantOp::create(builder, location, builder.getI32Type(),
                                                builder.getI32IntegerAttr(static_cast<int32_t>(i)));
      result = LLVM::InsertElementOp::create(builder, location, result, after, at);
    }
    return result;
  }

  void checkStore(LLVM::StoreOp store) {
    builder.setInsertionPoint(store);
    store.getValueMutable().assign(
        checked(store.getLoc(), checkStoredFunction, store.getValue(), {}));
  }

  void checkResult(mlir::Operation *op) {
    builder.setInsertionPointAfter(op);
    mlir::Value value = op->getResult(0);
    llvm::SmallPtrSet<mlir::Operation *, 8> users(value.getUsers().begin(), value.getUsers().end());
    llvm::SmallVector<mlir::Value> sources;
    for (mlir::Value operand : op->getOperands())
      if (isFloat(operand.getType()) && sources.size() < 3)
        sources.push_back(operand);
    while (sources.size() < 3)
      sources.push_back(LLVM::ConstantOp::create(builder, op->getLoc(), builder.getF32Type(),
                                                 builder.getF32FloatAttr(0)));
    const mlir::Value after = checked(op->getLoc(), checkFunction, value, sources);
    value.replaceUsesWithIf(after,
                            [&](mlir::OpOperand &use) { return users.contains(use.getOwner()); });
  }

  mlir::ModuleOp module;
  std::vector<Place> &places;
  mlir::OpBuilder builder;
  std::map<std::tuple<std::string, std::uint32_t, std::uint32_t>, std::size_t> numbers;
};

} // namespace

void checkNumbers(mlir::ModuleOp module, std::vector<Place> &places) {
  Checks(module, places).run();
}

} // namespace rtsl::codegen
