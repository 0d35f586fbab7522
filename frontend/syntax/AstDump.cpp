//===- AstDump.cpp - the syntax tree as text ------------------------------===//
//
// One node per line, children indented below. Names, operators and values are printed as the author
// wrote them; so are comments.
//
//===----------------------------------------------------------------------===//
#include "frontend/syntax/Parser.h"

#include <algorithm>

namespace rtsl {

using namespace ast;

namespace {

class Dumper {
public:
  void unit(const TranslationUnit &unit);
  std::string take() { return std::move(out); }

private:
  struct Indent {
    explicit Indent(unsigned &depth) : depth(++depth) {}
    ~Indent() { --depth; }
    unsigned &depth;
  };

  void line(std::string_view text) {
    out.append(2 * depth, ' ');
    out += text;
    out += '\n';
  }
  void comment(const std::string &text);
  std::string type(const TypeName &type);
  void sizes(const TypeName &type);
  void variable(const char *what, const VariableDecl &variable);
  void function(const FunctionDecl &function);
  void statement(const Stmt *stmt);
  void statements(const std::vector<StmtPtr> &list);
  void branch(const IfStmt &branch);
  void loop(const Stmt &stmt);
  void expression(const char *role, const Expr *expr);
  std::string label(const Expr &expr);
  void operands(const Expr &expr);
  void expressions(const char *role, const std::vector<ExprPtr> &list);

  std::string out;
  unsigned depth = 0;
};

const char *spelling(BinaryOp op) {
  switch (op) {
  case BinaryOp::Mul:
    return "*";
  case BinaryOp::Div:
    return "/";
  case BinaryOp::Mod:
    return "%";
  case BinaryOp::Add:
    return "+";
  case BinaryOp::Sub:
    return "-";
  case BinaryOp::Shl:
    return "<<";
  case BinaryOp::Shr:
    return ">>";
  case BinaryOp::Less:
    return "<";
  case BinaryOp::Greater:
    return ">";
  case BinaryOp::LessEqual:
    return "<=";
  case BinaryOp::GreaterEqual:
    return ">=";
  case BinaryOp::Equal:
    return "==";
  case BinaryOp::NotEqual:
    return "!=";
  case BinaryOp::BitAnd:
    return "&";
  case BinaryOp::BitXor:
    return "^";
  case BinaryOp::BitOr:
    return "|";
  case BinaryOp::LogicalAnd:
    return "&&";
  case BinaryOp::LogicalXor:
    return "^^";
  case BinaryOp::LogicalOr:
    return "||";
  }
  return "?";
}

const char *spelling(UnaryOp op) {
  switch (op) {
  case UnaryOp::Plus:
    return "+";
  case UnaryOp::Minus:
    return "-";
  case UnaryOp::Not:
    return "!";
  case UnaryOp::BitNot:
    return "~";
  case UnaryOp::PreIncrement:
    return "prefix ++";
  case UnaryOp::PreDecrement:
    return "prefix --";
  case UnaryOp::PostIncrement:
    return "postfix ++";
  case UnaryOp::PostDecrement:
    return "postfix --";
  }
  return "?";
}

std::string quoted(const std::string &text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '\n')
      result += "\\n";
    else if (c == '\t')
      result += "\\t";
    else
      result += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  return result + '"';
}

template <typename T>
const T &as(const Expr &expr) {
  return static_cast<const T &>(expr);
}
template <typename T>
const T &as(const Stmt &stmt) {
  return static_cast<const T &>(stmt);
}

void Dumper::comment(const std::string &text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    line(std::string_view(text).substr(at, end - at));
    at = end + 1;
  }
}

/// The type with its dimensions; sizes other than a number or a name follow as children (`sizes`).
std::string Dumper::type(const TypeName &type) {
  std::string text = type.name.text;
  for (const ArrayDimension &dimension : type.dimensions) {
    text += '[';
    if (dimension.size && dimension.size->kind == ExprKind::IntLiteral)
      text += as<IntLiteral>(*dimension.size).spelling;
    else if (dimension.size && dimension.size->kind == ExprKind::Name)
      text += as<NameExpr>(*dimension.size).name;
    else if (dimension.size)
      text += "...";
    text += ']';
  }
  return text;
}

