#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

Statement simple(StatementKind kind) {
  Statement made;
  made.kind = kind;
  return made;
}

Statement statement(Code expression) {
  Statement made = simple(StatementKind::Expression);
  made.value = std::move(expression);
  return made;
}

Statement declaration(std::string qualifiers, std::string type, std::string name, Code value) {
  Statement made = simple(StatementKind::Declaration);
  made.qualifiers = std::move(qualifiers);
  made.type = std::move(type);
  made.declarators.push_back({std::move(name), std::move(value)});
  return made;
}

Statement declaration(std::string type, std::string name, Code value) {
  return declaration({}, std::move(type), std::move(name), std::move(value));
}

Statement returning(Code value) {
  Statement made = simple(StatementKind::Return);
  made.value = std::move(value);
  return made;
}

Statement block(Statements body) {
  Statement made = simple(StatementKind::Block);
  made.body = std::move(body);
  return made;
}

Statement branch(Code condition, Statements then, bool hasBraces) {
  Statement made = simple(StatementKind::If);
  made.value = std::move(condition);
  made.body = std::move(then);
  made.hasBraces = hasBraces;
  return made;
}

Statement loop(Code condition, Statements body, bool hasBraces) {
  Statement made = simple(StatementKind::While);
  made.value = std::move(condition);
  made.body = std::move(body);
  made.hasBraces = hasBraces;
  return made;
}

void append(Statements &statements, const Statements &more) {
  statements.insert(statements.end(), more.begin(), more.end());
}

static const ExpressionNode *assignmentIn(const Statement &statement) {
  const bool isAssignment = statement.is(StatementKind::Expression) && statement.value &&
                            statement.value->is(ExpressionKind::Assign);
  return isAssignment ? &*statement.value : nullptr;
}

std::string assignedName(const Statement &statement) {
  const ExpressionNode *assignment = assignmentIn(statement);
  return assignment && isName(assignment->parts[0]) ? assignment->parts[0]->name : std::string();
}

Code assignedValue(const Statement &statement) {
  const ExpressionNode *assignment = assignmentIn(statement);
  if (!assignment)
    return {};
  return assignment->compound ? binary(assignment->op, assignment->parts[0], assignment->parts[1])
                              : assignment->parts[1];
}

const void *assignedVariable(const Statement &statement) {
  return assignmentIn(statement) && statement.field.all.empty() ? statement.written.identity
                                                                : nullptr;
}

void forEachPart(const Statement &statement,
                 const std::function<void(const ExpressionNode &)> &visit) {
  auto all = [&](const Statements &statements) {
    for (const Statement &inner : statements)
      forEachPart(inner, visit);
  };
  all(statement.init);
  forEachPart(statement.value, visit);
  forEachPart(statement.step, visit);
  for (const Declarator &declarator : statement.declarators)
    forEachPart(declarator.value, visit);
  all(statement.body);
  all(statement.otherwise);
  for (const Arm &arm : statement.arms) {
    for (const Code &label : arm.labels)
      forEachPart(label, visit);
    all(arm.body);
  }
}

unsigned countMentions(const Statement &statement, const std::string &name) {
  unsigned count = 0;
  forEachPart(statement, [&](const ExpressionNode &part) {
    count += part.is(ExpressionKind::Name) && part.name == name;
  });
  return count;
}

unsigned countMentions(const Statements &statements, const std::string &name) {
  unsigned count = 0;
  for (const Statement &statement : statements)
    count += countMentions(statement, name);
  return count;
}

bool mentions(const Statement &statement, const std::string &name) {
  return countMentions(statement, name) != 0;
}

bool mentions(const Statements &statements, const std::string &name) {
  return countMentions(statements, name) != 0;
}

} // namespace rtsl::cpp
