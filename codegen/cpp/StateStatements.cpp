//===- StateStatements.cpp - choices, loops and declarations of a state ---===//
#include "codegen/cpp/StateWriter.h"

#include "sema/Walk.h"

#include "mlir/Dialect/Arith/IR/Arith.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

namespace arith = mlir::arith;

//===----------------------------------------------------------------------===//
// Constructs
//===----------------------------------------------------------------------===//

/// What a condition asks for, without negations.
static ir::VarOp variableAskedBy(mlir::Value condition, bool &isOpposite) {
  while (auto negation = condition.getDefiningOp<arith::XOrIOp>()) {
    condition = negation.getLhs();
    isOpposite = !isOpposite;
  }
  auto load = condition.getDefiningOp<ir::LoadOp>();
  return load ? load.getAddress().getDefiningOp<ir::VarOp>() : ir::VarOp();
}

/// `bool either = a || b; if (either)`, where nobody else asks: what the condition is then. The
/// assignment leaves `out`.
std::optional<Code> StateWriter::takeCondition(ir::IfOp op, Statements &out, Statement &taken) {
  bool isOpposite = false;
  ir::VarOp variable = variableAskedBy(op.getCondition(), isOpposite);
  if (!variable || !isOwnName(variable.getName()))
    return std::nullopt;
  // Between the two may stand what is read from the frame, which the condition leaves alone.
  const std::string frame = machine.frameName + ".";
  const auto isField = [&](const std::string &value) {
    return value.compare(0, frame.size(), frame) == 0 &&
           std::all_of(value.begin(), value.end(), [](char c) { return llvm::isAlnum(c) || c == '_' || c == '.'; });
  };
  const auto found = std::find_if(out.rbegin(), out.rend(), [&](const Statement &statement) {
    return !statement.text.empty() && !isField(statement.value);
  });
  if (found == out.rend() || found->assigns != variable || found->value.empty() ||
      (found != out.rbegin() && found->value.find(frame) != std::string::npos))
    return std::nullopt;
  for (mlir::Operation *user : variable->getUsers()) {
    auto load = llvm::dyn_cast<ir::LoadOp>(user);
    if (!load || load.getResult() == op.getCondition())
      continue;
    for (mlir::Operation *asking : load->getUsers()) {
      if (llvm::isa<arith::XOrIOp>(asking) && asking->hasOneUse())
        asking = *asking->user_begin();
      auto choice = llvm::dyn_cast<ir::IfOp>(asking);
      const bool isPart =
          choice && choice != op && llvm::any_of(variable->getUsers(), [&](mlir::Operation *other) {
            return llvm::isa<ir::StoreOp>(other) && choice->isProperAncestor(other);
          });
      if (!isPart && choice != op)
        return std::nullopt;
    }
  }
  taken = std::move(*found);
  out.erase(std::next(found).base());
  Code value = {taken.value, Binding::Assignment};
  return isOpposite ? negated(value) : value;
}

/// One side of `&&` or `||`.
static std::string sideOf(const std::string &part) {
  const bool isSimple = part.find("&&") == std::string::npos &&
                        part.find("||") == std::string::npos && part.find('?') == std::string::npos;
  return isSimple ? part : "(" + part + ")";
}

/// What has the name, if the compiler gave it and nobody else asks: its declaration leaves `out`
/// then. Otherwise the name.
std::string StateWriter::takeName(ir::IfOp op, const std::string &name, Statements &out) {
  auto last = std::find_if(out.rbegin(), out.rend(),
                           [](const Statement &statement) { return !statement.text.empty(); });
  if (last == out.rend() || !last->made || declared[last->made] != name || !isOwnName(name))
    return name;
  for (mlir::Operation *user : last->made.getUsers())
    if (!op->isAncestor(user) && !llvm::is_contained(user->getUsers(), op.getOperation()))
      return name;
  const std::string value = sideOf(last->value);
  mentioned.insert(last->mentions.begin(), last->mentions.end());
  out.erase(std::next(last).base());
  return value;
}