void Dumper::sizes(const TypeName &type) {
  for (const ArrayDimension &dimension : type.dimensions)
    if (dimension.size && dimension.size->kind != ExprKind::IntLiteral &&
        dimension.size->kind != ExprKind::Name)
      expression("size: ", dimension.size.get());
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

void Dumper::expressions(const char *role, const std::vector<ExprPtr> &list) {
  for (const ExprPtr &expr : list)
    expression(role, expr.get());
}

void Dumper::expression(const char *role, const Expr *expr) {
  if (!expr)
    return;
  line(role + label(*expr));
  const Indent indent(depth);
  operands(*expr);
}

/// The line of an expression, without its operands.
std::string Dumper::label(const Expr &expr) {
  switch (expr.kind) {
  case ExprKind::IntLiteral:
    return fmt::format("int {}", as<IntLiteral>(expr).spelling);
  case ExprKind::FloatLiteral:
    return fmt::format("float {}{}", as<FloatLiteral>(expr).spelling,
                       as<FloatLiteral>(expr).suffix);
  case ExprKind::BoolLiteral:
    return as<BoolLiteral>(expr).value ? "bool true" : "bool false";
  case ExprKind::StringLiteral:
    return fmt::format("string {}", quoted(as<StringLiteral>(expr).value));
  case ExprKind::Name:
    return fmt::format("name {}", as<NameExpr>(expr).name);
  case ExprKind::Error:
    return "error";
  case ExprKind::Paren:
    return "paren";
  case ExprKind::Unary:
    return fmt::format("unary {}", spelling(as<UnaryExpr>(expr).op));
  case ExprKind::Binary:
    return fmt::format("binary {}", spelling(as<BinaryExpr>(expr).op));
  case ExprKind::Assign: {
    const auto &assign = as<AssignExpr>(expr);
    return fmt::format("assign {}=", assign.compound ? spelling(assign.op) : "");
  }
  case ExprKind::Conditional:
    return "conditional";
  case ExprKind::Comma:
    return "comma";
  case ExprKind::Call: {
    const auto &call = as<CallExpr>(expr);
    return fmt::format("call {}{}{}{}", call.receiver ? "." : "", call.base.text,
                       call.base.text.empty() ? "" : "::", call.callee.text);
  }
  case ExprKind::Construct:
    return fmt::format("construct {}", type(as<ConstructExpr>(expr).type));
  case ExprKind::Member:
    return fmt::format("member .{}", as<MemberExpr>(expr).member.text);
  case ExprKind::Index:
    return "index";
  case ExprKind::InitializerList:
    return "list";
  }
  return {};
}

void Dumper::operands(const Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Paren:
    return expression("", as<ParenExpr>(expr).inner.get());
  case ExprKind::Unary:
    return expression("", as<UnaryExpr>(expr).operand.get());
  case ExprKind::Binary:
    expression("", as<BinaryExpr>(expr).left.get());
    return expression("", as<BinaryExpr>(expr).right.get());
  case ExprKind::Assign:
    expression("", as<AssignExpr>(expr).target.get());
    return expression("", as<AssignExpr>(expr).value.get());
  case ExprKind::Conditional:
    expression("", as<ConditionalExpr>(expr).condition.get());
    expression("true: ", as<ConditionalExpr>(expr).whenTrue.get());
    return expression("false: ", as<ConditionalExpr>(expr).whenFalse.get());
  case ExprKind::Comma:
    expression("", as<CommaExpr>(expr).left.get());
    return expression("", as<CommaExpr>(expr).right.get());
  case ExprKind::Call:
    expression("receiver: ", as<CallExpr>(expr).receiver.get());
    return expressions("", as<CallExpr>(expr).args);
  case ExprKind::Construct:
    sizes(as<ConstructExpr>(expr).type);
    return expressions("", as<ConstructExpr>(expr).args);
  case ExprKind::Member:
    return expression("", as<MemberExpr>(expr).base.get());
  case ExprKind::Index:
    expression("", as<IndexExpr>(expr).base.get());
    return expression("", as<IndexExpr>(expr).index.get());
  case ExprKind::InitializerList:
    return expressions("", as<InitializerListExpr>(expr).elements);
  default: // literals and names
    return;
  }
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

void Dumper::statements(const std::vector<StmtPtr> &list) {
  const Indent indent(depth);
  for (const StmtPtr &stmt : list)
    statement(stmt.get());
}

void Dumper::statement(const Stmt *stmt) {
  if (!stmt)
    return;
  comment(stmt->comment);
  switch (stmt->kind) {
  case StmtKind::Compound:
    line("block");
    return statements(as<CompoundStmt>(*stmt).body);
  case StmtKind::Declaration:
    for (const VariableDecl &declared : as<DeclarationStmt>(*stmt).variables)
      variable("variable", declared);
    return;
  case StmtKind::Expression: {
    line("expression");
    const Indent indent(depth);
    return expression("", as<ExpressionStmt>(*stmt).expr.get());
  }
  case StmtKind::If:
    return branch(as<IfStmt>(*stmt));
  case StmtKind::For:
  case StmtKind::While:
  case StmtKind::DoWhile:
  case StmtKind::Illuminance:
    return loop(*stmt);
  case StmtKind::Switch: {
    line("switch");
    {
      const Indent indent(depth);
      expression("", as<SwitchStmt>(*stmt).value.get());
    }
    return statements(as<SwitchStmt>(*stmt).body);
  }
  case StmtKind::Case: {
    const Expr *value = as<CaseStmt>(*stmt).value.get();
    line(value ? "case" : "default");
    const Indent indent(depth);
    return expression("", value);
  }
  case StmtKind::Break:
    return line("break");
  case StmtKind::Continue:
    return line("continue");
  case StmtKind::Return: {
    line("return");
    const Indent indent(depth);
    return expression("", as<ReturnStmt>(*stmt).value.get());
  }
  case StmtKind::Empty:
    return line("empty");
  }
}

void Dumper::branch(const IfStmt &branch) {
  line("if");
  {
    const Indent indent(depth);
    expression("", branch.condition.get());
    statement(branch.thenStmt.get());
  }
  if (branch.elseStmt) {
    line("else");
    const Indent indent(depth);
    statement(branch.elseStmt.get());
  }
}

void Dumper::loop(const Stmt &stmt) {
  switch (stmt.kind) {
  case StmtKind::For: {
    const auto &loop = as<ForStmt>(stmt);
    line("for");
    const Indent indent(depth);
    statement(loop.init.get());
    expression("condition: ", loop.condition.get());
    expression("step: ", loop.step.get());
    return statement(loop.body.get());
  }
  case StmtKind::While: {
    line("while");
    const Indent indent(depth);
    expression("", as<WhileStmt>(stmt).condition.get());
    return statement(as<WhileStmt>(stmt).body.get());
  }
  case StmtKind::DoWhile: {
    line("do");
    const Indent indent(depth);
    statement(as<DoWhileStmt>(stmt).body.get());
    return expression("while: ", as<DoWhileStmt>(stmt).condition.get());
  }
  case StmtKind::Illuminance: {
    line("illuminance");
    const Indent indent(depth);
    expressions("", as<IlluminanceStmt>(stmt).args);
    return statement(as<IlluminanceStmt>(stmt).body.get());
  }
  default:
    return;
  }
}

//===----------------------------------------------------------------------===//
// Declarations
//===----------------------------------------------------------------------===//

void Dumper::variable(const char *what, const VariableDecl &variable) {
  comment(variable.comment);
  std::string text = what;
  text += variable.access == Access::Public    ? " public"
          : variable.access == Access::Private ? " private"
          : variable.access == Access::Scratch ? " scratch"
                                               : "";
  text += variable.isConst ? " const" : "";
  text += variable.optionalRange.isValid() ? " optional" : "";
  text += variable.direction == Direction::Out     ? " out"
          : variable.direction == Direction::InOut ? " inout"
                                                   : "";
  text += fmt::format(" {} {}", type(variable.type), variable.name.text);
  line(variable.name.text.empty() ? std::string_view(text).substr(0, text.size() - 1)
                                  : std::string_view(text));
  const Indent indent(depth);
  sizes(variable.type);
  if (variable.values.isGiven()) {
    expression(variable.values.includesLow ? "from " : "above ", variable.values.low.get());
    expression(variable.values.includesHigh ? "to " : "below ", variable.values.high.get());
  }
  expression("", variable.init.get());
}

void Dumper::function(const FunctionDecl &function) {
  comment(function.comment);
  line(fmt::format("{} {} {}", function.body ? "function" : "prototype", type(function.returnType),
                   function.name.text));
  const Indent indent(depth);
  sizes(function.returnType);
  for (const VariableDecl &parameter : function.parameters)
    variable("parameter", parameter);
  if (function.body)
    statement(function.body.get());
}

void Dumper::unit(const TranslationUnit &unit) {
  line("unit");
  const Indent indent(depth);
  comment(unit.comment);
  for (const ImportDecl &import : unit.imports)
    line(fmt::format("import {}", import.isFile ? quoted(import.path) : import.path));
  for (const StructDecl &declared : unit.structs) {
    comment(declared.comment);
    line(fmt::format("struct {}", declared.name.text));
    const Indent inner(depth);
    for (const VariableDecl &field : declared.fields)
      variable("field", field);
  }
  for (const VariableDecl &constant : unit.constants)
    variable("constant", constant);
  for (const FunctionDecl &declared : unit.functions)
    function(declared);
  for (const ClassDecl &declared : unit.classes) {
    comment(declared.comment);
    line(fmt::format("{}class {}{}{}{}", declared.defaultRange.isValid() ? "default " : "",
                     declared.name.text, declared.base.text.empty() ? "" : " : ",
                     declared.base.text, declared.fileForm ? " (to the end of the file)" : ""));
    const Indent inner(depth);
    for (const VariableDecl &member : declared.members)
      variable("member", member);
    for (const FunctionDecl &member : declared.functions)
      function(member);
  }
}

} // namespace

std::string dump(const TranslationUnit &unit) {
  Dumper dumper;
  dumper.unit(unit);
  return dumper.take();
}

} // namespace rtsl
