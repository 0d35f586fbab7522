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
  void expression(const char *role, const Expr *expr);
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
  const auto head = [&](std::string_view text) { line(fmt::format("{}{}", role, text)); };
  switch (expr->kind) {
  case ExprKind::IntLiteral:
    head(fmt::format("int {}", as<IntLiteral>(*expr).spelling));
    break;
  case ExprKind::FloatLiteral:
    head(fmt::format("float {}{}", as<FloatLiteral>(*expr).spelling,
                     as<FloatLiteral>(*expr).suffix));
    break;
  case ExprKind::BoolLiteral:
    head(as<BoolLiteral>(*expr).value ? "bool true" : "bool false");
    break;
  case ExprKind::StringLiteral:
    head(fmt::format("string {}", quoted(as<StringLiteral>(*expr).value)));
    break;
  case ExprKind::Name:
    head(fmt::format("name {}", as<NameExpr>(*expr).name));
    break;
  case ExprKind::Error:
    head("error");
    break;
  case ExprKind::Paren: {
    head("paren");
    const Indent indent(depth);
    expression("", as<ParenExpr>(*expr).inner.get());
    break;
  }
  case ExprKind::Unary: {
    head(fmt::format("unary {}", spelling(as<UnaryExpr>(*expr).op)));
    const Indent indent(depth);
    expression("", as<UnaryExpr>(*expr).operand.get());
    break;
  }
  case ExprKind::Binary: {
    const auto &binary = as<BinaryExpr>(*expr);
    head(fmt::format("binary {}", spelling(binary.op)));
    const Indent indent(depth);
    expression("", binary.left.get());
    expression("", binary.right.get());
    break;
  }
  case ExprKind::Assign: {
    const auto &assign = as<AssignExpr>(*expr);
    head(fmt::format("assign {}=", assign.compound ? spelling(assign.op) : ""));
    const Indent indent(depth);
    expression("", assign.target.get());
    expression("", assign.value.get());
    break;
  }
  case ExprKind::Conditional: {
    const auto &conditional = as<ConditionalExpr>(*expr);
    head("conditional");
    const Indent indent(depth);
    expression("", conditional.condition.get());
    expression("true: ", conditional.whenTrue.get());
    expression("false: ", conditional.whenFalse.get());
    break;
  }
  case ExprKind::Comma: {
    head("comma");
    const Indent indent(depth);
    expression("", as<CommaExpr>(*expr).left.get());
    expression("", as<CommaExpr>(*expr).right.get());
    break;
  }
  case ExprKind::Call: {
    const auto &call = as<CallExpr>(*expr);
    head(fmt::format("call {}{}{}{}", call.receiver ? "." : "", call.base.text,
                     call.base.text.empty() ? "" : "::", call.callee.text));
    const Indent indent(depth);
    expression("receiver: ", call.receiver.get());
    expressions("", call.args);
    break;
  }
  case ExprKind::Construct: {
    const auto &construct = as<ConstructExpr>(*expr);
    head(fmt::format("construct {}", type(construct.type)));
    const Indent indent(depth);
    sizes(construct.type);
    expressions("", construct.args);
    break;
  }
  case ExprKind::Member: {
    head(fmt::format("member .{}", as<MemberExpr>(*expr).member.text));
    const Indent indent(depth);
    expression("", as<MemberExpr>(*expr).base.get());
    break;
  }
  case ExprKind::Index: {
    head("index");
    const Indent indent(depth);
    expression("", as<IndexExpr>(*expr).base.get());
    expression("", as<IndexExpr>(*expr).index.get());
    break;
  }
  case ExprKind::InitializerList: {
    head("list");
    const Indent indent(depth);
    expressions("", as<InitializerListExpr>(*expr).elements);
    break;
  }
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
    statements(as<CompoundStmt>(*stmt).body);
    break;
  case StmtKind::Declaration:
    for (const VariableDecl &declared : as<DeclarationStmt>(*stmt).variables)
      variable("variable", declared);
    break;
  case StmtKind::Expression: {
    line("expression");
    const Indent indent(depth);
    expression("", as<ExpressionStmt>(*stmt).expr.get());
    break;
  }
  case StmtKind::If: {
    const auto &branch = as<IfStmt>(*stmt);
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
    break;
  }
  case StmtKind::For: {
    const auto &loop = as<ForStmt>(*stmt);
    line("for");
    const Indent indent(depth);
    statement(loop.init.get());
    expression("condition: ", loop.condition.get());
    expression("step: ", loop.step.get());
    statement(loop.body.get());
    break;
  }
  case StmtKind::While: {
    line("while");
    const Indent indent(depth);
    expression("", as<WhileStmt>(*stmt).condition.get());
    statement(as<WhileStmt>(*stmt).body.get());
    break;
  }
  case StmtKind::DoWhile: {
    line("do");
    const Indent indent(depth);
    statement(as<DoWhileStmt>(*stmt).body.get());
    expression("while: ", as<DoWhileStmt>(*stmt).condition.get());
    break;
  }
  case StmtKind::Switch: {
    line("switch");
    {
      const Indent indent(depth);
      expression("", as<SwitchStmt>(*stmt).value.get());
    }
    statements(as<SwitchStmt>(*stmt).body);
    break;
  }
  case StmtKind::Case: {
    const Expr *value = as<CaseStmt>(*stmt).value.get();
    line(value ? "case" : "default");
    const Indent indent(depth);
    expression("", value);
    break;
  }
  case StmtKind::Break:
    line("break");
    break;
  case StmtKind::Continue:
    line("continue");
    break;
  case StmtKind::Return: {
    line("return");
    const Indent indent(depth);
    expression("", as<ReturnStmt>(*stmt).value.get());
    break;
  }
  case StmtKind::Illuminance: {
    line("illuminance");
    const Indent indent(depth);
    expressions("", as<IlluminanceStmt>(*stmt).args);
    statement(as<IlluminanceStmt>(*stmt).body.get());
    break;
  }
  case StmtKind::Empty:
    line("empty");
    break;
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
    line(fmt::format("class {}{}{}{}", declared.name.text, declared.base.text.empty() ? "" : " : ",
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
