//===- Tracing.h - which functions trace ----------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <set>

namespace rtsl::cpp {

/// The functions that send rays, themselves or through what they call. (`typed::Function::mayTrace`
/// counts the rays of lights too, and not what overrides a function.)
class TracingFunctions {
public:
  explicit TracingFunctions(const typed::Module &module);

  bool contains(const typed::Function &function) const { return functions.count(&function) != 0; }
  /// May a call of it trace, whichever class the object is of?
  bool mayBeCalled(const typed::Function &callee) const;

private:
  bool isFound(const typed::Function &function) const;

  std::set<const typed::Function *> functions;
};

} // namespace rtsl::cpp
