#include "codegen/cpp/cleanup/FlagConditions.h"

#include <algorithm>

namespace rtsl::cpp {

/// `frame.x`, or a part of it.
static bool isMemberOf(const Code &code, const std::string &frame) {
  if (!code || !code->is(ExpressionKind::Member))
    return false;
  const Code &base = code->parts[0];
  return (isName(base) && base->name == frame) || isMemberOf(base, frame);
}

/// May evaluating it change members of `frame`? A call may, which gets one by reference.
static bool mayChangeMembers(const Code &code, const std::string &frame) {
  bool mayChange = false;
  forEachPart(code, [&](const ExpressionNode &part) {
    mayChange |= part.is(ExpressionKind::Assign) || part.is(ExpressionKind::Lambda);
    if (part.is(ExpressionKind::Call))
      for (const Code &argument : part.parts)
        mayChange |= isMemberOf(argument, frame);
  });
  return mayChange;
}

/// The value of `type name = value;` or `name = value;`.
static Code valueOf(const Statement &statement) {
  return statement.is(StatementKind::Declaration) ? statement.declarators.front().value
                                                  : assignedValue(statement);
}

void inlineFlag(Statements &block, std::size_t &at, const Statements &body,
                const std::string &frame) {
  if (!block[at].is(StatementKind::If))
    return;
  const Code condition = bare(block[at].value);
  const bool isOpposite =
      condition->is(ExpressionKind::Unary) && condition->unary == UnaryOperator::Not;
  const Code flag = isOpposite ? bare(condition->parts[0]) : condition;
  if (!isName(flag))
    return;
  const auto last = std::make_reverse_iterator(block.begin() + static_cast<std::ptrdiff_t>(at));
  const auto found = std::find_if(last, block.rend(), [&](const Statement &one) {
    return !one.isOpen && !isMemberOf(valueOf(one), frame);
  });
  if (found == block.rend() || !assignedVariable(*found) || !found->written.isTemporary ||
      assignedName(*found) != flag->name)
    return;
  const Code value = assignedValue(*found);
  const bool isApart = found != last;
  if ((isApart && mayChangeMembers(value, frame)) || countMentions(body, flag->name) != 2)
    return;
  block[at].value = isOpposite ? negated(value) : value;
  if (!found->comment.empty())
    block[at].comment =
        found->comment + (block[at].comment.empty() ? "" : "\n" + block[at].comment);
  block[at].hasSpace |= found->hasSpace;
  block.erase(std::next(found).base());
  --at;
}

void joinFlagUpdate(Statements &block, std::size_t &at) {
  const Statement &branch = block[at];
  if (at == 0 || !branch.is(StatementKind::If) || branch.body.size() != 1 ||
      !branch.otherwise.empty())
    return;
  Statement &before = block[at - 1];
  const void *variable = assignedVariable(branch.body.front());
  if (!variable || assignedVariable(before) != variable)
    return;
  const Code flag = before.value->parts[0];
  const bool isAnd = same(branch.value, flag),
             isOr = same(branch.value, unary(UnaryOperator::Not, flag));
  if (!isAnd && !isOr)
    return;
  before.value = assign(flag, binary(isAnd ? Operator::And : Operator::Or, assignedValue(before),
                                     assignedValue(branch.body.front())));
  block.erase(block.begin() + static_cast<std::ptrdiff_t>(at--));
}

} // namespace rtsl::cpp
