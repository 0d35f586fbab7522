#include "codegen/cpp/states/statements/StateControl.h"

#include "codegen/cpp/states/statements/StatePrinter.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "llvm/ADT/TypeSwitch.h"

#include <algorithm>

namespace rtsl::cpp {

namespace arith = mlir::arith;

bool StateControl::print(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case([&](ir::IfOp inner) { choice(inner, out); })
      .Case([&](ir::LoopOp inner) { loop(inner, out); })
      .Case([&](ir::SwitchOp inner) { switchOver(inner, out); })
      .Case([&](ir::BreakOp) { state.emitter.emit(out, simple(StatementKind::Break)); })
      .Case([&](ir::ContinueOp) { state.emitter.emit(out, simple(StatementKind::Continue)); })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

void StateControl::choice(ir::IfOp op, Statements &out) {
  const unsigned line = state.emitter.line;
  const Code condition = state.values.use(op.getCondition());
  state.values.flushBefore(*op, out);
  Statement made = branch(condition, {});
  block(op.getThenRegion().front(), made.body);
  if (!op.getElseRegion().empty())
    block(op.getElseRegion().front(), made.otherwise);
  state.emitter.line = line;
  state.emitter.emit(out, std::move(made));
}

/// The loop that an `illuminance` was, without its body, what runs for each light, and the name of
/// its variable; nothing if the loop is none.
std::optional<Statement> StateControl::lights(ir::LoopOp op, mlir::Block *&lit, std::string &name) {
  if (op.getCondition().empty())
    return std::nullopt;
  auto condition = llvm::cast<ir::ConditionOp>(op.getCondition().front().back());
  auto compare = condition.getCondition().getDefiningOp<arith::CmpIOp>();
  auto load = compare ? compare.getLhs().getDefiningOp<ir::LoadOp>() : ir::LoadOp();
  auto count = compare ? compare.getRhs().getDefiningOp<ir::LightCountOp>() : ir::LightCountOp();
  auto variable = load ? load.getAddress().getDefiningOp<ir::VarOp>() : ir::VarOp();
  if (!variable || !count || op.getCondition().front().getOperations().size() != 3)
    return std::nullopt;
  // i = load; lit = illuminate i; if lit { ... }; i = load; next = i + 1; store next
  ir::IlluminateOp light;
  ir::IfOp body;
  for (mlir::Operation &inner : op.getBody().front()) {
    auto number = llvm::dyn_cast<ir::LoadOp>(inner);
    auto stored = llvm::dyn_cast<ir::StoreOp>(inner);
    const bool counts = (number && number.getAddress() == variable.getResult()) ||
                        (stored && stored.getAddress() == variable.getResult()) ||
                        llvm::isa<arith::AddIOp, arith::ConstantOp, ir::YieldOp>(inner);
    if (auto found = llvm::dyn_cast<ir::IlluminateOp>(inner); found && !light)
      light = found;
    else if (auto choice = llvm::dyn_cast<ir::IfOp>(inner); choice && !body)
      body = choice;
    else if (!counts)
      return std::nullopt;
  }
  if (!light || !body || body.getCondition() != light.getLit() || !body.getElseRegion().empty())
    return std::nullopt;
  auto cosine = light.getCosAngle() ? light.getCosAngle().getDefiningOp<ir::ExpressionOp>()
                                    : ir::ExpressionOp();
  if (light.getCosAngle() && (!cosine || !state.values.isPending(cosine.getResult())))
    return std::nullopt;
  // The variable is written before the loop too: 0, which is not printed.
  unsigned outside = 0;
  for (mlir::Operation *user : variable->getUsers())
    outside += !op->isProperAncestor(user);
  if (outside != 1)
    return std::nullopt;
  lit = &body.getThenRegion().front();
  std::vector<Code> arguments = {state.values.use(light.getPoint(), state.types.vec3())};
  if (cosine) {
    arguments.push_back(state.values.use(light.getNormal(), state.types.vec3()));
    const Code angle = state.values.use(cosine.getResult()); // rtsl::cosOfAngle(angle)
    arguments.push_back(angle->parts[1]);
  }
  name = state.names.ofLights();
  // For code that goes on with the next light later.
  state.lvalues.countLights(variable, callMember(cpp::name(name), "number", {}));
  return lightLoop(name, std::move(arguments));
}

void StateControl::loop(ir::LoopOp op, Statements &out) {
  const unsigned line = state.emitter.line;
  mlir::Block *lit = nullptr;
  std::string name;
  if (std::optional<Statement> made = lights(op, lit, name)) {
    auto load = llvm::cast<ir::LoadOp>(op.getCondition().front().front());
    mlir::Operation *number = load.getAddress().getDefiningOp();
    state.values.flushBefore(*op, out);
    out.erase(std::remove_if(out.begin(), out.end(),
                             [&](const Statement &one) { return one.written.identity == number; }),
              out.end());
    block(*lit, made->body);
    state.names.release(name);
    state.emitter.line = line;
    made->hasBraces = true;
    state.emitter.emit(out, std::move(*made));
    return;
  }
  state.values.flushBefore(*op, out);
  Statements head, body;
  Code condition = boolean(true), opposite;
  if (!op.getCondition().empty()) {
    mlir::Block &test = op.getCondition().front();
    block(test, head);
    state.values.consumed = {};
    const mlir::Value goesOn = llvm::cast<ir::ConditionOp>(test.back()).getCondition();
    condition = state.values.use(goesOn);
    opposite = state.expressions.opposite(goesOn, condition);
  }
  block(op.getBody().front(), body);
  state.emitter.line = line;
  if (!head.empty()) {
    head.push_back(branch(opposite, {simple(StatementKind::Break)}));
    append(head, body);
    state.emitter.emit(out, cpp::loop(boolean(true), std::move(head), /*hasBraces=*/true));
    return;
  }
  state.emitter.emit(out, cpp::loop(condition, std::move(body), /*hasBraces=*/true));
}

void StateControl::switchOver(ir::SwitchOp op, Statements &out) {
  const unsigned line = state.emitter.line;
  Statement made = simple(StatementKind::Switch);
  made.value = state.values.use(op.getValue());
  state.values.flushBefore(*op, out);
  for (auto [index, region] : llvm::enumerate(op.getArms())) {
    Arm &arm = made.arms.emplace_back();
    for (std::int32_t number : op.armValues(static_cast<unsigned>(index)))
      arm.labels.push_back(integer(number));
    arm.isDefault = op.getDefaultArm() && *op.getDefaultArm() == index;
    block(region.front(), arm.body);
  }
  if (!op.getDefaultArm()) {
    Arm &arm = made.arms.emplace_back();
    arm.isDefault = true;
    arm.body = {simple(StatementKind::Break)};
  }
  state.emitter.line = line;
  state.emitter.emit(out, std::move(made));
}

void StateControl::block(mlir::Block &block, Statements &out) {
  for (mlir::Operation &op : block)
    state.print(op, out);
  nameOpenDeclarations(out);
}

/// The variables of a block get their names last: what is computed in it comes first.
void StateControl::nameOpenDeclarations(Statements &out) {
  for (Statement &open : out) {
    if (!open.isOpen || !open.declarators.empty())
      continue;
    auto variable = ir::VarOp::getFromOpaquePointer(open.written.identity);
    const Type *type = state.types.ofVariable(variable);
    if (!type)
      state.unsupported(*variable);
    open.type = type ? context.types.of(type) : std::string();
    const bool isNumber = type && type->isScalar() && !type->is(TypeKind::UInt);
    open.declarators.push_back(
        {state.names.of(variable), isNumber ? context.types.zero(type) : list("", {})});
  }
}

} // namespace rtsl::cpp