void StateWriter::choice(ir::IfOp op, Statements &out) {
  const unsigned line = currentLine;
  Code condition = use(op.getCondition());
  std::set<mlir::Operation *> inCondition = std::move(mentioned);
  mentioned.clear();
  Statement taken;
  if (std::optional<Code> whole = takeCondition(op, out, taken)) {
    condition = *whole;
    inCondition.insert(taken.mentions.begin(), taken.mentions.end());
    inCondition.erase(taken.assigns);
  }
  flushBefore(*op, out);
  Statements thenPart, elsePart;
  block(op.getThenRegion().front(), thenPart);
  if (!op.getElseRegion().empty())
    block(op.getElseRegion().front(), elsePart);

  auto assigns = [](const Statements &part) {
    return part.size() == 1 && part.front().assigns && !part.front().value.empty() ? part.front().assigns : nullptr;
  };
  if (mlir::Operation *target = assigns(thenPart); target && target == assigns(elsePart)) {
    const std::string name = nameOf(llvm::cast<ir::VarOp>(target));
    const std::string first = thenPart.front().value, second = elsePart.front().value;
    std::string value = choose(bind(condition, Binding::Or), first, second, varType(llvm::cast<ir::VarOp>(target)));
    if (condition.text == second || condition.text == "!" + second)
      value =
          takeName(op, second, out) + (condition.text == second ? " && " : " || ") + sideOf(first);
    else if (second == "false")
      value = bind(condition, Binding::And) + " && (" + first + ")";
    if (first == "true")
      value = "(" + condition.text + ") || (" + second + ")";
    mentioned.insert(inCondition.begin(), inCondition.end());
    currentLine = line;
    for (const Statements *part : {&thenPart, &elsePart})
      mentioned.insert(part->front().mentions.begin(), part->front().mentions.end());
    emit(out, name + " = " + value + ";");
    out.back().assigns = target;
    out.back().value = value;
    return;
  }
  // `bool both = a; if (both) both = b;`
  if (mlir::Operation *target = assigns(thenPart);
      target && elsePart.empty() && !out.empty() && out.back().assigns == target && !out.back().value.empty()) {
    const std::string name = nameOf(llvm::cast<ir::VarOp>(target));
    const bool isAnd = condition.text == name, isOr = condition.text == "!" + name;
    if (isAnd || isOr) {
      const std::string second = thenPart.front().value;
      const std::string value =
          sideOf(out.back().value) + (isAnd ? " && " : " || ") + sideOf(second);
      out.back().mentions.insert(thenPart.front().mentions.begin(), thenPart.front().mentions.end());
      out.back().text = name + " = " + value + ";";
      out.back().value = value;
      return;
    }
  }
  std::string text = "if (" + condition.text + ")" + under(thenPart);
  if (!elsePart.empty())
    text += (text.back() == '\n' ? "else" : " else") + under(elsePart);
  while (text.back() == '\n')
    text.pop_back();
  mentioned = inCondition;
  currentLine = line;
  for (const Statements *part : {&thenPart, &elsePart})
    for (const Statement &statement : *part)
      mentioned.insert(statement.mentions.begin(), statement.mentions.end());
  emit(out, text);
  out.back().comment = taken.comment + out.back().comment;
  out.back().hasSpace |= taken.hasSpace;
}

/// The head of a `for`, if the loop is `int i = a; while (i < b) { ...; ++i; }` and nobody else asks
/// for i. What the head says is taken out of what stands before the loop, and of the body.
std::string StateWriter::counter(ir::LoopOp op, const std::string &condition, Statements &out, Statements &body) {
  if (out.empty() || body.empty() || !out.back().assigns || out.back().assigns != body.back().assigns)
    return {};
  auto variable = llvm::cast<ir::VarOp>(out.back().assigns);
  const std::string &name = nameOf(variable);
  // Below its bound an int can be counted up without overflow.
  if (body.back().value != "rtsl::add(" + name + ", 1)" || condition.compare(0, name.size() + 3, name + " < ") != 0)
    return {};
  unsigned outside = 0;
  for (mlir::Operation *user : variable->getUsers())
    outside += !op->isProperAncestor(user);
  const bool isContinued = op.getBody()
                               .walk([&](ir::ContinueOp jump) {
                                 return jump->getParentOfType<ir::LoopOp>() == op ? mlir::WalkResult::interrupt()
                                                                                  : mlir::WalkResult::advance();
                               })
                               .wasInterrupted();
  if (outside != 1 || isContinued)
    return {};
  const std::string head =
      fmt::format("for ({} {} = {}; {}; ++{})", varType(variable), name, out.back().value, condition, name);
  out.pop_back();
  body.pop_back();
  out.erase(std::remove_if(out.begin(), out.end(),
                           [&](const Statement &statement) { return statement.declares == variable.getOperation(); }),
            out.end());
  return head;
}

