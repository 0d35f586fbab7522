//===- SourceTable.h - expressions that the IR keeps whole ----------------===//
//
// Lowering with a table (LowerOptions::source) makes one `rtsl.expression` of an expression instead
// of the operations that compute it. The C++ printer finds the expression's tree in the table.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rtsl {

struct SourceTable {
  enum class Kind : std::uint8_t {
    Value,
    Compound,    // the new value of the target of `target op= value`
    Step,        // that of `++target`
    AngleCosine, // the cosine of the angle of an `illuminance`
    Index,       // that of an element, which ends the sample if it is out of range
    Into         // the value is stored to a variable that stays whole, the first operand
  };
  struct Entry {
    Kind kind = Kind::Value;
    const typed::Expr *expr = nullptr;
    std::vector<const typed::Expr *> leaves; // the expressions that the operands stand for
  };
  std::vector<Entry> entries; // by the number of the operation
  /// Types of variables in memory, by the number in their attribute `rtsl.declared`.
  std::vector<const Type *> types;

  /// Does a call read nothing but its arguments and members, and change nothing?
  std::function<bool(const typed::Function &)> isPure;
  /// The state variables that a call may change; nothing: any.
  std::function<std::optional<std::vector<std::string>>(const typed::Expr &call)> writes;
};

} // namespace rtsl
