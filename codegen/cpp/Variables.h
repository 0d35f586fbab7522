//===- Variables.h - structs, constants and members -----------------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/tree/Declaration.h"

#include <unordered_set>

namespace rtsl::cpp {

class Variables {
public:
  explicit Variables(Context &context) : context(context) {}

  /// A constant at file level.
  Declaration constant(const typed::Variable &constant);
  /// A member of a class, or of its `Scratch`.
  Declaration member(const typed::Member &member);
  /// A struct, with its operators if `context.required` has them.
  Declaration structure(const typed::Struct &structure) const;

private:
  bool isConstexpr(const Type *type, const typed::Constant *value, const std::string &name,
                   const Code &initialiser);

  Context &context;
  std::unordered_set<std::string> constexprNames; // of numbers that were printed as constexpr
};

} // namespace rtsl::cpp
