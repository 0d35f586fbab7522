//===- StateStatements.cpp - choices, loops and declarations of a state ---===//
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

/// The variable that a condition reads, without negations.
static ir::VarOp variableReadBy(mlir::Value condition, bool &isOpposite) {
  while (auto negation = condition.getDefiningOp<arith::XOrIOp>()) {
    condition = negation.getLhs();
    isOpposite = !isOpposite;
  }
  auto load = condition.getDefiningOp<ir::LoadOp>();
  return load ? load.getAddress().getDefiningOp<ir::VarOp>() : ir::VarOp();
}

/// `frame.x`, or a part of it.
static bool isField(const Code &code, const std::string &frame) {
  if (!code || !code->is(ExpressionKind::Member))
    return false;
  const Code &base = code->parts[0];
  return (isName(base) && base->name == frame) || isField(base, frame);
}

/// The value of `type name = value;` or `name = value;`.
static Code valueOf(const Statement &statement) {
  return statement.is(StatementKind::Declaration) ? statement.declarators.front().value
                                                  : assignedValue(statement);
}

/// `bool either = a || b; if (either)`, where nothing else reads it: what the condition is then.
/// The assignment leaves `out`.
std::optional<Code> StateWriter::takeCondition(ir::IfOp op, Lines &out, Statement &taken) {
  bool isOpposite = false;
  ir::VarOp variable = variableReadBy(op.getCondition(), isOpposite);
  if (!variable || !isOwnName(variable.getName()))
    return std::nullopt;
  // Between the two may stand what is read from the frame, which the condition leaves alone.
  const auto found = std::find_if(out.rbegin(), out.rend(), [&](const Line &line) {
    return !line.declares && !isField(valueOf(line.statement), machine.frameName);
  });
  if (found == out.rend() || found->assigns != variable ||
      (found != out.rbegin() && mentions(valueOf(found->statement), machine.frameName)))
    return std::nullopt;
  for (mlir::Operation *user : variable->getUsers()) {
    auto load = llvm::dyn_cast<ir::LoadOp>(user);
    if (!load || load.getResult() == op.getCondition())
      continue;
    for (mlir::Operation *reader : load->getUsers()) {
      if (llvm::isa<arith::XOrIOp>(reader) && reader->hasOneUse())
        reader = *reader->user_begin();
      auto choice = llvm::dyn_cast<ir::IfOp>(reader);
      const bool isPart =
          choice && choice != op && llvm::any_of(variable->getUsers(), [&](mlir::Operation *other) {
            return llvm::isa<ir::StoreOp>(other) && choice->isProperAncestor(other);
          });
      if (!isPart && choice != op)
        return std::nullopt;
    }
  }
  taken = std::move(found->statement);
  out.erase(std::next(found).base());
  const Code value = assignedValue(taken);
  return isOpposite ? negated(value) : value;
}

/// What has the name, if the compiler gave it and nothing else reads it: its declaration leaves
/// `out` then. Otherwise the name.
Code StateWriter::takeName(ir::IfOp op, const Code &named, Lines &out) {
  auto last =
      std::find_if(out.rbegin(), out.rend(), [](const Line &line) { return !line.declares; });
  if (last == out.rend() || !last->made || !isName(named) || declared[last->made] != named->name ||
      !isOwnName(named->name))
    return named;
  for (mlir::Operation *user : last->made.getUsers())
    if (!op->isAncestor(user) && !llvm::is_contained(user->getUsers(), op.getOperation()))
      return named;
  const Code value = valueOf(last->statement);
  out.erase(std::next(last).base());
  return value;
}

Statements StateWriter::statementsOf(const Lines &lines) {
  Statements statements;
  for (const Line &line : lines)
    statements.push_back(line.statement);
  return statements;
}

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

