#include "codegen/cpp/states/statements/StatementEmitter.h"

#include "codegen/cpp/states/statements/StatePrinter.h"
#include "sema/typed/Walk.h"

namespace rtsl::cpp {

StatementEmitter::StatementEmitter(StatePrinter &state, Context &context)
    : StatePart(state, context) {
  forEachStmt(*state.machine.method->body, [&](const typed::Stmt &stmt) {
    if (!stmt.comment.empty())
      comments[context.notes.line(stmt.range)] = stmt.comment;
    if (context.notes.followsEmptyLine(stmt.range, {}))
      spaces.insert(context.notes.line(stmt.range));
  });
}

void StatementEmitter::moveTo(mlir::Operation &op) {
  if (unsigned at = lineOf(op.getLoc(), state.machine.file))
    line = at;
}

Statement &StatementEmitter::emit(Statements &out, Statement statement) {
  if (auto comment = comments.find(line); comment != comments.end()) {
    statement.comment = comment->second;
    comments.erase(comment);
  }
  statement.hasSpace = !out.empty() && spaces.erase(line) != 0;
  if (line != 0)
    statement.place = context.lineDirective(state.machine.method->range, line);
  return out.emplace_back(std::move(statement));
}

} // namespace rtsl::cpp
