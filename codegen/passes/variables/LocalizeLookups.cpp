#include "codegen/passes/variables/LocalizeLookups.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Lookups.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"
#include "mlir/Pass/Pass.h"
#include "llvm/ADT/MapVector.h"

namespace rtsl::codegen {

namespace {

using mlir::func::CallOp;
using mlir::func::FuncOp;

/// The functions that store results of a lookup in the state for their caller.
class Lookups {
public:
  explicit Lookups(mlir::ModuleOp module) : symbols(module) {}

  bool contains(CallOp call) {
    auto callee = symbols.lookup<FuncOp>(call.getCallee());
    return callee && ir::attr::inLookup.isOn(callee) && storeResults(callee);
  }

private:
  bool storeResults(FuncOp function) {
    const auto [entry, isNew] = known.try_emplace(function.getOperation(), false);
    if (!isNew) // complete, or that of a function that calls itself, whose other calls count
      return entry->second;
    const bool stores =
        function
            .walk([&](mlir::Operation *op) {
              auto state = llvm::dyn_cast<ir::StateOp>(op);
              auto call = llvm::dyn_cast<CallOp>(op);
              return (state && ir::isLookupResult(state.getName())) || (call && contains(call))
                         ? mlir::WalkResult::interrupt()
                         : mlir::WalkResult::advance();
            })
            .wasInterrupted();
    return known[function] = stores;
  }

  mlir::SymbolTable symbols;
  llvm::DenseMap<mlir::Operation *, bool> known;
};

void copyValue(mlir::OpBuilder &builder, mlir::Location location, mlir::Value from,
               mlir::Value to) {
  ir::StoreOp::create(builder, location, ir::LoadOp::create(builder, location, from), to);
}

void localize(FuncOp function, Lookups &lookups) {
  llvm::MapVector<mlir::StringAttr, mlir::Value> variables; // by the name of the state
  llvm::SmallVector<ir::StateOp> states;
  llvm::SmallVector<CallOp> calls;
  function.walk([&](mlir::Operation *op) {
    if (auto state = llvm::dyn_cast<ir::StateOp>(op)) {
      if (ir::isLookupResult(state.getName()))
        states.push_back(state);
    } else if (auto call = llvm::dyn_cast<CallOp>(op)) {
      if (lookups.contains(call))
        calls.push_back(call);
    }
  });

  mlir::Block &entry = function.getBody().front();
  for (ir::StateOp state : states) {
    mlir::Value &variable = variables[state.getNameAttr()];
    if (!variable) {
      mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(&entry);
      variable = ir::VarOp::create(builder, state.getLoc(), state.getName(),
                                   ir::pointee(state.getResult()));
    }
    state.getResult().replaceAllUsesWith(variable);
  }
  for (CallOp call : calls) {
    mlir::OpBuilder builder(call);
    for (const auto &[name, variable] : variables) {
      builder.setInsertionPoint(call);
      const mlir::Value state =
          ir::StateOp::create(builder, call.getLoc(), name.getValue(), ir::pointee(variable));
      copyValue(builder, call.getLoc(), variable, state);
      builder.setInsertionPointAfter(call);
      copyValue(builder, call.getLoc(), state, variable);
    }
  }
  for (ir::StateOp state : states)
    state.erase();
}

struct LocalizeLookups : mlir::PassWrapper<LocalizeLookups, mlir::OperationPass<mlir::ModuleOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(LocalizeLookups)
  llvm::StringRef getArgument() const override { return "rtsl-localize-lookups"; }
  llvm::StringRef getDescription() const override { return "results of lookups as variables"; }

  void runOnOperation() override {
    Lookups lookups(getOperation());
    for (auto function : getOperation().getOps<FuncOp>())
      if (!function.isExternal() && !ir::attr::inLookup.isOn(function))
        localize(function, lookups);
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createLocalizeLookupsPass() {
  return std::make_unique<LocalizeLookups>();
}

} // namespace rtsl::codegen
