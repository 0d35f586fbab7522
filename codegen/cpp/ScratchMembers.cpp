#include "codegen/cpp/ScratchMembers.h"

#include "sema/typed/Casting.h"

namespace rtsl::cpp {

const typed::Class &rootOf(const typed::Class &definition) {
  const typed::Class *at = &definition;
  while (at->base)
    at = at->base;
  return *at;
}

std::vector<const typed::Class *> ScratchMembers::family(const typed::Class &definition) const {
  std::vector<const typed::Class *> classes;
  for (const auto &other : module.classes)
    if (&rootOf(*other) == &rootOf(definition))
      classes.push_back(other.get());
  return classes;
}

bool ScratchMembers::has(const typed::Class &definition) {
  const typed::Class &root = rootOf(definition);
  std::optional<bool> &result = known[&root];
  if (result)
    return *result;
  bool found = false;
  for (const typed::Class *at : family(root)) {
    for (const auto &member : at->members)
      found |= member->access == ast::Access::Scratch;
    // A free function that reports hits takes it as a parameter.
    for (const auto &function : at->functions)
      if (function->body)
        forEachExpr(*function->body, [&](const typed::Expr &expr) {
          auto *call = dynCast<typed::CallExpr>(&expr);
          found |= call && !call->function->owner && effects.function(*call->function).reportsHit;
        });
  }
  return *(result = found);
}

} // namespace rtsl::cpp
