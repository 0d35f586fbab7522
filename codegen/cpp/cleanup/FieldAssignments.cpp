#include "codegen/cpp/cleanup/FieldAssignments.h"

#include "codegen/cpp/cleanup/OverwrittenZeros.h"

namespace rtsl::cpp {

/// What the whole struct gets if the statement assigns this field of `whole`; empty: it is not
/// known.
static Code sourceOf(const Statement &statement, const Code &whole, const std::string &field) {
  if (!statement.is(StatementKind::Expression) || !statement.value->is(ExpressionKind::Assign) ||
      statement.value->compound || !same(statement.value->parts[0], member(whole, field)))
    return {};
  const Code &value = statement.value->parts[1];
  if (isZero(value))
    return list("", {});
  const bool isCopy =
      statement.field.isCopy && value->is(ExpressionKind::Member) && value->name == field;
  return isCopy ? value->parts[0] : Code();
}

void joinFieldAssignments(Statements &block, std::size_t &at) {
  const std::vector<std::string> fields = block[at].field.all;
  if (fields.empty() || at + 1 < fields.size() || !block[at].value->is(ExpressionKind::Assign) ||
      !block[at].value->parts[0]->is(ExpressionKind::Member))
    return;
  const Code whole = block[at].value->parts[0]->parts[0];
  const std::size_t first = at + 1 - fields.size();
  Code from;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Code source = sourceOf(block[first + i], whole, fields[i]);
    if (!source || (from && !same(from, source)))
      return;
    from = source;
  }
  Statement joined = statement(assign(whole, from));
  joined.comment = block[first].comment;
  joined.written = block[at].written;
  const auto begin = block.begin() + static_cast<std::ptrdiff_t>(first);
  *begin = std::move(joined);
  block.erase(begin + 1, begin + static_cast<std::ptrdiff_t>(fields.size()));
  at = first;
  removeOverwrittenZero(block, at);
}

} // namespace rtsl::cpp
