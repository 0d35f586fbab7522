#include "codegen/cpp/tree/Print.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

//===----------------------------------------------------------------------===//
// Parentheses
//===----------------------------------------------------------------------===//

static Binding tighter(Binding binding) {
  return static_cast<Binding>(static_cast<int>(binding) + 1);
}

static bool isBinary(const Code &code, Operator op) {
  return code->is(ExpressionKind::Binary) && code->op == op;
}

/// How tightly an operand of `op` binds at least, if it stands without parentheses. Some are there
/// for readers and for compilers that warn: operators whose order is not common knowledge, and &&
/// beside ||.
static Binding needed(Operator op, const Code &operand, bool isRight) {
  const Binding own = bindingOf(op);
  const bool isSame = !isRight && isBinary(operand, op);
  if (op == Operator::And || op == Operator::Or)
    return isSame ? own : Binding::BitOr;
  if (op == Operator::BitAnd || op == Operator::BitOr || op == Operator::BitXor)
    return isSame ? own : Binding::Unary;
  if (own == Binding::Equality || own == Binding::Relation || own == Binding::Shift)
    return Binding::Unary;
  return isRight ? tighter(own) : own;
}

/// Does its text begin with a minus sign?
static bool beginsWithMinus(const Code &code) {
  switch (code->kind) {
  case ExpressionKind::Unary:
    return code->unary == UnaryOperator::Minus || code->unary == UnaryOperator::Decrement;
  case ExpressionKind::Binary: {
    const Code &left = code->parts[0];
    return bindingOf(left) >= needed(code->op, left, false) && beginsWithMinus(left);
  }
  case ExpressionKind::Postfix:
  case ExpressionKind::Member:
  case ExpressionKind::MemberOfPointer:
  case ExpressionKind::Subscript:
    return false; // what they are of binds more tightly than a sign
  default:
    return false;
  }
}

static std::string inParentheses(const std::string &text) {
  return "(" + text + ")";
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

static std::string quoted(const std::string &text) {
  std::string literal = "\"";
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      literal += std::string("\\") + c;
    else if (c == '\n')
      literal += "\\n";
    else if (byte < 0x20 || byte == 0x7f)
      literal += fmt::format("\\{:03o}", byte);
    else
      literal += c;
  }
  return literal + "\"";
}

static std::string arguments(const std::vector<Code> &codes, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < codes.size(); ++i)
    text += (i == first ? "" : ", ") + print(codes[i], Binding::Assignment);
  return text;
}

static std::string printBinary(const ExpressionNode &node) {
  const Code &left = node.parts[0], &right = node.parts[1];
  std::string second = print(right, needed(node.op, right, true));
  const bool isSum = node.op == Operator::Add || node.op == Operator::Subtract;
  if (isSum && bindingOf(right) >= needed(node.op, right, true) && beginsWithMinus(right))
    second = inParentheses(second); // a - -b
  return print(left, needed(node.op, left, false)) + " " + spelling(node.op) + " " + second;
}

static std::string printUnary(const ExpressionNode &node) {
  const Code &operand = node.parts[0];
  const std::string text = print(operand, Binding::Unary);
  const bool isDouble = node.unary == UnaryOperator::Minus &&
                        bindingOf(operand) >= Binding::Unary && beginsWithMinus(operand);
  return spelling(node.unary) + (isDouble ? inParentheses(text) : text);
}

