//===- StatementEmitter.h - statements, with what the author wrote around them ===//
#pragma once

#include "codegen/cpp/states/StatePart.h"

#include <map>
#include <set>

namespace rtsl::cpp {

/// Gives the first statement that is made of a line the comment above that line, and an empty line
/// if the author has left one.
class StatementEmitter : StatePart {
public:
  StatementEmitter(StatePrinter &state, Context &context);

  /// The following statements are made of this operation; they keep the line of those before if its
  /// own is unknown.
  void moveTo(mlir::Operation &op);
  Statement &emit(Statements &out, Statement statement);
  Statement &emit(Statements &out, Code code) { return emit(out, statement(std::move(code))); }

  unsigned line = 0; // in the author's file

private:
  std::map<unsigned, std::string> comments; // of statements, by line, until they are printed
  std::set<unsigned> spaces;                // lines with an empty line above, likewise
};

} // namespace rtsl::cpp
