#include "codegen/passes/errors/DeriveHitErrors.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/Simplify.h"
#include "codegen/passes/errors/Planes.h"
#include "codegen/passes/variables/HoistVariables.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/Pass/PassManager.h"
#include "mlir/Transforms/Passes.h"
#include "llvm/ADT/SetVector.h"

namespace rtsl {

using mlir::func::FuncOp;
namespace arith = mlir::arith;
namespace math = mlir::math;
namespace vector = mlir::vector;

/// The given functions, and all that they call directly or indirectly.
static llvm::SetVector<mlir::Operation *> reachedFrom(llvm::ArrayRef<FuncOp> functions,
                                                      const mlir::SymbolTable &symbols) {
  llvm::SetVector<mlir::Operation *> reached(functions.begin(), functions.end());
  for (std::size_t i = 0; i < reached.size(); ++i)
    reached[i]->walk([&](mlir::func::CallOp call) {
      if (auto callee = symbols.lookup<FuncOp>(call.getCallee()))
        reached.insert(callee);
    });
  return reached;
}

llvm::SetVector<mlir::Operation *> functionsThatSendRays(mlir::ModuleOp ir,
                                                         const mlir::SymbolTable &symbols) {
  llvm::SetVector<mlir::Operation *> senders, throughReferences;
  llvm::DenseMap<mlir::Operation *, llvm::SmallVector<mlir::Operation *>> callers;
  for (auto function : ir.getOps<FuncOp>())
    function.walk([&](mlir::Operation *op) {
      if (ir::sendsRays(op))
        senders.insert(function);
      else if (llvm::isa<ir::CallMethodOp>(op))
        throughReferences.insert(function);
      else if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op))
        if (mlir::Operation *callee = symbols.lookup(call.getCallee()))
          callers[callee].push_back(function);
    });
  if (!senders.empty())
    senders.insert(throughReferences.begin(), throughReferences.end());
  for (std::size_t i = 0; i < senders.size(); ++i)
    for (mlir::Operation *caller : callers.lookup(senders[i]))
      senders.insert(caller);
  return senders;
}

/// Is it a number, a bool, or a vector of at most four?
static bool isPlain(mlir::Type type) {
  auto vector = llvm::dyn_cast<mlir::VectorType>(type);
  const mlir::Type scalar = vector ? vector.getElementType() : type;
  return (!vector || vector.getNumElements() <= 4) &&
         (scalar.isF32() || scalar.isF64() || scalar.isInteger(1) || scalar.isInteger(32) ||
          (!vector && scalar.isIndex()));
}

/// The first operation that the C++ printer does not support (codegen/cpp/errors); null if
/// there is none. Machine code omits the function then too, so that both have the same bounds.
static mlir::Operation *findNotShown(FuncOp function) {
  mlir::Operation *found = nullptr;
  function.walk([&](mlir::Operation *op) {
    bool isShown = llvm::all_of(op->getResultTypes(), [](mlir::Type type) {
      return llvm::isa<ir::PtrType>(type) || isPlain(type);
    });
    if (auto variable = llvm::dyn_cast<ir::VarOp>(op))
      isShown &= isPlain(llvm::cast<ir::PtrType>(variable.getType()).getPointee());
    if (auto table = llvm::dyn_cast<ir::TableOp>(op))
      isShown &= llvm::isa<ir::ArrayType>(llvm::cast<ir::PtrType>(table.getType()).getPointee());
    if (auto insert = llvm::dyn_cast<vector::InsertOp>(op))
      isShown &= !insert.hasDynamicPosition();
    const llvm::StringRef dialect = op->getName().getDialectNamespace();
    isShown &=
        dialect == "cf" || dialect == "func" || op->hasTrait<mlir::OpTrait::ConstantLike>() ||
        llvm::isa<arith::AddFOp, arith::SubFOp, arith::MulFOp, arith::DivFOp, arith::NegFOp,
                  arith::CmpFOp, arith::CmpIOp, arith::SelectOp, arith::AndIOp, arith::OrIOp,
                  arith::XOrIOp, arith::AddIOp, arith::SubIOp, arith::MulIOp, arith::SIToFPOp,
                  arith::UIToFPOp, arith::BitcastOp, arith::ExtFOp, arith::TruncFOp,
                  arith::IndexCastUIOp, arith::ExtUIOp, math::SqrtOp, math::FmaOp, math::AbsFOp,
                  math::FloorOp, math::CeilOp, math::TruncOp, math::RoundEvenOp, vector::ExtractOp,
                  vector::InsertOp, vector::FromElementsOp, vector::BroadcastOp, vector::ShuffleOp,
                  ir::ElementaryOp, ir::ToSintOp, ir::ToUintOp, ir::StateOp, ir::MemberOp,
                  ir::FieldOp, ir::ElementOp, ir::TableOp, ir::BufferElementOp, ir::BufferLengthOp,
                  ir::VarOp, ir::LoadOp, ir::StoreOp, ir::ClearOp, ir::HideOp>(op);
    if (!isShown && !found)
      found = op;
  });
  return found;
}