static std::string printBare(const Code &code) {
  const ExpressionNode &node = *code;
  auto part = [&](std::size_t i, Binding atLeast) { return print(node.parts[i], atLeast); };
  switch (node.kind) {
  case ExpressionKind::Name:
  case ExpressionKind::Literal:
    return node.name;
  case ExpressionKind::String:
    return quoted(node.name);
  case ExpressionKind::Member:
    return part(0, Binding::Primary) + "." + node.name;
  case ExpressionKind::MemberOfPointer:
    return part(0, Binding::Primary) + "->" + node.name;
  case ExpressionKind::Subscript:
    return part(0, Binding::Primary) + "[" + part(1, Binding::Comma) + "]";
  case ExpressionKind::Call:
    return part(0, Binding::Primary) + "(" + arguments(node.parts, 1) + ")";
  case ExpressionKind::Construct:
    return node.name + "(" + arguments(node.parts, 0) + ")";
  case ExpressionKind::List:
    return node.name + "{" + arguments(node.parts, 0) + "}";
  case ExpressionKind::Array:
    return node.name + "{{" + arguments(node.parts, 0) + "}}";
  case ExpressionKind::Cast:
    return "static_cast<" + node.name + ">(" + part(0, Binding::Comma) + ")";
  case ExpressionKind::Unary:
    return printUnary(node);
  case ExpressionKind::Postfix:
    return part(0, Binding::Primary) + spelling(node.unary);
  case ExpressionKind::Binary:
    return printBinary(node);
  case ExpressionKind::Assign:
    return part(0, Binding::Unary) + " " + (node.compound ? spelling(node.op) : "") + "= " +
           part(1, Binding::Assignment);
  case ExpressionKind::Conditional:
    return part(0, Binding::Or) + " ? " + part(1, Binding::Assignment) + " : " +
           part(2, Binding::Assignment);
  case ExpressionKind::Comma:
    return part(0, Binding::Comma) + ", " + part(1, Binding::Assignment);
  case ExpressionKind::Parentheses:
    return inParentheses(part(0, Binding::Comma));
  case ExpressionKind::Lambda: {
    std::string body; // on the line of the expression, if the formatter leaves it there
    for (const Statement &statement : *node.statements)
      body += print(statement);
    std::replace(body.begin(), body.end(), '\n', ' ');
    return "[&] { " + body + "}()";
  }
  case ExpressionKind::Remark:
    return "/*" + node.name + "*/" + printBare(node.parts[0]);
  }
  return {};
}

std::string print(const Code &code, Binding atLeast) {
  if (!code)
    return {};
  const std::string text = printBare(code);
  return bindingOf(code) < atLeast ? inParentheses(text) : text;
}

