//===- Statements.cpp - statements ----------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "codegen/lower/Analysis.h"
#include "runtime/device/math/Elementary.h"
#include "sema/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

using ast::StmtKind;
using typed::ExprKind;

//===----------------------------------------------------------------------===//
// The whole body
//===----------------------------------------------------------------------===//

std::string FunctionPrinter::body() {
  const auto &statements = cast<typed::CompoundStmt>(*function->body).body;
  // Which variables does anybody read? Compilers complain of the others.
  std::set<const typed::Expr *> onlyWritten;
  module.effects.forEachEvaluated(*function->body, [&](const typed::Expr &expr) {
    auto skip = [&](const typed::Expr *place) {
      while (auto *swizzle = dynCast<typed::SwizzleExpr>(place))
        place = swizzle->base.get();
      onlyWritten.insert(place);
    };
    if (auto *assign = dynCast<typed::AssignExpr>(&expr))
      skip(assign->target.get());
    else if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
      skip(incDec->target.get());
    if (auto *variable = dynCast<typed::VariableExpr>(&expr)) {
      mentionedVariables.insert(variable->variable);
      if (!onlyWritten.count(&expr))
        readVariables.insert(variable->variable);
    }
    if (auto *literal = dynCast<typed::LiteralExpr>(&expr))
      if (auto *named = static_cast<const typed::Variable *>(namedConstant(*literal)))
        readVariables.insert(named);
  });
  std::string zeros;
  for (std::size_t i = 0; i != function->parameters.size(); ++i)
    if (const typed::Variable &parameter = *function->parameters[i]; module.beginsAsZero(parameter, *function))
      zeros += module.parameterName(*function, i) + " = " + module.zero(parameter.type) + ";\n";
  return "{\n" + zeros + block(statements) + "}";
}

std::string FunctionPrinter::block(const std::vector<typed::StmtPtr> &statements) {
  std::string text;
  for (std::size_t i = 0; i < statements.size(); ++i) {
    if (!statements[i])
      continue;
    if (i > 0 && module.notes.followsEmptyLine(statements[i]->range, statements[i - 1] ? statements[i - 1]->range : SourceRange()))
      text += "\n";
    text += statement(*statements[i]);
  }
  return text;
}

std::string FunctionPrinter::statement(const typed::Stmt &stmt) {
  std::vector<std::string> statements;
  std::vector<std::string> *outer = before;
  before = &statements;
  std::string text;
  bool mayHaveComment = false;
  switch (stmt.kind) {
  case StmtKind::Compound:
    text = "{\n" + block(cast<typed::CompoundStmt>(stmt).body) + "}\n";
    break;
  case StmtKind::Declaration:
    text = declaration(cast<typed::DeclarationStmt>(stmt), false);
    mayHaveComment = true;
    break;
  case StmtKind::Expression:
    text = expressionStatement(*cast<typed::ExpressionStmt>(stmt).expr);
    mayHaveComment = true;
    break;
  case StmtKind::If:
    text = ifStatement(cast<typed::IfStmt>(stmt));
    break;
  case StmtKind::For:
    text = forStatement(cast<typed::ForStmt>(stmt));
    break;
  case StmtKind::While: {
    const auto &loop = cast<typed::WhileStmt>(stmt);
    text = "while (" + apart(*loop.condition, Binding::Comma) + ")\n" + nested(loop.body);
    break;
  }
  case StmtKind::DoWhile: {
    const auto &loop = cast<typed::DoWhileStmt>(stmt);
    text = "do\n" + nested(loop.body) + "while (" + apart(*loop.condition, Binding::Comma) + ");\n";
    break;
  }
  case StmtKind::Switch:
    text = switchStatement(cast<typed::SwitchStmt>(stmt));
    break;
  case StmtKind::Break:
    text = "break;\n";
    mayHaveComment = true;
    break;
  case StmtKind::Continue:
    text = "continue;\n";
    mayHaveComment = true;
    break;
  case StmtKind::Return: {
    const auto &value = cast<typed::ReturnStmt>(stmt).value;
    text = value ? "return " + operand(*value, Binding::Assignment) + ";\n" : "return;\n";
    mayHaveComment = true;
    break;
  }
  case StmtKind::Illuminance:
    text = illuminance(cast<typed::IlluminanceStmt>(stmt));
    break;
  case StmtKind::Case:
  case StmtKind::Empty:
    text = ";\n";
    break;
  }
  before = outer;
  if (mayHaveComment && !text.empty())
    if (const std::string comment = module.notes.trailingComment(stmt.range); !comment.empty())
      text.insert(text.size() - 1, " " + comment);
  std::string result = module.commentText(stmt.comment) + module.lineDirective(stmt.range);
  for (const std::string &line : statements)
    result += line + "\n";
  return result + text;
}

