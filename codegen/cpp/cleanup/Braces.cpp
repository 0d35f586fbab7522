#include "codegen/cpp/cleanup/Braces.h"

#include <algorithm>

namespace rtsl::cpp {

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

void setBraces(Statement &statement) {
  if (statement.is(StatementKind::If)) {
    statement.hasBraces = !isShort(statement.body);
    statement.otherwiseHasBraces = !statement.otherwise.empty() && !isShort(statement.otherwise);
  }
  for (Arm &arm : statement.arms)
    arm.hasBraces = std::any_of(arm.body.begin(), arm.body.end(), [](const Statement &one) {
      return one.is(StatementKind::Declaration);
    });
}

} // namespace rtsl::cpp
