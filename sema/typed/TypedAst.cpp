//===- TypedAst.cpp - names of built-ins and state, lookup in classes -----===//
#include "sema/typed/TypedAst.h"

#include "language/Costs.h"

namespace rtsl::typed {

const BuiltinInfo &info(Builtin builtin) {
  using namespace cost;
  static const BuiltinInfo table[] = {
#define RTSL_BUILTIN(id, name, effect, cost, ...) {name, BuiltinEffect::effect, cost},
#include "language/Builtins.def"
  };
  return table[static_cast<std::size_t>(builtin)];
}

const char *name(Builtin builtin) {
  return info(builtin).name;
}

const char *name(StateVariable variable) {
  static const char *const names[] = {
#define RTSL_STATE_VARIABLE(name, type) #name,
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