/// The head of the loop that an `illuminance` was, what runs for each light, and the name of its variable; nothing if the
/// loop is none.
std::string StateWriter::lights(ir::LoopOp op, mlir::Block *&lit, std::string &name) {
  if (op.getCondition().empty())
    return {};
  auto condition = llvm::cast<ir::ConditionOp>(op.getCondition().front().back());
  auto compare = condition.getCondition().getDefiningOp<arith::CmpIOp>();
  auto load = compare ? compare.getLhs().getDefiningOp<ir::LoadOp>() : ir::LoadOp();
  auto count = compare ? compare.getRhs().getDefiningOp<ir::LightCountOp>() : ir::LightCountOp();
  auto variable = load ? load.getAddress().getDefiningOp<ir::VarOp>() : ir::VarOp();
  if (!variable || !count || op.getCondition().front().getOperations().size() != 3)
    return {};
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
      return {};
  }
  if (!light || !body || body.getCondition() != light.getLit() || !body.getElseRegion().empty())
    return {};
  auto cosine = light.getCosAngle() ? light.getCosAngle().getDefiningOp<ir::ExpressionOp>() : ir::ExpressionOp();
  if (light.getCosAngle() && (!cosine || !pending.count(cosine.getResult())))
    return {};
  // The variable is written before the loop too: 0, of which nobody will know.
  unsigned outside = 0;
  for (mlir::Operation *user : variable->getUsers())
    outside += !op->isProperAncestor(user);
  if (outside != 1)
    return {};
  lit = &body.getThenRegion().front();
  std::string arguments = "rt, " + bind(use(light.getPoint(), "glm::vec3"), Binding::Assignment);
  if (cosine) {
    arguments += ", " + bind(use(light.getNormal(), "glm::vec3"), Binding::Assignment);
    std::string angle = bind(use(cosine.getResult()), Binding::Assignment);
    const std::string function = "rtsl::cosOfAngle(";
    arguments += ", " + angle.substr(function.size(), angle.size() - function.size() - 1);
  }
  name = "lights"; // within another loop over lights it is another
  for (unsigned i = 2; always.count(name) || !taken.insert(name).second; ++i)
    name = "lights" + std::to_string(i);
  variableNames[variable] = name + ".number()"; // for what goes on with the next light later
  return fmt::format("for (rtsl::Lights {0}({1}); {0}.next();)", name, arguments);
}

void StateWriter::loop(ir::LoopOp op, Statements &out) {
  const unsigned line = currentLine;
  mlir::Block *lit = nullptr;
  std::string name;
  if (const std::string head = lights(op, lit, name); !head.empty()) {
    auto load = llvm::cast<ir::LoadOp>(op.getCondition().front().front());
    mlir::Operation *number = load.getAddress().getDefiningOp();
    std::set<mlir::Operation *> inHead = std::move(mentioned);
    mentioned.clear();
    flushBefore(*op, out);
    out.erase(std::remove_if(out.begin(), out.end(),
                             [&](const Statement &statement) {
                               return statement.assigns == number || statement.declares == number;
                             }),
              out.end());
    Statements body;
    block(*lit, body);
    taken.erase(name);
    mentioned = inHead;
    for (const Statement &statement : body)
      mentioned.insert(statement.mentions.begin(), statement.mentions.end());
    currentLine = line;
    return emit(out, head + " {\n" + text(body) + "}");
  }
  flushBefore(*op, out);
  Statements head, body;
  std::string condition = "true", opposite;
  std::set<mlir::Operation *> inCondition;
  if (!op.getCondition().empty()) {
    mlir::Block &test = op.getCondition().front();
    block(test, head);
    consumed = {};
    const mlir::Value goesOn = llvm::cast<ir::ConditionOp>(test.back()).getCondition();
    const Code asked = use(goesOn);
    condition = asked.text;
    opposite = this->opposite(goesOn, asked).text;
    inCondition = std::move(mentioned);
    mentioned.clear();
  }
  block(op.getBody().front(), body);
  std::string text;
  if (head.empty()) {
    const std::string counting = counter(op, condition, out, body);
    text = counting.empty() ? "while (" + condition + ")" : counting;
    text += " {\n" + this->text(body) + "}";
  } else {
    text = "while (true) {\n" + this->text(head) + "if (" + opposite + ")\nbreak;\n" + this->text(body) + "}";
  }
  mentioned = inCondition;
  currentLine = line;
  for (const Statements *part : {&head, &body})
    for (const Statement &statement : *part)
      mentioned.insert(statement.mentions.begin(), statement.mentions.end());
  emit(out, text);
}

