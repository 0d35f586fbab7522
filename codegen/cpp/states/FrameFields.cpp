#include "codegen/cpp/states/FrameFields.h"

#include "codegen/cpp/states/values/ValueNames.h"
#include "codegen/passes/continuation/common/Names.h"

#include <algorithm>

namespace rtsl::cpp {

/// The first line that accesses the memory at an address.
static unsigned lineOfAccess(mlir::Value address, llvm::StringRef file) {
  unsigned line = 0;
  for (mlir::Operation *user : address.getUsers()) {
    const bool isPart = llvm::isa<ir::FieldOp, ir::ElementOp>(user);
    const unsigned at =
        isPart ? lineOfAccess(user->getResult(0), file) : lineOf(user->getLoc(), file);
    if (at != 0 && (line == 0 || at < line))
      line = at;
  }
  return line;
}

/// The first line that uses the loaded value.
static unsigned lineOfUse(ir::FrameLoadOp load, llvm::StringRef file) {
  unsigned line = 0;
  for (mlir::Operation *user : load->getUsers())
    if (unsigned at = lineOf(user->getLoc(), file); at != 0 && (line == 0 || at < line))
      line = at;
  return line;
}

/// Is the value an expression of the author's that has no name?
static bool hasNoName(mlir::Value value) {
  return llvm::isa_and_nonnull<ir::ExpressionOp, ir::EvaluateOp, ir::CallReturnedOp>(
             value.getDefiningOp()) &&
         continuation::authorsName(value).empty();
}

void collectFrame(Machine &machine, MethodPrinter &method, const std::set<std::string> &types) {
  ValueNames names(method.context, method.source, machine, method.functions);
  std::set<std::string> taken;
  if (machine.called) {
    taken.insert(machine.called->fields.begin(), machine.called->fields.end());
    taken.insert({"begin", machine.called->returned});
  }
  std::map<std::pair<std::string, bool>, std::size_t> fields; // in the frame
  auto field = [&](llvm::StringRef key, bool isObject = false,
                   mlir::Value value = {}) -> FrameField & {
    const auto [at, isNew] = fields.try_emplace({key.str(), isObject}, machine.frame.size());
    if (!isNew)
      return machine.frame[at->second];
    const bool isUnnamed = value && hasNoName(value);
    const std::string name = isUnnamed ? names.ofValue(value) : spelling(machine, key);
    FrameField &made = machine.frame.emplace_back();
    made.key = key.str();
    made.name = unique(name, taken, types);
    made.isTraced = made.isReturned = !isObject;
    made.isObject = isObject;
    made.isUnnamed = isUnnamed;
    return made;
  };
  for (mlir::func::FuncOp state : machine.states)
    state.walk([&](ir::FrameObjectOp object) {
      FrameField &saved = field(object.getName(), /*isObject=*/true);
      saved.type = method.types.of(object.getResult());
      saved.madeIn = lineOf(object.getLoc(), machine.file);
      const unsigned line = lineOfAccess(object, machine.file);
      if (state != machine.states.front() && line != 0 &&
          (saved.neededBy == 0 || line < saved.neededBy))
        saved.neededBy = line;
    });
  for (mlir::func::FuncOp state : machine.states) {
    state.walk([&](ir::FrameStoreOp store) {
      FrameField &saved = field(store.getName(), /*isObject=*/false, store.getValue());
      if (unsigned line = lineOf(store.getLoc(), machine.file); saved.madeIn == 0)
        saved.madeIn = line;
      saved.isTraced &= store.getValue().getDefiningOp<ir::TraceResultOp>() != nullptr;
      saved.isReturned &= store.getValue().getDefiningOp<ir::CallReturnedOp>() != nullptr;
    });
    state.walk([&](ir::FrameLoadOp load) {
      FrameField &saved = field(load.getName());
      if (unsigned line = lineOfUse(load, machine.file);
          line != 0 && (saved.neededBy == 0 || line < saved.neededBy))
        saved.neededBy = line;
    });
  }
  for (bool changed = true; changed;) { // a value may be loaded and saved again
    changed = false;
    for (mlir::func::FuncOp state : machine.states)
      state.walk([&](ir::FrameStoreOp store) {
        FrameField &saved = field(store.getName());
        if (saved.type)
          return;
        saved.type = method.types.of(store.getValue());
        changed |= saved.type != nullptr;
      });
  }
  auto name = [&](llvm::StringRef key, mlir::Type type) {
    if (FrameField &saved = field(key); !saved.type)
      saved.type = method.types.ofSaved(saved.key, type);
  };
  for (mlir::func::FuncOp state : machine.states) {
    state.walk([&](ir::FrameStoreOp store) { name(store.getName(), store.getValue().getType()); });
    state.walk([&](ir::FrameLoadOp load) { name(load.getName(), load.getType()); });
  }
  for (FrameField &saved : machine.frame)
    if (saved.neededBy == 0) // needed only by the called method
      saved.neededBy = saved.madeIn;
  std::stable_partition(machine.frame.begin(), machine.frame.end(), [](const FrameField &saved) {
    return !saved.type || !saved.type->is(TypeKind::Bool);
  });
}

} // namespace rtsl::cpp