static void run(mlir::ModuleOp module, llvm::function_ref<void(mlir::OpPassManager &)> build) {
  mlir::PassManager passes(module.getContext());
#ifdef NDEBUG
  passes.enableVerifier(false);
#endif
  build(passes);
  if (mlir::failed(passes.run(module)))
    llvm::report_fatal_error("the passes that bound errors have failed");
}

std::vector<DerivedHitError> deriveHitErrors(mlir::ModuleOp ir, mlir::SymbolTable &symbols,
                                             const std::vector<std::string> &classes,
                                             ElementaryErrors elementary) {
  llvm::SmallVector<FuncOp> originals, methods;
  for (const std::string &name : classes)
    if (auto intersect = symbols.lookup<FuncOp>(name + ".intersect");
        intersect && !intersect.isExternal())
      originals.push_back(intersect);
  if (originals.empty())
    return {};
  // A copy of `intersect`, its callees and the classes, which is lowered to level 2.
  mlir::OwningOpRef<mlir::ModuleOp> copy = mlir::ModuleOp::create(ir.getLoc());
  for (auto record : ir.getOps<ir::ClassOp>())
    copy->push_back(record->clone());
  for (mlir::Operation *function : reachedFrom(originals, symbols)) { // these come first
    mlir::Operation *clone = function->clone();
    copy->push_back(clone);
    if (methods.size() < originals.size())
      methods.push_back(llvm::cast<FuncOp>(clone));
  }
  run(*copy, codegen::buildPlainPipeline);

  std::vector<DerivedHitError> derived;
  for (FuncOp method : methods) {
    DerivedHitError &one = derived.emplace_back();
    one.className = ir::attr::className.of(method).str();
    one.isPlane = isOfPlane(method);
    one.hasFunction = boundHitError(method, elementary, one.unbound);
    ir::attr::methodName.removeFrom(method);
    ir::attr::hitError.set(method);
    method.setName(one.className + "." + hitErrorMethod.str());
  }
  for (auto function : llvm::make_early_inc_range(copy->getOps<FuncOp>()))
    if (!ir::attr::hitError.isOn(function))
      function.erase();
  run(*copy, [](mlir::OpPassManager &module) {
    auto &functions = module.nest<FuncOp>();
    functions.addPass(mlir::createMem2Reg());
    functions.addPass(codegen::createSimplifyPass());
  });
  for (auto [one, method] : llvm::zip(derived, methods)) {
    if (mlir::Operation *notShown = one.hasFunction ? findNotShown(method) : nullptr) {
      one.hasFunction = false;
      one.unbound.push_back(
          {notShown->getLoc(), "it depends on an operation that the compiler does not analyse"});
    }
    if (one.hasFunction) {
      method->remove();
      symbols.insert(method);
    }
  }
  return derived;
}

} // namespace rtsl
