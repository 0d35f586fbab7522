//===- EndlessRays.cpp - rays that nothing but the limit of depth ends ----===//
//
// A shader that always traces, whatever it finds, is no mistake where other materials end its rays.
// Where every material of a scene that answers a kind of rays sends another of that kind on each
// way through its program, only a ray that misses everything ends by itself: each sample may run to
// the limit of depth, and that is worth a warning.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "llvm/ADT/DenseMap.h"

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// Ways out of a piece of code on which no such ray has been sent.
struct Untraced {
  bool end = false, returns = false, breaks = false, continues = false;
};

class AlwaysTraces {
public:
  /// For rays with this payload; null: rays for a color.
  AlwaysTraces(const mlir::SymbolTable &symbols, mlir::Type payload)
      : symbols(symbols), payload(payload) {}

  bool operator()(FuncOp function) {
    // false while it is being asked
    const auto [known, isNew] = answers.try_emplace(function, false);
    if (!isNew || function.isExternal())
      return known->second;
    const Untraced ways = walk(function.getBody());
    return answers[function] = !ways.end && !ways.returns;
  }

private:
  bool sends(mlir::Operation &op) {
    if (llvm::isa<ir::TraceOp>(op))
      return !payload;
    if (auto trace = llvm::dyn_cast<ir::TracePayloadOp>(op))
      return payload &&
             llvm::cast<ir::PtrType>(trace.getPayload().getType()).getPointee() == payload;
    if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op))
      if (auto callee = symbols.lookup<FuncOp>(call.getCallee()))
        return (*this)(callee);
    return false;
  }

  Untraced walk(mlir::Region &region) {
    Untraced ways;
    if (region.empty()) {
      ways.end = true;
      return ways;
    }
    for (mlir::Operation &op : region.front()) {
      if (sends(op))
        return ways;
      if (llvm::isa<ir::YieldOp, ir::ConditionOp>(op))
        ways.end = true;
      else if (llvm::isa<ir::ReturnOp>(op))
        ways.returns = true;
      else if (llvm::isa<ir::BreakOp>(op))
        ways.breaks = true;
      else if (llvm::isa<ir::ContinueOp>(op))
        ways.continues = true;
      else if (op.getNumRegions() != 0 && !passes(op, ways))
        return ways;
    }
    return ways;
  }

  /// Adds what leaves `op` for elsewhere. Whether some way leads behind it.
  bool passes(mlir::Operation &op, Untraced &ways) {
    auto add = [&](const Untraced &inner, bool isLoop) {
      ways.returns |= inner.returns;
      if (!isLoop) {
        ways.breaks |= inner.breaks;
        ways.continues |= inner.continues;
      }
    };
    if (auto choice = llvm::dyn_cast<ir::IfOp>(op)) {
      const Untraced then = walk(choice.getThenRegion()), otherwise = walk(choice.getElseRegion());
      add(then, false);
      add(otherwise, false);
      return then.end || otherwise.end;
    }
    if (auto loop = llvm::dyn_cast<ir::LoopOp>(op)) {
      const Untraced body = walk(loop.getBody());
      add(body, true);
      if (loop.getPostTest())
        return body.end || body.continues || body.breaks;
      if (loop.getCondition().empty())
        return body.breaks;
      return walk(loop.getCondition()).end || body.breaks; // it may run no turn
    }
    // Lights, and cases: there may be none.
    const bool isSwitch = llvm::isa<ir::SwitchOp>(op);
    for (mlir::Region &region : op.getRegions()) {
      Untraced inner = walk(region);
      if (isSwitch)
        inner.breaks = false;
      add(inner, !isSwitch);
    }
    return true;
  }

  const mlir::SymbolTable &symbols;
  mlir::Type payload;
  llvm::DenseMap<mlir::Operation *, bool> answers;
};

void check(LinkContext &context, const std::string &method, mlir::Type payload,
           const std::string &what) {
  AlwaysTraces alwaysTraces(context.symbols, payload);
  std::string names;
  SourceRange range;
  for (const LinkedClass &linked : context.classes) {
    if (linked.info->root != "rt_Material" || !linked.hasObjects || !linked.isUsed)
      continue;
    FuncOp program = findMethod(context, linked, method);
    if (!program || !alwaysTraces(program))
      return;
    names += (names.empty() ? "`" : ", `") + linked.info->name + "`";
    if (!range.isValid())
      range = linked.info->range;
  }
  if (names.empty())
    return;
  context.diagnostics
      .report(Code::sceneWarning, range,
              "each material of this scene sends another " + what + " whatever it finds: " + names)
      .note("only the limit of depth ends such rays, or what misses everything; end some of them "
            "by chance (`rand`), where "
            "their weight is small, or by `rt_Depth`");
}

} // namespace

void warnOfEndlessRays(LinkContext &context) {
  check(context, "shade", {}, "ray");
  for (const RayType &type : context.rayTypes)
    check(context, "closestHit." + type.name(), type.payload, "ray with a `" + type.name() + "`");
}

} // namespace rtsl::linking