// A body that takes several lines of C++ needs braces, whether the author wrote some or not.
std::string FunctionPrinter::nested(const typed::StmtPtr &stmt, bool needsBraces) {
  if (!stmt)
    return "{\n}\n";
  std::string text = statement(*stmt);
  if (stmt->kind == StmtKind::Compound && text.front() == '{')
    return text;
  const std::string single = text.substr(0, text.find('\n'));
  const bool isControl = stmt->kind == StmtKind::If || stmt->kind == StmtKind::For || stmt->kind == StmtKind::While ||
                         stmt->kind == StmtKind::DoWhile || stmt->kind == StmtKind::Switch ||
                         stmt->kind == StmtKind::Illuminance;
  const bool isSeveral = std::count(text.begin(), text.end(), '\n') > 1 || text == ";\n" || text.empty();
  if (needsBraces || stmt->kind == StmtKind::Declaration || (isSeveral && !isControl) || !stmt->comment.empty() ||
      text.front() == '#' || (isControl && text.compare(0, 2, "if") != 0 && text.compare(0, 3, "for") != 0 &&
                              text.compare(0, 5, "while") != 0 && text.compare(0, 2, "do") != 0 &&
                              text.compare(0, 6, "switch") != 0))
    return "{\n" + (text == ";\n" ? std::string() : text) + "}\n";
  return text;
}

//===----------------------------------------------------------------------===//
// Declarations and expressions
//===----------------------------------------------------------------------===//

std::string FunctionPrinter::declaration(const typed::DeclarationStmt &stmt, bool inHeader) {
  std::string text;
  std::string line; // declarators of one type share a line
  const Type *lineType = nullptr;
  std::string lineQualifier;
  auto finish = [&] {
    if (!line.empty())
      text += line + ";\n";
    line.clear();
  };
  for (const typed::Variable *variable : stmt.variables) {
    const std::size_t statementsBefore = before->size();
    const std::string &name = module.names.of(variable);
    std::string value = variable->init ? argument(*variable->init) : module.zero(variable->type);
    if (hoistedDeclarations.count(variable)) {
      finish();
      if (variable->init)
        text += name + " = " + value + ";\n";
      continue;
    }
    if (before->size() != statementsBefore && !line.empty()) { // what goes before must not overtake the others
      std::vector<std::string> added(before->begin() + static_cast<std::ptrdiff_t>(statementsBefore), before->end());
      before->resize(statementsBefore);
      finish();
      for (const std::string &statement : added)
        text += statement + "\n";
    } else if (before->size() != statementsBefore && !text.empty()) {
      std::vector<std::string> added(before->begin() + static_cast<std::ptrdiff_t>(statementsBefore), before->end());
      before->resize(statementsBefore);
      for (const std::string &statement : added)
        text += statement + "\n";
    }
    const bool isUnread = !readVariables.count(variable);
    const std::string qualifier = !variable->isConst                             ? ""
                                  : variable->init && isTable(*variable->init) ? "static constexpr "
                                                                                 : "const ";
    if (!line.empty() && (lineType != variable->type || lineQualifier != qualifier || isUnread))
      finish();
    const std::string declared = declarator(module.type(variable->type), name, value);
    if (line.empty()) {
      line = (isUnread ? "[[maybe_unused]] " : "") + qualifier +
             module.type(variable->type) + " " + declared;
      lineType = variable->type;
      lineQualifier = qualifier;
      if (isUnread)
        finish();
    } else {
      line += ", " + declared;
    }
  }
  if (inHeader) // one declaration, without its semicolon's line
    return text.empty() ? line : text + line;
  finish();
  return text;
}

