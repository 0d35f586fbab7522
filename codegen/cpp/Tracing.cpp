#include "codegen/cpp/Tracing.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

namespace rtsl::cpp {

bool TracingFunctions::mayBeCalled(const typed::Function &callee) const {
  if (contains(callee))
    return true;
  for (const typed::Function *other : functions) // one that overrides it
    if (callee.owner && other->owner && other->owner->derivesFrom(callee.owner) &&
        other->name == callee.name && typed::sameParameters(*other, callee))
      return true;
  return false;
}

bool TracingFunctions::isFound(const typed::Function &function) const {
  bool found = false;
  if (function.body)
    forEachExpr(*function.body, [&](const typed::Expr &expr) {
      if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
        found |= builtin->builtin == typed::Builtin::Trace ||
                 builtin->builtin == typed::Builtin::TracePayload;
      else if (auto *call = dynCast<typed::CallExpr>(&expr))
        found |= mayBeCalled(*call->function);
      else if (auto *method = dynCast<typed::MethodCallExpr>(&expr))
        found |= method->function && mayBeCalled(*method->function);
    });
  return found;
}

TracingFunctions::TracingFunctions(const typed::Module &module) {
  std::size_t before;
  do {
    before = functions.size();
    for (const auto &function : module.functions)
      if (isFound(*function))
        functions.insert(function.get());
    for (const auto &definition : module.classes)
      for (const auto &function : definition->functions)
        if (isFound(*function))
          functions.insert(function.get());
  } while (functions.size() != before);
}

} // namespace rtsl::cpp
