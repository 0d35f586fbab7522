#include "codegen/cpp/tree/Print.h"

#include <fmt/format.h>

namespace rtsl::cpp {

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
    return declarator.name + "(" + print(value->parts) + ")";
  // `Ray ray{a, b}` for `Ray ray = Ray{a, b}`
  if (value->is(ExpressionKind::List) && (value->name.empty() || value->name == type))
    return declarator.name + "{" + print(value->parts) + "}";
  if (value->is(ExpressionKind::Array) && value->name == type)
    return declarator.name + "{{" + print(value->parts) + "}}";
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

/// Do the statements need braces as the body of an `if` or a loop?
static bool needsBraces(const Statements &statements) {
  if (statements.size() != 1)
    return true;
  const Statement &only = statements.front();
  return only.is(StatementKind::Declaration) || only.is(StatementKind::Empty) ||
         only.is(StatementKind::Nothing) || only.is(StatementKind::Block) ||
         !only.comment.empty() || only.place;
}

void addComment(std::string &text, const std::string &comment) {
  text.pop_back(); // the end of the line
  const std::size_t column = text.size() - (text.rfind('\n') + 1) + 1;
  text += ' ';
  for (const char c : comment)
    text += c == '\n' ? "\n" + std::string(column, ' ') : std::string(1, c);
  text += '\n';
}

/// The body of an `if` or a loop, from its brace or the end of the line on.
static std::string under(const Statements &statements, bool hasBraces,
                         const std::string &trailing = {}) {
  if (!hasBraces && trailing.empty() && !needsBraces(statements))
    return "\n" + print(statements);
  std::string text = " {\n";
  if (!trailing.empty())
    addComment(text, trailing);
  return text + print(statements) + "}\n";
}

/// `else` belongs to the nearest `if`, so an `if` in the body of an `if` with `else` needs braces.
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

/// The statement up to the end of its last line, without the comments above and after it.
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
    addComment(text, statement.trailing);
  return (statement.comment.empty() ? "" : statement.comment + "\n") +
         (statement.place ? print(*statement.place) : "") + text;
}

std::string print(const Statements &statements) {
  std::string text;
  for (std::size_t i = 0; i < statements.size(); ++i)
    text += (statements[i].hasSpace && i > 0 ? "\n" : "") + print(statements[i]);
  return text;
}

} // namespace rtsl::cpp