std::string FunctionPrinter::expressionStatement(const typed::Expr &expr) {
  Code code;
  if (auto *value = dynCast<typed::AssignExpr>(&expr)) {
    code = assign(*value, false);
    const std::size_t middle = code.text.size() / 2;
    if (!value->compound && code.text.size() % 2 == 1 && code.text.size() > 3 &&
        code.text.compare(middle - 1, 3, " = ") == 0 &&
        code.text.compare(0, middle - 1, code.text.substr(middle + 2)) == 0)
      return ""; // `x = x`
  } else if (auto *value = dynCast<typed::IncDecExpr>(&expr)) {
    code = incDec(*value, false);
    const typed::Expr *vector = nullptr;
    if (components(*value->target, vector).size() > 1)
      return "";
  } else if (auto *comma = dynCast<typed::CommaExpr>(&expr)) { // two statements
    std::string left = expressionStatement(*comma->left);
    std::vector<std::string> statements;
    std::vector<std::string> *outer = before;
    before = &statements;
    std::string right = expressionStatement(*comma->right);
    before = outer;
    return left + (statements.empty() ? "" : join(statements, "\n") + "\n") + right;
  } else if (std::string answer = hitAnswer(expr); !answer.empty()) {
    return answer;
  } else {
    code = this->expr(expr);
    const bool isCall = expr.kind == ExprKind::Call || expr.kind == ExprKind::MethodCall || expr.kind == ExprKind::Builtin;
    if (!code.text.empty() && !expr.type->is(TypeKind::Void) &&
        (!isCall || code.text.find('(') == std::string::npos || module.effects.expression(expr).isPure()))
      code.text = "static_cast<void>(" + code.text + ")";
  }
  return code.text.empty() ? "" : code.text + ";\n";
}

//===----------------------------------------------------------------------===//
// Control
//===----------------------------------------------------------------------===//

std::string FunctionPrinter::ifStatement(const typed::IfStmt &stmt) {
  std::string text = "if (" + operand(*stmt.condition, Binding::Comma) + ")";
  // The comment behind the opening brace of the author's.
  std::string comment;
  if (stmt.thenStmt && stmt.thenStmt->kind == StmtKind::Compound)
    comment = module.notes.trailingComment({stmt.range.file, stmt.condition->range.begin, stmt.condition->range.end});
  const bool dangles = stmt.elseStmt && stmt.thenStmt && stmt.thenStmt->kind != StmtKind::Compound;
  const bool needsBraces = dangles && (stmt.thenStmt->kind == StmtKind::If || stmt.thenStmt->kind == StmtKind::For ||
                                       stmt.thenStmt->kind == StmtKind::While ||
                                       stmt.thenStmt->kind == StmtKind::Illuminance);
  std::string then = nested(stmt.thenStmt, needsBraces);
  if (!comment.empty() && then.front() == '{')
    then.insert(1, " " + comment);
  text += "\n" + then;
  if (stmt.elseStmt) {
    std::string otherwise = nested(stmt.elseStmt);
    text += "else " + otherwise;
  }
  return text;
}