void StateWriter::choice(ir::IfOp op, Lines &out) {
  const unsigned line = currentLine;
  Code condition = use(op.getCondition());
  Statement taken;
  if (std::optional<Code> whole = takeCondition(op, out, taken))
    condition = *whole;
  flushBefore(*op, out);
  Lines thenPart, elsePart;
  block(op.getThenRegion().front(), thenPart);
  if (!op.getElseRegion().empty())
    block(op.getElseRegion().front(), elsePart);
  currentLine = line;

  auto assigned = [](const Lines &part) {
    return part.size() == 1 ? part.front().assigns : nullptr;
  };
  if (mlir::Operation *target = assigned(thenPart); target && target == assigned(elsePart)) {
    const Code first = assignedValue(thenPart.front().statement),
               second = assignedValue(elsePart.front().statement);
    Code value;
    if (isBoolean(first, true))
      value = binary(Operator::Or, condition, second);
    else if (same(condition, second))
      value = binary(Operator::And, takeName(op, second, out), first);
    else if (same(condition, unary(UnaryOperator::Not, second)))
      value = binary(Operator::Or, takeName(op, second, out), first);
    else if (isBoolean(second, false))
      value = binary(Operator::And, condition, first);
    else
      value = choose(context, condition, first, second, varType(llvm::cast<ir::VarOp>(target)));
    emit(out, assign(name(nameOf(llvm::cast<ir::VarOp>(target))), value)).assigns = target;
    return;
  }
  // `bool both = a; if (both) both = b;`
  if (mlir::Operation *target = assigned(thenPart);
      target && elsePart.empty() && !out.empty() && out.back().assigns == target) {
    const Code own = name(nameOf(llvm::cast<ir::VarOp>(target)));
    const bool isAnd = same(condition, own), isOr = same(condition, unary(UnaryOperator::Not, own));
    if (isAnd || isOr) {
      out.back().statement.value = assign(own, binary(isAnd ? Operator::And : Operator::Or,
                                                      assignedValue(out.back().statement),
                                                      assignedValue(thenPart.front().statement)));
      return;
    }
  }
  Statement made = branch(condition, statementsOf(thenPart));
  made.hasBraces = !isShort(made.body);
  made.otherwise = statementsOf(elsePart);
  made.otherwiseHasBraces = !elsePart.empty() && !isShort(made.otherwise);
  Statement &last = emit(out, std::move(made)).statement;
  if (!taken.comment.empty())
    last.comment = last.comment.empty() ? taken.comment : taken.comment + "\n" + last.comment;
  last.hasSpace |= taken.hasSpace;
}

/// The `for` without its body, if the loop is `int i = a; while (i < b) { ...; ++i; }` and nothing
/// else reads i. The declaration before the loop and the increment in the body are removed.
std::optional<Statement> StateWriter::counter(ir::LoopOp op, const Code &condition, Lines &out,
                                              Lines &body) {
  if (out.empty() || body.empty() || !out.back().assigns ||
      out.back().assigns != body.back().assigns)
    return std::nullopt;
  auto variable = llvm::cast<ir::VarOp>(out.back().assigns);
  const Code own = name(nameOf(variable));
  // Below its bound an int can be counted up without overflow.
  Code test = condition; // or the first part of it that must hold
  while (test->is(ExpressionKind::Binary) && test->op == Operator::And)
    test = bare(Code(test->parts[0]));
  const bool isBelow =
      test->is(ExpressionKind::Binary) && test->op == Operator::Less && same(test->parts[0], own);
  if (!isBelow ||
      !same(assignedValue(body.back().statement), cpp::call("rtsl::add", {own, integer(1)})))
    return std::nullopt;
  unsigned outside = 0;
  for (mlir::Operation *user : variable->getUsers())
    outside += !op->isProperAncestor(user);
  const bool isContinued = op.getBody()
                               .walk([&](ir::ContinueOp jump) {
                                 return jump->getParentOfType<ir::LoopOp>() == op
                                            ? mlir::WalkResult::interrupt()
                                            : mlir::WalkResult::advance();
                               })
                               .wasInterrupted();
  if (outside != 1 || isContinued)
    return std::nullopt;
  Statement made = simple(StatementKind::For);
  made.init = {declaration(context.types.of(varType(variable)), own->name,
                           assignedValue(out.back().statement))};
  made.value = condition;
  made.step = unary(UnaryOperator::Increment, own);
  out.pop_back();
  body.pop_back();
  out.erase(
      std::remove_if(out.begin(), out.end(),
                     [&](const Line &line) { return line.declares == variable.getOperation(); }),
      out.end());
  return made;
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

void StateWriter::loop(ir::LoopOp op, Lines &out) {
  const unsigned line = currentLine;
  mlir::Block *lit = nullptr;
  std::string name;
  if (std::optional<Statement> made = lights(op, lit, name)) {
    auto load = llvm::cast<ir::LoadOp>(op.getCondition().front().front());
    mlir::Operation *number = load.getAddress().getDefiningOp();
    flushBefore(*op, out);
    out.erase(std::remove_if(
                  out.begin(), out.end(),
                  [&](const Line &one) { return one.assigns == number || one.declares == number; }),
              out.end());
    Lines body;
    block(*lit, body);
    taken.erase(name);
    currentLine = line;
    made->body = statementsOf(body);
    made->hasBraces = true;
    emit(out, std::move(*made));
    return;
  }
  flushBefore(*op, out);
  Lines head, body;
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
    Statements all = statementsOf(head), rest = statementsOf(body);
    all.push_back(branch(opposite, {simple(StatementKind::Break)}));
    all.insert(all.end(), rest.begin(), rest.end());
    emit(out, cpp::loop(boolean(true), std::move(all), /*hasBraces=*/true));
    return;
  }
  std::optional<Statement> counting = counter(op, condition, out, body);
  Statement made = counting ? std::move(*counting) : cpp::loop(condition, {});
  made.body = statementsOf(body);
  made.hasBraces = true;
  emit(out, std::move(made));
}

