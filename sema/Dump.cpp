//===- Dump.cpp - the typed module as text --------------------------------===//
//
// One node per line, indented below its parent: `kind details : type`. The text depends only on the
// source.
//
//===----------------------------------------------------------------------===//
#include "sema/Sema.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Casting.h"
#include "sema/typed/TypeProperties.h"
#include "sema/typed/Walk.h"

#include <fmt/format.h>

namespace rtsl::typed {

namespace {

class Dumper {
public:
  std::string text;

  void module(const Module &module);

private:
  void line(const std::string &content) { text += std::string(2 * depth, ' ') + content + "\n"; }
  void comment(const std::string &comment);
  void member(const Member &member);
  void function(const Function &function);
  void variable(const Variable &variable);
  void stmt(const Stmt &stmt);
  void loop(const Stmt &stmt);
  void optional(const char *label, const Stmt *stmt);
  void optional(const char *label, const Expr *expr);
  void expr(const Expr &expr);

  unsigned depth = 0;

  struct Indent {
    explicit Indent(Dumper &dumper) : dumper(dumper) { ++dumper.depth; }
    ~Indent() { --dumper.depth; }
    Dumper &dumper;
  };
};

std::string scalarText(Constant::Scalar scalar, TypeKind kind) {
  switch (kind) {
  case TypeKind::Bool:
    return scalar.b ? "true" : "false";
  case TypeKind::Int:
    return fmt::format("{}", scalar.i);
  case TypeKind::UInt:
    return fmt::format("{}u", scalar.u);
  default: {
    std::string text = fmt::format("{}", scalar.f); // the shortest text that gives the same float
    if (text.find_first_of(".einf") == std::string::npos)
      text += ".0";
    return text;
  }
  }
}

void scalarKinds(const Type *type, std::vector<TypeKind> &kinds) {
  if (type->is(TypeKind::Array)) {
    for (std::uint32_t i = 0; i != type->count; ++i)
      scalarKinds(type->element, kinds);
  } else if (type->is(TypeKind::Struct)) {
    for (const Field &field : type->structure->fields)
      scalarKinds(field.type, kinds);
  } else if (type->scalar()) {
    kinds.insert(kinds.end(), type->componentCount(), type->scalar()->kind);
  }
}

std::string constantText(const Constant &constant, const Type *type) {
  std::vector<TypeKind> kinds;
  scalarKinds(type, kinds);
  kinds.resize(std::max(kinds.size(), constant.scalars.size()), TypeKind::Float); // colors
  std::string text;
  for (std::size_t i = 0; i != constant.scalars.size(); ++i)
    text += (i == 0 ? "" : ", ") + scalarText(constant.scalars[i], kinds[i]);
  return constant.scalars.size() == 1 ? text : "{" + text + "}";
}

const char *accessText(ast::Access access) {
  static const char *const texts[] = {"const", "public", "private", "scratch"};
  return texts[static_cast<int>(access)];
}

std::string parameterText(const Variable &parameter) {
  static const char *const directions[] = {"", "out ", "inout "};
  return std::string(parameter.isConst ? "const " : "") +
         directions[static_cast<int>(parameter.direction)] + toString(parameter.type) +
         (parameter.name.empty() ? "" : " " + parameter.name) +
         (parameter.values ? " in " + toString(*parameter.values) : "");
}

const char *opText(ast::BinaryOp op) {
  static const char *const spellings[] = {"*",  "/",  "%",  "+", "-", "<<", ">>", "<",  ">", "<=",
                                          ">=", "==", "!=", "&", "^", "|",  "&&", "^^", "||"};
  return spellings[static_cast<int>(op)];
}

} // namespace

void Dumper::comment(const std::string &comment) {
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    line(comment.substr(begin, end - begin));
    begin = end + 1;
  }
}

void Dumper::module(const Module &module) {
  for (const std::unique_ptr<Struct> &structure : module.structs) {
    comment(structure->comment);
    line("struct " + structure->name);
    Indent indent(*this);
    for (const Field &field : structure->fields)
      line("field " + field.name + " : " + toString(field.type));
  }
  for (const std::unique_ptr<Variable> &constant : module.constants) {
    comment(constant->comment);
    line("const " + constant->name +
         (constant->constant ? " = " + constantText(*constant->constant, constant->type) : "") +
         " : " + toString(constant->type));
  }
  for (const std::unique_ptr<Function> &free : module.functions)
    function(*free);
  for (const std::unique_ptr<Class> &type : module.classes) {
    comment(type->comment);
    line("class " + type->name + " : " + (type->base ? type->base->name + " : " : "") + type->root);
    Indent indent(*this);
    for (const std::unique_ptr<Member> &each : type->members)
      member(*each);
    for (const std::unique_ptr<Function> &each : type->functions)
      function(*each);
  }
}