void StateWriter::switchOver(ir::SwitchOp op, Statements &out) {
  const unsigned line = currentLine;
  const std::string value = use(op.getValue()).text;
  const std::set<mlir::Operation *> inValue = std::move(mentioned);
  mentioned.clear();
  flushBefore(*op, out);
  std::string text = "switch (" + value + ") {\n";
  std::set<mlir::Operation *> inside = inValue;
  for (auto [index, arm] : llvm::enumerate(op.getArms())) {
    for (std::int32_t number : op.armValues(static_cast<unsigned>(index)))
      text += fmt::format("case {}:\n", number);
    if (op.getDefaultArm() && *op.getDefaultArm() == index)
      text += "default:\n";
    Statements statements;
    block(arm.front(), statements);
    for (const Statement &statement : statements)
      inside.insert(statement.mentions.begin(), statement.mentions.end());
    const bool declares = std::any_of(statements.begin(), statements.end(),
                                      [](const auto &one) { return one.isDeclaration; });
    text += declares ? "{\n" + this->text(statements) + "}\n" : this->text(statements);
  }
  if (!op.getDefaultArm())
    text += "default:\nbreak;\n";
  mentioned = inside;
  currentLine = line;
  emit(out, text + "}");
}

void StateWriter::block(mlir::Block &block, Statements &out) {
  for (mlir::Operation &op : block)
    operation(op, out);
  joinDeclarations(out);
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

/// A variable is declared where it first gets its value.
void StateWriter::joinDeclarations(Statements &statements) {
  for (std::size_t i = 0; i < statements.size(); ++i) {
    auto variable = llvm::dyn_cast_or_null<ir::VarOp>(statements[i].declares);
    if (!variable)
      continue;
    const std::string type = varType(variable);
    if (type.empty())
      unsupported(*variable);
    const std::string &name = nameOf(variable);
    auto first = std::find_if(statements.begin() + static_cast<std::ptrdiff_t>(i) + 1, statements.end(),
                              [&](const Statement &statement) { return statement.mentions.count(variable) != 0; });
    if (first == statements.end()) {
      statements.erase(statements.begin() + static_cast<std::ptrdiff_t>(i--));
      continue;
    }
    if (first->assigns == variable.getOperation()) {
      first->text = type + " " + declarator(type, name, first->value) + ";";
      first->declares = nullptr;
      first->isDeclaration = true;
      statements.erase(statements.begin() + static_cast<std::ptrdiff_t>(i--));
      continue;
    }
    const bool isNumber = type == "float" || type == "int" || type == "bool";
    const char *zero = type == "float" ? "0.0f" : type == "int" ? "0" : "false";
    statements[i].text = isNumber ? fmt::format("{} {} = {};", type, name, zero)
                                  : fmt::format("{} {}{{}};", type, name);
    statements[i].declares = nullptr;
    statements[i].isDeclaration = true;
    statements[i].mentions.insert(variable);
  }
}

std::string StateWriter::text(const Statements &statements) {
  std::string text;
  for (const Statement &statement : statements)
    text += (statement.hasSpace && !text.empty() ? "\n" : "") + statement.comment + statement.text + "\n";
  return text;
}

/// What stands under an `if`, without braces where none are needed.
std::string StateWriter::under(const Statements &statements) {
  const bool isShort = statements.size() == 1 && statements.front().comment.empty() &&
                       statements.front().text.find('\n') == std::string::npos &&
                       statements.front().text.compare(0, 2, "if") != 0;
  return isShort ? "\n" + statements.front().text + "\n" : " {\n" + text(statements) + "}";
}

std::string StateWriter::body(mlir::func::FuncOp state) {
  taken.clear();
  pending.clear();
  declared.clear();
  latest.clear();
  variableNames.clear();
  variableTypes.clear();
  mentioned.clear();
  usesScratch = false;
  insertions.clear();
  comments.clear();
  spaces.clear();
  currentLine = 0;
  forEachStmt(*machine.method->body, [&](const typed::Stmt &stmt) {
    if (!stmt.comment.empty())
      comments[module.notes.line(stmt.range)] = stmt.comment;
    if (module.notes.followsEmptyLine(stmt.range, {}))
      spaces.insert(module.notes.line(stmt.range));
  });
  elementIndices.clear();
  constants.clear();
  Statements statements;
  block(state.getBody().front(), statements);
  std::string declared;
  for (const typed::Variable *constant : constants) {
    const std::string type = module.type(constant->type), &name = module.names.of(constant);
    declared += (printer.isTable(*constant->init) ? "static constexpr " : "const ") + type + " " +
                declarator(type, name, printer.initialiser(*constant->init)) + ";\n";
  }
  return declared + text(statements);
}

} // namespace rtsl::cpp
