#include "codegen/link/RequiredMembers.h"

#include "codegen/link/Members.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Walk.h"

namespace rtsl {

const RequiredMembers::Uses &RequiredMembers::usesOf(const typed::Class &info) {
  const auto [found, isNew] = known.try_emplace(&info);
  Uses &uses = found->second;
  if (!isNew)
    return uses;
  const auto read = [&](const typed::Expr &expr) {
    if (const auto *member = dynCast<typed::MemberExpr>(&expr))
      uses.read.insert(member->member);
  };
  for (const typed::Class *at = &info; at; at = at->base) {
    for (const auto &function : at->functions)
      if (function->body && !function->isConstructor) // the others cannot write
        forEachExpr(*function->body, read);
    for (const auto &member : at->members)
      if (member->init)
        forEachExpr(*member->init, read);
  }
  if (const typed::Function *constructor = findConstructor(info)) {
    if (!effects)
      effects.emplace(module, /*prints=*/true);
    const typed::Effects &constructing = effects->function(*constructor);
    uses.read.insert(constructing.reads.begin(), constructing.reads.end());
    uses.written = constructing.writes;
  }
  return uses;
}

bool RequiredMembers::has(const typed::Class &info, const typed::Member &member) {
  if (member.access != ast::Access::Public || member.init || member.isOptional ||
      member.type->is(TypeKind::Class) || member.type->is(TypeKind::Buffer))
    return false;
  const Uses &uses = usesOf(info);
  return uses.read.count(&member) != 0 && uses.written.count(&member) == 0;
}

} // namespace rtsl
