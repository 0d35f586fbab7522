//===- Scope.cpp - the local names of a function --------------------------===//
#include "sema/check/Scope.h"

namespace rtsl {

void LocalScopes::pop() {
  for (; declared.size() > marks.back(); declared.pop_back())
    byName[declared.back()].pop_back();
  marks.pop_back();
}

const typed::Variable *LocalScopes::declare(typed::Variable *variable) {
  std::vector<Entry> &entries = byName[variable->name];
  if (!entries.empty() && entries.back().depth == marks.size())
    return entries.back().variable;
  entries.push_back({variable, marks.size()});
  declared.push_back(variable->name);
  return nullptr;
}

typed::Variable *LocalScopes::find(const std::string &name) const {
  auto found = byName.find(name);
  return found == byName.end() || found->second.empty() ? nullptr : found->second.back().variable;
}

std::vector<std::string> LocalScopes::names() const {
  return declared;
}

} // namespace rtsl