std::string print(const std::vector<Code> &codes) {
  return arguments(codes, 0);
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

std::string print(const SourcePlace &place) {
  std::string file;
  for (char c : place.file) {
    if (c == '\\' || c == '"')
      file += '\\';
    file += c;
  }
  return fmt::format("#line {} \"{}\"\n", place.line, file);
}

std::string print(const Declarator &declarator, const std::string &type) {
  const Code &value = declarator.value;
  if (!value)
    return declarator.name;
  if (declarator.isCArray)
    return declarator.name + "[] = " + print(value, Binding::Assignment);
  if (declarator.isDirect)
    return declarator.name + "(" + arguments(value->parts, 0) + ")";
  // `Ray ray{a, b}` for `Ray ray = Ray{a, b}`
  if (value->is(ExpressionKind::List) && (value->name.empty() || value->name == type))
    return declarator.name + "{" + arguments(value->parts, 0) + "}";
  if (value->is(ExpressionKind::Array) && value->name == type)
    return declarator.name + "{{" + arguments(value->parts, 0) + "}}";
  return declarator.name + " = " + print(value, Binding::Assignment);
}

static bool isControl(const Statement &statement) {
  switch (statement.kind) {
  case StatementKind::If:
  case StatementKind::For:
  case StatementKind::While:
  case StatementKind::DoWhile:
  case StatementKind::Switch:
    return true;
  default:
    return false;
  }
}

/// Need the statements braces where they stand under an `if` or a loop?
static bool needsBraces(const Statements &statements) {
  if (statements.size() != 1)
    return true;
  const Statement &only = statements.front();
  return only.is(StatementKind::Declaration) || only.is(StatementKind::Empty) ||
         only.is(StatementKind::Nothing) || only.is(StatementKind::Block) ||
         !only.comment.empty() || only.place;
}

/// What stands under an `if` or a loop, from its brace or its line on.
static std::string under(const Statements &statements, bool hasBraces,
                         const std::string &trailing = {}) {
  if (!hasBraces && trailing.empty() && !needsBraces(statements))
    return "\n" + print(statements);
  return " {" + (trailing.empty() ? "" : " " + trailing) + "\n" + print(statements) + "}\n";
}

/// `else` belongs to the nearest `if`; so one under an `if` with `else` gets braces.
static bool mayCatchElse(const Statements &statements) {
  return statements.size() == 1 && isControl(statements.front()) &&
         !statements.front().is(StatementKind::Switch) &&
         !statements.front().is(StatementKind::DoWhile);
}

static std::string printIf(const Statement &statement) {
  const bool hasElse = !statement.otherwise.empty() || statement.otherwiseHasBraces;
  const bool hasBraces = statement.hasBraces || (hasElse && mayCatchElse(statement.body));
  std::string text =
      "if (" + print(statement.value) + ")" + under(statement.body, hasBraces, statement.trailing);
  if (!hasElse)
    return text;
  const Statements &otherwise = statement.otherwise;
  if (!statement.otherwiseHasBraces && !needsBraces(otherwise) &&
      otherwise.front().is(StatementKind::If))
    return text + "else " + print(otherwise);
  return text + "else" + under(otherwise, statement.otherwiseHasBraces);
}

static std::string printDeclaration(const Statement &statement) {
  std::string text = statement.qualifiers.empty() ? "" : statement.qualifiers + " ";
  text += statement.type + " ";
  for (std::size_t i = 0; i < statement.declarators.size(); ++i)
    text += (i == 0 ? "" : ", ") + print(statement.declarators[i], statement.type);
  return text;
}

static std::string printFor(const Statement &statement) {
  std::string text = "for (";
  if (!statement.init.empty()) {
    const Statement &init = statement.init.front();
    text += init.is(StatementKind::Declaration) ? printDeclaration(init) : print(init.value);
  }
  text += "; " + print(statement.value) + "; " + print(statement.step) + ")";
  return text + under(statement.body, statement.hasBraces);
}

static std::string printSwitch(const Statement &statement) {
  std::string text = "switch (" + print(statement.value) + ") {\n";
  for (const Arm &arm : statement.arms) {
    std::vector<std::string> labels;
    for (const Code &label : arm.labels)
      labels.push_back("case " + print(label) + ":");
    if (arm.isDefault)
      labels.emplace_back("default:");
    text += fmt::format("{}{}\n", fmt::join(labels, "\n"), arm.hasBraces ? " {" : "");
    text += print(arm.body) + (arm.hasBraces ? "}\n" : "");
  }
  return text + "}\n";
}

/// The statement with the end of its last line, without what stands above and after it.
static std::string printBare(const Statement &statement) {
  switch (statement.kind) {
  case StatementKind::Expression:
    return print(statement.value) + ";\n";
  case StatementKind::Declaration:
    return printDeclaration(statement) + ";\n";
  case StatementKind::If:
    return printIf(statement);
  case StatementKind::For:
    return printFor(statement);
  case StatementKind::While:
    return "while (" + print(statement.value) + ")" + under(statement.body, statement.hasBraces);
  case StatementKind::DoWhile:
    return "do" + under(statement.body, statement.hasBraces) + "while (" + print(statement.value) +
           ");\n";
  case StatementKind::Switch:
    return printSwitch(statement);
  case StatementKind::Return:
    return statement.value ? "return " + print(statement.value) + ";\n" : "return;\n";
  case StatementKind::Break:
    return "break;\n";
  case StatementKind::Continue:
    return "continue;\n";
  case StatementKind::Fallthrough:
    return "[[fallthrough]];\n";
  case StatementKind::Block:
    return "{\n" + print(statement.body) + "}\n";
  case StatementKind::Empty:
    return ";\n";
  case StatementKind::Nothing:
    return {};
  }
  return {};
}

std::string print(const Statement &statement) {
  std::string text = printBare(statement);
  if (!statement.trailing.empty() && !statement.is(StatementKind::If) && !text.empty())
    text.insert(text.size() - 1, " " + statement.trailing);
  return (statement.comment.empty() ? "" : statement.comment + "\n") +
         (statement.place ? print(*statement.place) : "") + text;
}

std::string print(const Statements &statements) {
  std::string text;
  for (std::size_t i = 0; i < statements.size(); ++i)
    text += (statements[i].hasSpace && i > 0 ? "\n" : "") + print(statements[i]);
  return text;
}

//===----------------------------------------------------------------------===//
// Declarations
//===----------------------------------------------------------------------===//

/// A word and the space after it; nothing if there is no word.
static std::string before(const std::string &word) {
  return word.empty() ? word : word + " ";
}

static std::string print(const Parameter &parameter) {
  static constexpr const char *marks[] = {" ", " &", " *"};
  return std::string(parameter.isUnread ? "[[maybe_unused]] " : "") +
         (parameter.isConst ? "const " : "") + parameter.type +
         marks[static_cast<int>(parameter.pass)] +
         (parameter.isCommented && !parameter.name.empty() ? "/*" + parameter.name + "*/"
                                                           : parameter.name);
}

static std::string print(const Function &function) {
  std::string text =
      function.templateParameters.empty() ? "" : "template <" + function.templateParameters + ">\n";
  text += before(function.specifiers) + function.result + " " + function.name + "(";
  for (std::size_t i = 0; i < function.parameters.size(); ++i)
    text += (i == 0 ? "" : ", ") + print(function.parameters[i]);
  text += std::string(")") + (function.isConst ? " const" : "") +
          (function.isOverride ? " override" : "");
  if (!function.body)
    return text + ";\n";
  if (!function.caught.empty())
    return text + " try {\n" + print(*function.body) + "} catch (const " + function.caught +
           " &) {\n}\n";
  return text + " {\n" + print(*function.body) + "}\n";
}

static std::string print(const Variable &variable) {
  return before(variable.qualifiers) + variable.type + " " +
         print(variable.declarator, variable.type) +
         (variable.bits != 0 ? fmt::format(" : {}", variable.bits) : "") + ";\n";
}

static std::string print(const Struct &structure) {
  const std::string head =
      "struct " + structure.name + (structure.base.empty() ? "" : " : " + structure.base);
  return structure.isOnlyDeclared ? head + ";\n"
                                  : head + " {\n" + print(structure.members) + "};\n";
}

static std::string print(const Enum &enumeration) {
  std::vector<std::string> values;
  for (const Enumerator &one : enumeration.values)
    values.push_back(one.value ? fmt::format("{} = {}", one.name, *one.value) : one.name);
  return fmt::format("enum class {} : {} {{ {} }};\n", enumeration.name, enumeration.underlying,
                     fmt::join(values, ", "));
}

static std::string print(const Namespace &space) {
  return "namespace " + before(space.name) + "{\n\n" + print(space.members) + "\n} // namespace" +
         (space.name.empty() ? "" : " " + space.name) + "\n";
}

static std::string print(const Alias &alias) {
  return "using " + alias.name + " = " + alias.type + ";\n";
}

static std::string print(const Using &named) {
  return "using " + named.name + ";\n";
}

static std::string print(const Include &include) {
  return "#include <" + include.file + ">\n";
}

static std::string print(const Define &macro) {
  return "#define " + macro.name + "\n";
}

static std::string print(const OnlyComment &) {
  return {};
}

std::string print(const Declaration &declaration) {
  std::string text = std::visit([](const auto &what) { return print(what); }, declaration.what);
  if (!declaration.trailing.empty())
    text.insert(text.size() - 1, " " + declaration.trailing);
  return (declaration.comment.empty() ? "" : declaration.comment + "\n") +
         (declaration.place ? print(*declaration.place) : "") + text;
}

std::string print(const Declarations &declarations) {
  std::string text;
  for (std::size_t i = 0; i < declarations.size(); ++i)
    text += (declarations[i].hasSpace && i > 0 ? "\n" : "") + print(declarations[i]);
  return text;
}

} // namespace rtsl::cpp
