#include "codegen/cpp/cleanup/OverwrittenZeros.h"

namespace rtsl::cpp {

static bool isPlainAssignment(const Statement &statement) {
  return statement.is(StatementKind::Expression) && statement.value &&
         statement.value->is(ExpressionKind::Assign) && !statement.value->compound;
}

/// May evaluating `value` read the target? Calls may, which get the object that it is part of.
static bool mayRead(const Code &value, const Code &target) {
  Code root = target;
  while (root->is(ExpressionKind::Member) || root->is(ExpressionKind::Subscript))
    root = Code(root->parts[0]);
  bool isPassed = false;
  forEachPart(value, [&](const ExpressionNode &part) {
    if (part.is(ExpressionKind::Call))
      for (std::size_t i = 1; i < part.parts.size(); ++i)
        isPassed |= same(part.parts[i], root);
  });
  return isPassed || contains(value, target);
}

void removeOverwrittenZero(Statements &block, std::size_t &at) {
  if (at == 0 || !isPlainAssignment(block[at]) || !isPlainAssignment(block[at - 1]))
    return;
  const Statement &first = block[at - 1];
  const Code &target = block[at].value->parts[0], &value = block[at].value->parts[1];
  if (!first.comment.empty() || !same(first.value->parts[0], target) ||
      !isZero(first.value->parts[1]) || mayRead(value, target))
    return;
  block.erase(block.begin() + static_cast<std::ptrdiff_t>(--at));
}

} // namespace rtsl::cpp
