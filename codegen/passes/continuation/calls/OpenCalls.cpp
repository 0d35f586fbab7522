//===- OpenCalls.cpp - calls through references without a scene -----------===//
//
//   rtsl.call_method "follow" on %f(%d)
//       ==>   func.call @dispatch.Filter.follow(%f, %d) {rtsl.framed}
//
// where some class derived from Filter has a `follow` that may trace. The callee is known only for
// a scene, so `@dispatch.Filter.follow` is only declared, under the first class that has the
// method; the C++ output (codegen/cpp) dispatches there. The methods that it may call get frames of
// their own. The declaration lists the state variables that they may write, `rtsl.writes`, because
// callers are split before them.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/common/Recompute.h"

#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/SetVector.h"

#include <map>

namespace rtsl::continuation {

namespace {

class OpenCalls {
public:
  explicit OpenCalls(mlir::ModuleOp module) : module(module), symbols(module) {}
  void run();

private:
  ir::ClassOp baseClass(ir::ClassOp definition);
  bool isBelow(ir::ClassOp derived, llvm::StringRef base);
  llvm::SmallVector<FuncOp> targets(llvm::StringRef base, llvm::StringRef method);
  std::string firstWith(llvm::StringRef className, llvm::StringRef method);
  void replace(ir::CallMethodOp call, llvm::ArrayRef<FuncOp> mayRun);
  void giveFrame(FuncOp method);
  void summariseWrites();

  mlir::ModuleOp module;
  mlir::SymbolTable symbols;
  llvm::SmallSetVector<mlir::Operation *, 8>
      framed; // methods that calls through references may run
  std::map<std::pair<std::string, std::string>, FuncOp> declared; // by class and method
  // declared dispatch functions and their possible callees
  llvm::SmallVector<std::pair<FuncOp, llvm::SmallVector<FuncOp>>> declarations;
};

/// The base class in the source, or null.
ir::ClassOp OpenCalls::baseClass(ir::ClassOp definition) {
  return definition.getBase() ? symbols.lookup<ir::ClassOp>(*definition.getBase()) : ir::ClassOp();
}

bool OpenCalls::isBelow(ir::ClassOp derived, llvm::StringRef base) {
  if (derived.getRoot() == base)
    return true;
  for (ir::ClassOp at = derived; at; at = baseClass(at))
    if (at.getSymName() == base)
      return true;
  return false;
}

llvm::SmallVector<FuncOp> OpenCalls::targets(llvm::StringRef base, llvm::StringRef method) {
  llvm::SmallVector<FuncOp> found;
  for (ir::ClassOp definition : module.getOps<ir::ClassOp>())
    if (isBelow(definition, base))
      if (auto function = symbols.lookup<FuncOp>((definition.getSymName() + "." + method).str()))
        found.push_back(function);
  return found;
}

static llvm::StringRef baseOf(ir::CallMethodOp call) {
  return llvm::cast<ir::RefType>(call.getObject().getType()).getClassName();
}

/// Does the method run as states? Lowering marks all methods that may trace
/// (typed::Function::sends).
static bool runsAsStates(FuncOp method) {
  return ir::attr::states.isOn(method);
}

/// The class that has the method and whose base does not.
std::string OpenCalls::firstWith(llvm::StringRef className, llvm::StringRef method) {
  auto definition = symbols.lookup<ir::ClassOp>(className);
  if (!definition) // a class of the language
    return className.str();
  for (ir::ClassOp base = baseClass(definition);
       base && symbols.lookup((base.getSymName() + "." + method).str()); base = baseClass(base))
    definition = base;
  return definition.getSymName().str();
}

/// Calls of the method on the caller's own object need no frame: for these the method is kept
/// unchanged, and a copy gets the frame.
void OpenCalls::giveFrame(FuncOp method) {
  if (!framed.insert(method))
    return;
  const bool isCalled = !mlir::SymbolTable::symbolKnownUseEmpty(method, module);
  FuncOp twin = method;
  if (isCalled) {
    twin = method.clone();
    twin.setSymName((method.getSymName() + ".framed").str());
    symbols.insert(twin, std::next(method->getIterator()));
  }
  ir::attr::framed.set(twin);
  ir::attr::noinline.set(twin);
}

void OpenCalls::replace(ir::CallMethodOp call, llvm::ArrayRef<FuncOp> mayRun) {
  const std::string base = firstWith(baseOf(call), call.getMethod());
  mlir::OpBuilder builder(call);
  mlir::Value object = call.getObject();
  const mlir::Type type = ir::RefType::get(module.getContext(), base);
  if (object.getType() != type)
    object = ir::CastRefOp::create(builder, call.getLoc(), type, object);
  llvm::SmallVector<mlir::Value> arguments = {object};
  llvm::append_range(arguments, call.getArguments());
  FuncOp &declaration = declared[{base, call.getMethod().str()}];
  if (!declaration) {
    declaration = FuncOp::create(
        call.getLoc(), "dispatch." + base + "." + call.getMethod().str(),
        builder.getFunctionType(mlir::ValueRange(arguments).getTypes(), call.getResultTypes()));
    declaration.setPrivate();
    ir::attr::dispatch.set(declaration);
    ir::attr::className.set(declaration, builder.getStringAttr(base));
    ir::attr::methodName.set(declaration, call.getMethodAttr());
    symbols.insert(declaration);
    declarations.push_back({declaration, {}});
  }
  for (auto &[known, callees] : declarations)
    if (known == declaration)
      for (FuncOp target : mayRun)
        if (!llvm::is_contained(callees, target))
          callees.push_back(target);
  auto framedCall = mlir::func::CallOp::create(builder, call.getLoc(), declaration, arguments);
  ir::attr::framed.set(framedCall);
  call.replaceAllUsesWith(framedCall.getResults());
  call.erase();
}

/// One may call another: iterates until nothing changes.
void OpenCalls::summariseWrites() {
  mlir::OpBuilder builder(module.getContext());
  for (auto &entry : declarations)
    ir::attr::writes.set(entry.first, builder.getArrayAttr({}));
  bool changed = true;
  while (changed) {
    changed = false;
    const WriteSummary summary(module);
    for (auto &[declaration, callees] : declarations) {
      StateWrites writes;
      for (FuncOp target : callees)
        writes.add(summary.ofFunction(target));
      const mlir::Attribute before = ir::attr::writes.of(declaration);
      if (writes.any) {
        ir::attr::writes.removeFrom(declaration);
      } else {
        llvm::SmallVector<llvm::StringRef> names(writes.names.keys());
        llvm::sort(names);
        ir::attr::writes.set(declaration, builder.getStrArrayAttr(names));
      }
      changed |= ir::attr::writes.of(declaration) != before;
    }
  }
}

void OpenCalls::run() {
  llvm::SmallVector<ir::CallMethodOp> calls;
  module.walk([&](ir::CallMethodOp call) { calls.push_back(call); });
  for (ir::CallMethodOp call : calls) {
    const llvm::SmallVector<FuncOp> mayRun = targets(baseOf(call), call.getMethod());
    if (llvm::any_of(mayRun, runsAsStates))
      replace(call, mayRun);
  }
  summariseWrites();
  for (auto &[declaration, callees] : declarations)
    for (FuncOp target : callees)
      if (runsAsStates(target))
        giveFrame(target);
}

} // namespace

void callThroughFrames(mlir::ModuleOp module) {
  OpenCalls(module).run();
}

} // namespace rtsl::continuation