void StateWriter::switchOver(ir::SwitchOp op, Lines &out) {
  const unsigned line = currentLine;
  Statement made = simple(StatementKind::Switch);
  made.value = use(op.getValue());
  flushBefore(*op, out);
  for (auto [index, region] : llvm::enumerate(op.getArms())) {
    Arm &arm = made.arms.emplace_back();
    for (std::int32_t number : op.armValues(static_cast<unsigned>(index)))
      arm.labels.push_back(integer(number));
    arm.isDefault = op.getDefaultArm() && *op.getDefaultArm() == index;
    Lines lines;
    block(region.front(), lines);
    arm.body = statementsOf(lines);
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

void StateWriter::block(mlir::Block &block, Lines &out) {
  for (mlir::Operation &op : block)
    operation(op, out);
  joinDeclarations(out);
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

/// A variable is declared where it first gets its value.
void StateWriter::joinDeclarations(Lines &lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    auto variable = llvm::dyn_cast_or_null<ir::VarOp>(lines[i].declares);
    if (!variable)
      continue;
    const Type *type = varType(variable);
    if (!type)
      unsupported(*variable);
    const std::string typeName = type ? context.types.of(type) : std::string();
    const std::string &own = nameOf(variable);
    const auto at = lines.begin() + static_cast<std::ptrdiff_t>(i);
    const auto first = std::find_if(
        at + 1, lines.end(), [&](const Line &line) { return mentions(line.statement, own); });
    if (first != lines.end() && first->assigns != variable.getOperation()) {
      const bool isNumber = type && type->isScalar() && !type->is(TypeKind::UInt);
      at->statement =
          declaration(typeName, own, isNumber ? context.types.zero(type) : list("", {}));
      at->declares = nullptr;
      continue;
    }
    if (first != lines.end()) {
      Statement joined = declaration(typeName, own, assignedValue(first->statement));
      joined.comment = first->statement.comment;
      joined.place = first->statement.place;
      joined.hasSpace = first->statement.hasSpace;
      first->statement = std::move(joined);
    }
    lines.erase(at);
    --i;
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
  Lines lines;
  block(state.getBody().front(), lines);
  Statements statements;
  for (const typed::Variable *constant : constants)
    statements.push_back(
        declaration(printer.literals.isTable(*constant->init) ? "static constexpr" : "const",
                    context.types.of(constant->type), context.names.of(constant),
                    printer.expressions.initialiser(*constant->init)));
  for (Line &line : lines)
    statements.push_back(std::move(line.statement));
  return statements;
}

} // namespace rtsl::cpp
