//===- TypedAst.cpp - names of state, lookup in classes -----------------===//
#include "sema/typed/TypedAst.h"

namespace rtsl::typed {

const char *name(StateVariable variable) {
  static const char *const names[] = {
#define RTSL_STATE_VARIABLE(name, type, ...) #name,
#include "language/StateVariables.def"
  };
  return names[static_cast<std::size_t>(variable)];
}

const Function *Class::findMethod(const std::string &method) const {
  for (const Class *at = this; at; at = at->base)
    for (const std::unique_ptr<Function> &function : at->functions)
      if (function->name == method)
        return function.get();
  return nullptr;
}

bool Class::derivesFrom(const Class *other) const {
  for (const Class *at = this; at; at = at->base)
    if (at == other)
      return true;
  return false;
}

const Class *Module::findClass(const std::string &wanted) const {
  for (const std::unique_ptr<Class> &candidate : classes)
    if (candidate->name == wanted)
      return candidate.get();
  return nullptr;
}

} // namespace rtsl::typed
