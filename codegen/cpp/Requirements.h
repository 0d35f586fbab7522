//===- Requirements.h - what printed functions require of the rest --------===//
//
// Functions are made first. The types of references, the operators and the exceptions that they
// mention are declared afterwards, but printed before the functions.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace rtsl::cpp {

/// A method that is called through references.
struct ThroughReference {
  std::string method;
  const typed::Function *function; // null: lookup, lookupFloat
};

struct Requirements {
  /// Types of references, by class, and the methods that are called through each.
  std::map<std::string, std::vector<ThroughReference>> references;
  std::set<const Type *> comparedStructs; // that need an operator ==
  bool throwsFromAnyHit = false;          // `anyHit` ends where no `return` can stand

  void callThroughReference(const std::string &className, const std::string &method,
                            const typed::Function *function) {
    std::vector<ThroughReference> &methods = references[className];
    for (const ThroughReference &known : methods)
      if (known.method == method && known.function == function)
        return;
    methods.push_back({method, function});
  }
};

} // namespace rtsl::cpp