void Dumper::member(const Member &member) {
  comment(member.comment);
  std::string value;
  if (member.constant)
    value = " = " + constantText(*member.constant, member.type);
  line(fmt::format("member {} {}{}{} : {}{}",
                   accessText(member.isConst ? ast::Access::None : member.access),
                   member.isOptional ? "optional " : "", member.name, value, toString(member.type),
                   member.values ? " in " + toString(*member.values) : ""));
  if (!member.constant && member.init) {
    Indent indent(*this);
    expr(*member.init);
  }
}

void Dumper::function(const Function &function) {
  comment(function.comment);
  std::string parameters;
  for (const std::unique_ptr<Variable> &parameter : function.parameters)
    parameters += (parameters.empty() ? "" : ", ") + parameterText(*parameter);
  const char *kind = function.isConstructor ? "" : function.isStateMethod ? "method " : "function ";
  line(fmt::format("{}{}({}) : {}{}", kind, function.name, parameters,
                   toString(function.returnType), function.sends.any() ? " traces" : ""));
  Indent indent(*this);
  if (function.body)
    for (const StmtPtr &inner : static_cast<const CompoundStmt &>(*function.body).body)
      stmt(*inner);
}

void Dumper::optional(const char *label, const Stmt *inner) {
  if (!inner)
    return;
  line(label);
  Indent indent(*this);
  stmt(*inner);
}

void Dumper::optional(const char *label, const Expr *inner) {
  if (!inner)
    return;
  line(label);
  Indent indent(*this);
  expr(*inner);
}

static std::string labelsOf(const SwitchStmt::Arm &arm) {
  std::string labels;
  for (std::int64_t value : arm.values)
    labels += (labels.empty() ? "case " : ", ") + std::to_string(value);
  if (arm.isDefault)
    labels += labels.empty() ? "default" : ", default";
  return labels;
}

void Dumper::variable(const Variable &variable) {
  const std::string value =
      variable.constant ? " = " + constantText(*variable.constant, variable.type) : "";
  line(fmt::format("{} {}{} : {}", variable.isConst ? "const" : "var", variable.name, value,
                   toString(variable.type)));
  Indent indent(*this);
  if (variable.init && !variable.constant)
    expr(*variable.init);
}

void Dumper::stmt(const Stmt &node) {
  comment(node.comment);
  switch (node.kind) {
  case ast::StmtKind::Compound: {
    line("block");
    Indent indent(*this);
    for (const StmtPtr &inner : cast<CompoundStmt>(node).body)
      stmt(*inner);
    return;
  }
  case ast::StmtKind::Declaration:
    for (const Variable *declared : cast<DeclarationStmt>(node).variables)
      variable(*declared);
    return;
  case ast::StmtKind::Expression:
    return expr(*cast<ExpressionStmt>(node).expr);
  case ast::StmtKind::If: {
    const auto &branch = cast<IfStmt>(node);
    line("if");
    Indent indent(*this);
    expr(*branch.condition);
    optional("then", branch.thenStmt.get());
    optional("else", branch.elseStmt.get());
    return;
  }
  case ast::StmtKind::For:
  case ast::StmtKind::While:
  case ast::StmtKind::DoWhile:
  case ast::StmtKind::Illuminance:
    return loop(node);
  case ast::StmtKind::Switch: {
    const auto &choice = cast<SwitchStmt>(node);
    line("switch");
    Indent indent(*this);
    expr(*choice.value);
    for (const SwitchStmt::Arm &arm : choice.arms) {
      line(labelsOf(arm));
      Indent inner(*this);
      for (const StmtPtr &each : arm.body)
        stmt(*each);
    }
    return;
  }
  case ast::StmtKind::Break:
    return line("break");
  case ast::StmtKind::Continue:
    return line("continue");
  case ast::StmtKind::Return: {
    line("return");
    Indent indent(*this);
    if (const ExprPtr &value = cast<ReturnStmt>(node).value)
      expr(*value);
    return;
  }
  default:
    return;
  }
}

