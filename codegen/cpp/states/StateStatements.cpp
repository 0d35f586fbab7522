//===- StateStatements.cpp - choices, loops and declarations of a state ---===//
#include "codegen/cpp/cleanup/CleanUp.h"
#include "codegen/cpp/states/StateWriter.h"

#include "sema/typed/Walk.h"

#include "mlir/Dialect/Arith/IR/Arith.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

namespace arith = mlir::arith;

//===----------------------------------------------------------------------===//
// Constructs
//===----------------------------------------------------------------------===//

/// Can the statements stand without braces under an `if`?
static bool isShort(const Statements &statements) {
  if (statements.size() != 1 || !statements.front().comment.empty() || statements.front().place)
    return false;
  switch (statements.front().kind) {
  case StatementKind::Expression:
  case StatementKind::Return:
  case StatementKind::Break:
  case StatementKind::Continue:
    return true;
  default:
    return false;
  }
}

void StateWriter::choice(ir::IfOp op, Statements &out) {
  const unsigned line = currentLine;
  const Code condition = use(op.getCondition());
  flushBefore(*op, out);
  Statement made = branch(condition, {});
  block(op.getThenRegion().front(), made.body);
  if (!op.getElseRegion().empty())
    block(op.getElseRegion().front(), made.otherwise);
  currentLine = line;
  made.hasBraces = !isShort(made.body);
  made.otherwiseHasBraces = !made.otherwise.empty() && !isShort(made.otherwise);
  emit(out, std::move(made));
}

/// The loop that an `illuminance` was, without its body, what runs for each light, and the name of
/// its variable; nothing if the loop is none.
std::optional<Statement> StateWriter::lights(ir::LoopOp op, mlir::Block *&lit, std::string &name) {
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
  if (light.getCosAngle() && (!cosine || !pending.count(cosine.getResult())))
    return std::nullopt;
  // The variable is written before the loop too: 0, which is not printed.
  unsigned outside = 0;
  for (mlir::Operation *user : variable->getUsers())
    outside += !op->isProperAncestor(user);
  if (outside != 1)
    return std::nullopt;
  lit = &body.getThenRegion().front();
  std::vector<Code> arguments = {use(light.getPoint(), vec3())};
  if (cosine) {
    arguments.push_back(use(light.getNormal(), vec3()));
    const Code angle = use(cosine.getResult()); // rtsl::cosOfAngle(angle)
    arguments.push_back(angle->parts[1]);
  }
  name = "lights"; // within another loop over lights it is another
  for (unsigned i = 2; isAlways(name) || !taken.insert(name).second; ++i)
    name = "lights" + std::to_string(i);
  lightNumbers[variable] =
      callMember(cpp::name(name), "number", {}); // for what goes on with the next light later
  return lightLoop(name, std::move(arguments));
}

void StateWriter::loop(ir::LoopOp op, Statements &out) {
  const unsigned line = currentLine;
  mlir::Block *lit = nullptr;
  std::string name;
  if (std::optional<Statement> made = lights(op, lit, name)) {
    auto load = llvm::cast<ir::LoadOp>(op.getCondition().front().front());
    mlir::Operation *number = load.getAddress().getDefiningOp();
    flushBefore(*op, out);
    out.erase(std::remove_if(out.begin(), out.end(),
                             [&](const Statement &one) { return one.written.identity == number; }),
              out.end());
    block(*lit, made->body);
    taken.erase(name);
    currentLine = line;
    made->hasBraces = true;
    emit(out, std::move(*made));
    return;
  }
  flushBefore(*op, out);
  Statements head, body;
  Code condition = boolean(true), opposite;
  if (!op.getCondition().empty()) {
    mlir::Block &test = op.getCondition().front();
    block(test, head);
    consumed = {};
    const mlir::Value goesOn = llvm::cast<ir::ConditionOp>(test.back()).getCondition();
    condition = use(goesOn);
    opposite = this->opposite(goesOn, condition);
  }
  block(op.getBody().front(), body);
  currentLine = line;
  if (!head.empty()) {
    head.push_back(branch(opposite, {simple(StatementKind::Break)}));
    append(head, body);
    emit(out, cpp::loop(boolean(true), std::move(head), /*hasBraces=*/true));
    return;
  }
  emit(out, cpp::loop(condition, std::move(body), /*hasBraces=*/true));
}

void StateWriter::switchOver(ir::SwitchOp op, Statements &out) {
  const unsigned line = currentLine;
  Statement made = simple(StatementKind::Switch);
  made.value = use(op.getValue());
  flushBefore(*op, out);
  for (auto [index, region] : llvm::enumerate(op.getArms())) {
    Arm &arm = made.arms.emplace_back();
    for (std::int32_t number : op.armValues(static_cast<unsigned>(index)))
      arm.labels.push_back(integer(number));
    arm.isDefault = op.getDefaultArm() && *op.getDefaultArm() == index;
    block(region.front(), arm.body);
    arm.hasBraces = std::any_of(arm.body.begin(), arm.body.end(), [](const Statement &one) {
      return one.is(StatementKind::Declaration);
    });
  }
  if (!op.getDefaultArm()) {
    Arm &arm = made.arms.emplace_back();
    arm.isDefault = true;
    arm.body = {simple(StatementKind::Break)};
  }
  currentLine = line;
  emit(out, std::move(made));
}

void StateWriter::block(mlir::Block &block, Statements &out) {
  for (mlir::Operation &op : block)
    operation(op, out);
  nameOpenDeclarations(out);
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

/// The variables of a block get their names last: what is computed in it comes first.
void StateWriter::nameOpenDeclarations(Statements &out) {
  for (Statement &open : out) {
    if (!open.isOpen || !open.declarators.empty())
      continue;
    auto variable = ir::VarOp::getFromOpaquePointer(open.written.identity);
    const Type *type = varType(variable);
    if (!type)
      unsupported(*variable);
    open.type = type ? context.types.of(type) : std::string();
    const bool isNumber = type && type->isScalar() && !type->is(TypeKind::UInt);
    open.declarators.push_back(
        {nameOf(variable), isNumber ? context.types.zero(type) : list("", {})});
  }
}

Statements StateWriter::body(mlir::func::FuncOp state) {
  taken.clear();
  pending.clear();
  declared.clear();
  latest.clear();
  variableNames.clear();
  variableTypes.clear();
  lightNumbers.clear();
  usesScratch = false;
  insertions.clear();
  comments.clear();
  spaces.clear();
  currentLine = 0;
  forEachStmt(*machine.method->body, [&](const typed::Stmt &stmt) {
    if (!stmt.comment.empty())
      comments[context.notes.line(stmt.range)] = stmt.comment;
    if (context.notes.followsEmptyLine(stmt.range, {}))
      spaces.insert(context.notes.line(stmt.range));
  });
  elementIndices.clear();
  constants.clear();
  Statements lines;
  block(state.getBody().front(), lines);
  cleanUp(lines, machine.frameName);
  Statements statements;
  for (const typed::Variable *constant : constants)
    statements.push_back(
        declaration(printer.literals.isTable(*constant->init) ? "static constexpr" : "const",
                    context.types.of(constant->type), context.names.of(constant),
                    printer.expressions.initialiser(*constant->init)));
  append(statements, lines);
  return statements;
}

} // namespace rtsl::cpp
