#include "codegen/link/Members.h"

namespace rtsl {

const typed::Function *findConstructor(const typed::Class &info) {
  for (const auto &function : info.functions)
    if (function->isConstructor)
      return function.get();
  return info.base ? findConstructor(*info.base) : nullptr;
}

std::vector<const typed::Member *> allMembers(const typed::Class &info) {
  std::vector<const typed::Class *> chain;
  for (const typed::Class *at = &info; at; at = at->base)
    chain.push_back(at);
  std::vector<const typed::Member *> members;
  for (auto at = chain.rbegin(); at != chain.rend(); ++at)
    for (const auto &member : (*at)->members)
      members.push_back(member.get());
  return members;
}

} // namespace rtsl