// A counter that runs over a known interval cannot overflow.
void FunctionPrinter::noteCounter(const typed::ForStmt &stmt) {
  auto *declaration = dynCast<typed::DeclarationStmt>(stmt.init);
  auto *condition = dynCast<typed::BinaryExpr>(stmt.condition);
  auto *step = dynCast<typed::IncDecExpr>(stmt.step);
  if (!declaration || !condition || !step || !step->increment)
    return;
  auto *counter = dynCast<typed::VariableExpr>(condition->left);
  auto *stepped = dynCast<typed::VariableExpr>(step->target);
  const bool isBounded = condition->op == ast::BinaryOp::Less || condition->op == ast::BinaryOp::NotEqual ||
                         condition->op == ast::BinaryOp::LessEqual;
  if (!counter || !stepped || counter->variable != stepped->variable || !isBounded ||
      !counter->variable->type->is(TypeKind::Int))
    return;
  const auto &declared = declaration->variables;
  if (std::find(declared.begin(), declared.end(), counter->variable) == declared.end() || !counter->variable->init)
    return;
  if (stmt.body && assignedVariables(*stmt.body).count(counter->variable))
    return;
  const std::optional<Interval> first = range(*counter->variable->init);
  const std::optional<Interval> last = range(*condition->right);
  const bool isConstant = last && last->low == last->high;
  if (condition->op == ast::BinaryOp::Less) {
    // i < n <= INT_MAX
    counters[counter->variable] = {first ? first->low : std::numeric_limits<std::int32_t>::min(),
                                   last ? last->high : std::numeric_limits<std::int32_t>::max()};
  } else if (condition->op == ast::BinaryOp::LessEqual && last &&
             last->high < std::numeric_limits<std::int32_t>::max()) {
    counters[counter->variable] = {first ? first->low : std::numeric_limits<std::int32_t>::min(), last->high + 1};
  } else if (condition->op == ast::BinaryOp::NotEqual && isConstant && first && first->high <= last->low) {
    counters[counter->variable] = {first->low, last->high};
  }
}

std::string FunctionPrinter::forStatement(const typed::ForStmt &stmt) {
  noteCounter(stmt);
  std::string init, outside;
  if (auto *declaration = dynCast<typed::DeclarationStmt>(stmt.init)) {
    init = this->declaration(*declaration, true);
    if (const std::size_t last = init.rfind('\n'); last != std::string::npos) { // of several types
      outside = init.substr(0, last + 1);
      init = init.substr(last + 1);
    }
  } else if (auto *expression = dynCast<typed::ExpressionStmt>(stmt.init)) {
    init = apart(*expression->expr, Binding::Comma);
  }
  std::string condition = stmt.condition ? apart(*stmt.condition, Binding::Comma) : "";
  std::string step;
  if (stmt.step) {
    // In the step, results are not used.
    std::vector<std::string> statements;
    std::vector<std::string> *outer = before;
    before = &statements;
    std::function<std::string(const typed::Expr &)> print = [&](const typed::Expr &expr) -> std::string {
      if (auto *comma = dynCast<typed::CommaExpr>(&expr))
        return print(*comma->left) + ", " + print(*comma->right);
      if (auto *incDec = dynCast<typed::IncDecExpr>(&expr))
        return this->incDec(*incDec, false).text;
      if (auto *assignment = dynCast<typed::AssignExpr>(&expr))
        return this->assign(*assignment, false).text;
      std::string text = argument(expr);
      return module.effects.expression(expr).isPure() ? "static_cast<void>(" + text + ")" : text;
    };
    step = print(*stmt.step);
    before = outer;
    if (!statements.empty())
      step = "[&] { " + join(statements, " ") + (step.empty() ? "" : " static_cast<void>(" + step + ");") + " }()";
  }
  std::string text = "for (" + init + "; " + condition + "; " + step + ")\n" + nested(stmt.body);
  return outside.empty() ? text : "{\n" + outside + text + "}\n";
}

/// May control reach what stands behind the statements?
static bool mayComplete(const std::vector<typed::StmtPtr> &statements);
static bool mayComplete(const typed::Stmt *stmt) {
  if (!stmt)
    return true;
  switch (stmt->kind) {
  case StmtKind::Break:
  case StmtKind::Continue:
  case StmtKind::Return:
    return false;
  case StmtKind::Compound:
    return mayComplete(cast<typed::CompoundStmt>(*stmt).body);
  case StmtKind::If: {
    const auto &branch = cast<typed::IfStmt>(*stmt);
    return mayComplete(branch.thenStmt.get()) || mayComplete(branch.elseStmt.get());
  }
  default:
    return true;
  }
}
static bool mayComplete(const std::vector<typed::StmtPtr> &statements) {
  return std::all_of(statements.begin(), statements.end(),
                     [](const typed::StmtPtr &stmt) { return mayComplete(stmt.get()); });
}

