//===- Scope.h - the local names of a function ----------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace rtsl {

/// Nested scopes of local variables and parameters. Lookup takes constant time, regardless of the
/// number of scopes.
class LocalScopes {
public:
  void push() { marks.push_back(declared.size()); }
  void pop();

  /// Makes `variable` visible in the innermost scope. If this scope already has a variable of that
  /// name, returns it and changes nothing; otherwise returns null.
  const typed::Variable *declare(typed::Variable *variable);
  /// The innermost variable of that name, or null.
  typed::Variable *find(const std::string &name) const;
  /// All visible names, for suggestions.
  std::vector<std::string> names() const;

private:
  struct Entry {
    typed::Variable *variable;
    std::size_t depth;
  };
  std::unordered_map<std::string, std::vector<Entry>> byName; // innermost last
  std::vector<std::string> declared;                          // in order
  std::vector<std::size_t> marks; // length of `declared` where each scope begins
};

} // namespace rtsl