void Dumper::loop(const Stmt &node) {
  switch (node.kind) {
  case ast::StmtKind::For: {
    const auto &of = cast<ForStmt>(node);
    line("for");
    Indent indent(*this);
    optional("init", of.init.get());
    optional("condition", of.condition.get());
    optional("step", of.step.get());
    optional("body", of.body.get());
    return;
  }
  case ast::StmtKind::While: {
    const auto &of = cast<WhileStmt>(node);
    line("while");
    Indent indent(*this);
    expr(*of.condition);
    optional("body", of.body.get());
    return;
  }
  case ast::StmtKind::DoWhile: {
    const auto &of = cast<DoWhileStmt>(node);
    line("do");
    Indent indent(*this);
    optional("body", of.body.get());
    optional("condition", of.condition.get());
    return;
  }
  case ast::StmtKind::Illuminance: {
    const auto &of = cast<IlluminanceStmt>(node);
    line("illuminance");
    Indent indent(*this);
    optional("point", of.point.get());
    optional("normal", of.normal.get());
    optional("angle", of.angle.get());
    optional("body", of.body.get());
    return;
  }
  default:
    return;
  }
}

/// What kind of expression it is, without its operands.
static std::string label(const Expr &e) {
  switch (e.kind) {
  case ExprKind::Literal:
    return "literal " + constantText(cast<LiteralExpr>(e).value, e.type);
  case ExprKind::Variable:
    return "variable " + cast<VariableExpr>(e).variable->name;
  case ExprKind::State:
    return std::string("state rt_") + name(cast<StateExpr>(e).variable);
  case ExprKind::Member:
    return "member " + cast<MemberExpr>(e).member->name;
  case ExprKind::Field: {
    const auto &field = cast<FieldExpr>(e);
    return "field ." + field.base->type->structure->fields[field.field].name;
  }
  case ExprKind::Swizzle: {
    std::string letters;
    for (std::uint8_t component : cast<SwizzleExpr>(e).components)
      letters += "xyzw"[component];
    return "swizzle ." + letters;
  }
  case ExprKind::Index:
    return "index";
  case ExprKind::Length:
    return "length";
  case ExprKind::Unary:
    return std::string("unary ") + "-!~"[static_cast<int>(cast<UnaryExpr>(e).op)];
  case ExprKind::IncDec: {
    const auto &incDec = cast<IncDecExpr>(e);
    return std::string(incDec.prefix ? "prefix " : "postfix ") + (incDec.increment ? "++" : "--");
  }
  case ExprKind::Binary:
    return std::string("binary ") + opText(cast<BinaryExpr>(e).op);
  case ExprKind::Assign: {
    const auto &assign = cast<AssignExpr>(e);
    return std::string("assign ") + (assign.compound ? opText(assign.op) : "") + "=";
  }
  case ExprKind::Conditional:
    return "conditional";
  case ExprKind::Comma:
    return "comma";
  case ExprKind::Convert:
    return cast<ConvertExpr>(e).isImplicit ? "convert implicit" : "convert";
  case ExprKind::Construct:
    return "construct";
  case ExprKind::Builtin:
    return std::string("builtin ") + name(cast<BuiltinExpr>(e).builtin);
  case ExprKind::Call: {
    const auto &call = cast<CallExpr>(e);
    const std::string on = call.isOfBase ? call.function->owner->name + "::"
                           : call.onSelf ? "self."
                                         : "";
    return "call " + on + call.function->name;
  }
  case ExprKind::MethodCall:
    return "call ." + cast<MethodCallExpr>(e).method;
  case ExprKind::String:
    return "string \"" + cast<StringExpr>(e).value + "\"";
  }
  return {};
}

void Dumper::expr(const Expr &e) {
  if (e.type->isError())
    return line("<error>");
  line(e.kind == ExprKind::String ? label(e) : label(e) + " : " + toString(e.type));
  Indent indent(*this);
  forEachChild(e, [&](const Expr &child) { expr(child); });
}

std::string dump(const Module &module) {
  Dumper dumper;
  dumper.module(module);
  return std::move(dumper.text);
}

} // namespace rtsl::typed