// A variable that is declared in one arm is in sight in those below, which C++ lets nobody jump to:
// such variables are declared before the switch. If nobody below looks, the arm gets braces.
std::string FunctionPrinter::switchStatement(const typed::SwitchStmt &stmt) {
  std::string text, declared;
  std::vector<bool> needsBraces(stmt.arms.size(), false);
  for (std::size_t i = 0; i < stmt.arms.size(); ++i)
    for (const typed::StmtPtr &inner : stmt.arms[i].body)
      if (auto *declaration = dynCast<typed::DeclarationStmt>(inner))
        for (const typed::Variable *variable : declaration->variables) {
          bool isSeenBelow = false;
          for (std::size_t j = i + 1; j < stmt.arms.size(); ++j)
            for (const typed::StmtPtr &other : stmt.arms[j].body)
              forEachExpr(*other, [&](const typed::Expr &expr) {
                auto *use = dynCast<typed::VariableExpr>(&expr);
                isSeenBelow |= use && use->variable == variable;
              });
          if (!isSeenBelow) {
            needsBraces[i] = true;
            continue;
          }
          hoistedDeclarations.insert(variable);
          declared += module.type(variable->type) + " " + module.names.of(variable) + "{};\n";
        }
  text += "switch (" + operand(*stmt.value, Binding::Comma) + ") {\n";
  const bool isUnsigned = stmt.value->type->is(TypeKind::UInt);
  for (std::size_t i = 0; i < stmt.arms.size(); ++i) {
    const auto &arm = stmt.arms[i];
    std::vector<std::string> labels;
    for (std::int64_t value : arm.values)
      labels.push_back(isUnsigned ? fmt::format("case {}u:\n", static_cast<std::uint32_t>(value))
                       : value == std::numeric_limits<std::int32_t>::min()
                           ? std::string("case std::numeric_limits<int>::min():\n")
                           : fmt::format("case {}:\n", value));
    if (arm.isDefault)
      labels.emplace_back("default:\n");
    for (const std::string &label : labels)
      text += label;
    const std::size_t before = temporaries.size();
    const std::string body = block(arm.body);
    const bool isScope = needsBraces[i] || temporaries.size() != before;
    if (isScope)
      text.back() = ' ', text += "{\n";
    text += body;
    const bool fallsThrough = i + 1 < stmt.arms.size() && mayComplete(arm.body);
    if (fallsThrough)
      text += "[[fallthrough]];\n";
    else if (body.empty() && i + 1 == stmt.arms.size())
      text += "break;\n";
    if (isScope)
      text += "}\n";
  }
  text += "}\n";
  return declared.empty() ? text : "{\n" + declared + text + "}\n";
}

std::string FunctionPrinter::illuminance(const typed::IlluminanceStmt &stmt) {
  std::vector<const typed::Expr *> pointers = {stmt.point.get()};
  if (stmt.normal && stmt.angle) {
    pointers.push_back(stmt.normal.get());
    pointers.push_back(stmt.angle.get());
  }
  std::vector<std::string> args = operands(pointers, Binding::Assignment);
  if (stmt.angle)
    if (const auto *angle = dynCast<typed::LiteralExpr>(stmt.angle.get())) {
      constexpr float pi = 3.14159265358979323846F;
      const float known = std::min(std::max(angle->value.scalars.front().f, 0.0F), pi);
      args.push_back("/*cosine=*/" + floatText(device::cos(known)));
    }
  return "for (rtsl::Lights lights(rt, " + join(args, ", ") + "); lights.next();)\n" + nested(stmt.body);
}

} // namespace rtsl::cpp
