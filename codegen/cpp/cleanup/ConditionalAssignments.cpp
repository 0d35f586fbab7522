#include "codegen/cpp/cleanup/ConditionalAssignments.h"

#include <algorithm>

namespace rtsl::cpp {

Code choose(Code condition, Code first, Code second, const std::string &type,
            bool isVectorOfBools) {
  const auto side = [&](const Code &value) {
    const bool isMade =
        !isVectorOfBools || (value->is(ExpressionKind::Construct) && value->name == type);
    return isMade ? value : construct(type, {value});
  };
  return conditional(std::move(condition), side(first), side(second));
}

/// The value of a variable that the compiler has named, if its declaration is the last one before
/// `at` and only that statement reads it: the declaration is removed then. Otherwise the name.
static Code inlineName(const Code &named, Statements &block, std::size_t &at,
                       const Statements &body) {
  const auto last =
      std::find_if(std::make_reverse_iterator(block.begin() + static_cast<std::ptrdiff_t>(at)),
                   block.rend(), [](const Statement &one) { return !one.isOpen; });
  if (last == block.rend() || !isName(named) || !last->is(StatementKind::Declaration) ||
      !last->written.isTemporary || last->declarators.front().name != named->name ||
      countMentions(body, named->name) != countMentions(block[at], named->name))
    return named;
  const Code value = last->declarators.front().value;
  block.erase(std::next(last).base());
  --at;
  return value;
}

void joinConditionalAssignments(Statements &block, std::size_t &at, const Statements &body) {
  if (!block[at].is(StatementKind::If) || block[at].body.size() != 1 ||
      block[at].otherwise.size() != 1)
    return;
  const Statement then = block[at].body.front(), otherwise = block[at].otherwise.front();
  const void *variable = assignedVariable(then);
  if (!variable || assignedVariable(otherwise) != variable)
    return;
  const Code condition = block[at].value, first = assignedValue(then),
             second = assignedValue(otherwise);
  Code value;
  if (isBoolean(first, true))
    value = binary(Operator::Or, condition, second);
  else if (same(condition, second))
    value = binary(Operator::And, inlineName(second, block, at, body), first);
  else if (same(condition, unary(UnaryOperator::Not, second)))
    value = binary(Operator::Or, inlineName(second, block, at, body), first);
  else if (isBoolean(second, false))
    value = binary(Operator::And, condition, first);
  else
    value = choose(condition, first, second, then.written.type, then.written.isVectorOfBools);
  Statement joined = statement(assign(then.value->parts[0], value));
  joined.comment = block[at].comment;
  joined.place = block[at].place;
  joined.hasSpace = block[at].hasSpace;
  joined.written = then.written;
  block[at] = std::move(joined);
}

} // namespace rtsl::cpp
