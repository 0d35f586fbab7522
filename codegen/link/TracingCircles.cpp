//===- TracingCircles.cpp - functions that trace and call themselves ------===//
//
// Through references a function may call itself on another object: a coat on a coat. If it traces, splitting would have to
// give each such call a frame of its own, which it cannot do yet.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/DenseSet.h"

namespace rtsl {

namespace {

using mlir::func::FuncOp;

class CircleFinder {
public:
  explicit CircleFinder(mlir::ModuleOp ir) : symbols(ir) {
    for (FuncOp function : ir.getOps<FuncOp>())
      function.walk([&](mlir::func::CallOp call) {
        if (auto callee = symbols.lookup<FuncOp>(call.getCallee()))
          callees[function].push_back(callee);
      });
  }

  /// A function that traces, itself or through what it calls, and that calls lead back to; preferably one of the author's.
  FuncOp find(mlir::ModuleOp ir) {
    FuncOp found;
    for (FuncOp function : ir.getOps<FuncOp>())
      if (reaches(function, [&](FuncOp at) { return at == function; }) && mayTrace(function) &&
          (!found || !found->hasAttr("rtsl.class")))
        found = function;
    return found;
  }

private:
  static bool traces(FuncOp function) {
    return function
        .walk([](mlir::Operation *op) {
          return llvm::isa<ir::TraceOp, ir::TracePayloadOp>(op) ? mlir::WalkResult::interrupt()
                                                                : mlir::WalkResult::advance();
        })
        .wasInterrupted();
  }
  bool mayTrace(FuncOp function) { return traces(function) || reaches(function, traces); }

  /// Whether calls lead from `from` to a function for which `isIt` holds.
  bool reaches(FuncOp from, llvm::function_ref<bool(FuncOp)> isIt) {
    llvm::DenseSet<mlir::Operation *> seen;
    llvm::SmallVector<FuncOp> pending(callees[from]);
    while (!pending.empty()) {
      FuncOp at = pending.pop_back_val();
      if (isIt(at))
        return true;
      if (seen.insert(at).second)
        pending.append(callees[at]);
    }
    return false;
  }

  mlir::SymbolTable symbols;
  llvm::DenseMap<mlir::Operation *, llvm::SmallVector<FuncOp>> callees;
};

} // namespace

bool refuseTracingCircles(mlir::ModuleOp ir, const typed::Module &module, Diagnostics &diagnostics) {
  FuncOp function = CircleFinder(ir).find(ir);
  if (!function)
    return true;
  auto className = function->getAttrOfType<mlir::StringAttr>("rtsl.class");
  auto method = function->getAttrOfType<mlir::StringAttr>("rtsl.method");
  const std::string name = method ? method.str() : function.getSymName().str();
  const typed::Class *owner = className ? module.findClass(className.str()) : nullptr;
  SourceRange range;
  for (const typed::Class *at = owner; at && !range.isValid(); at = at->base)
    for (const auto &candidate : at->functions)
      if (candidate->name == llvm::StringRef(name).split('.').first)
        range = candidate->range;
  diagnostics.report(Code::tracingCircle, range, name, owner ? owner->name : std::string("?"))
      .note("`--trace=recurse` can: there every call has its place on the stack");
  return false;
}

} // namespace rtsl
