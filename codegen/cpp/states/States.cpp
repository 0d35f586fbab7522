#include "codegen/cpp/states/States.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Effects.h"

#include <memory>

namespace rtsl::cpp {

using typed::StateVariable;

static const std::vector<std::pair<StateVariable, const char *>> &stateVariables() {
  static const std::vector<std::pair<StateVariable, const char *>> all = {
#define RTSL_STATE_VARIABLE(name, type, ...) {StateVariable::name, #name},
#include "language/StateVariables.def"
  };
  return all;
}

SourceTable makeSourceTable(const typed::Module &module, bool raises) {
  auto effects = std::make_shared<typed::EffectsOf>(module, /*prints=*/false, raises);
  SourceTable table;
  table.isPure = [effects](const typed::Function &function) {
    const typed::Effects &inside = effects->function(function);
    return inside.isPure() && !inside.usesRay && !inside.usesScratch;
  };
  table.writes = [effects](const typed::Expr &expr) -> std::optional<std::vector<std::string>> {
    auto *call = dynCast<typed::CallExpr>(&expr);
    if (!call) // of a method that is known when the scene is
      return std::nullopt;
    const typed::Effects &inside = effects->function(*call->function);
    if (typed::raysOf(expr).any() || inside.writesScratch || inside.reportsHit)
      return std::nullopt;
    std::vector<std::string> names;
    for (const auto &[variable, name] : stateVariables())
      if (inside.writes.count(typed::EffectsOf::place(variable)))
        names.emplace_back(name);
    return names;
  };
  return table;
}

} // namespace rtsl::cpp
