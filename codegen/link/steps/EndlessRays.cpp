//===- EndlessRays.cpp - rays that only the depth limit ends --------------===//
//
// A shader that traces on every path is correct if other materials end its rays. If every material
// of a scene that handles a kind of rays sends another one of that kind on each path, only a ray
// that misses everything ends by itself: each sample may run to the depth limit, which deserves a
// warning.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// The exits of a piece of code that are reached without sending such a ray.
struct Untraced {
  bool end = false, returns = false, breaks = false, continues = false;
};

class AlwaysTraces {
public:
  /// For rays with this payload; null: rays for a color.
  AlwaysTraces(const mlir::SymbolTable &symbols, mlir::Type payload)
      : symbols(symbols), payload(payload) {}

  bool operator()(FuncOp function) {
    return functions.of(function, [&] {
      if (function.isExternal())
        return false;
      const Untraced exits = walk(function.getBody());
      return !exits.end && !exits.returns;
    });
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
    Untraced exits;
    if (region.empty()) {
      exits.end = true;
      return exits;
    }
    for (mlir::Operation &op : region.front()) {
      if (sends(op))
        return exits;
      if (llvm::isa<ir::YieldOp, ir::ConditionOp>(op))
        exits.end = true;
      else if (llvm::isa<ir::ReturnOp>(op))
        exits.returns = true;
      else if (llvm::isa<ir::BreakOp>(op))
        exits.breaks = true;
      else if (llvm::isa<ir::ContinueOp>(op))
        exits.continues = true;
      else if (op.getNumRegions() != 0 && !passes(op, exits))
        return exits;
    }
    return exits;
  }

  /// Adds the exits of `op`. Returns whether control may continue after it.
  bool passes(mlir::Operation &op, Untraced &exits) {
    auto add = [&](const Untraced &inner, bool isLoop) {
      exits.returns |= inner.returns;
      if (!isLoop) {
        exits.breaks |= inner.breaks;
        exits.continues |= inner.continues;
      }
    };
    if (auto choice = llvm::dyn_cast<ir::IfOp>(op)) {
      const Untraced then = walk(choice.getThenRegion()), otherwise = walk(choice.getElseRegion());
      add(then, false);
      add(otherwise, false);
      return then.end || otherwise.end;
    }
    if (auto loop = llvm::dyn_cast<ir::LoopOp>(op)) {
      const Untraced body = walk(loop.getBody()), condition = walk(loop.getCondition());
      add(body, true);
      exits.returns |= condition.returns;
      if (loop.getPostTest())
        return body.end || body.continues || body.breaks;
      if (loop.getCondition().empty())
        return body.breaks;
      return condition.end || body.breaks; // the loop may run no iteration
    }
    // Lights and cases: possibly none runs.
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
  FunctionProperty functions;
};

void check(LinkContext &context, const std::string &method, mlir::Type payload,
           const std::string &what) {
  AlwaysTraces alwaysTraces(context.symbols, payload);
  std::string names;
  SourceRange range;
  for (const LinkedClass &linked : context.classes) {
    if (linked.info->root != "rt_Material" || !linked.hasObjects || !linked.isMet)
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
  context.diagnostics.report(Code::endlessRays, range, what, names)
      .note("such rays end only at the depth limit, or if they miss everything; end some of them "
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
