#include "codegen/cpp/cleanup/CountedLoops.h"

#include <algorithm>

namespace rtsl::cpp {

/// Does a `continue` of this loop stand in the statements?
static bool continues(const Statements &statements) {
  return std::any_of(statements.begin(), statements.end(), [](const Statement &one) {
    if (one.is(StatementKind::For) || one.is(StatementKind::While) ||
        one.is(StatementKind::DoWhile))
      return false;
    return one.is(StatementKind::Continue) || continues(one.body) || continues(one.otherwise) ||
           std::any_of(one.arms.begin(), one.arms.end(),
                       [](const Arm &arm) { return continues(arm.body); });
  });
}

/// `counter < bound`, or a condition whose first part is that and must hold.
static bool isBelow(Code condition, const Code &counter) {
  while (condition->is(ExpressionKind::Binary) && condition->op == Operator::And)
    condition = bare(Code(condition->parts[0]));
  return condition->is(ExpressionKind::Binary) && condition->op == Operator::Less &&
         same(condition->parts[0], counter);
}

void makeCountedLoop(Statements &block, std::size_t &at, const Statements &body) {
  if (at == 0 || !block[at].is(StatementKind::While) || block[at].body.empty())
    return;
  const Statement &first = block[at - 1], &step = block[at].body.back();
  const void *variable = assignedVariable(first);
  if (!variable || assignedVariable(step) != variable)
    return;
  const Code counter = first.value->parts[0];
  const bool isElsewhere = countMentions(body, counter->name) !=
                           countMentions(block[at], counter->name) + 1; // of `first`
  if (isElsewhere || !isBelow(block[at].value, counter) ||
      !same(assignedValue(step), call("rtsl::add", {counter, integer(1)})) ||
      continues(block[at].body))
    return;
  Statement &loop = block[at];
  loop.kind = StatementKind::For;
  loop.init = {declaration(first.written.type, counter->name, assignedValue(first))};
  loop.step = unary(UnaryOperator::Increment, counter);
  loop.body.pop_back();
  block.erase(block.begin() + static_cast<std::ptrdiff_t>(--at));
  for (std::size_t i = 0; i < at; ++i)
    if (block[i].isOpen && block[i].written.identity == variable) {
      block.erase(block.begin() + static_cast<std::ptrdiff_t>(i));
      --at;
      break;
    }
}

} // namespace rtsl::cpp
