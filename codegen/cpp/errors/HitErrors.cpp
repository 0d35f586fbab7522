#include "codegen/cpp/HitErrors.h"

#include "codegen/cpp/Context.h"
#include "codegen/cpp/errors/HitErrorWriter.h"
#include "codegen/passes/errors/DeriveHitErrors.h"

namespace rtsl::cpp {

Declarations hitErrors(Context &context, std::set<const typed::Class *> &printed) {
  Declarations all;
  if (!context.options.hitErrors)
    return all;
  mlir::ModuleOp ir = context.options.hitErrors->ir;
  for (const auto &definition : context.module.classes) {
    auto source =
        ir.lookupSymbol<mlir::func::FuncOp>(definition->name + "." + hitErrorMethod.str());
    if (!source)
      continue;
    printed.insert(definition.get());
    Function made;
    made.specifiers = "inline";
    made.result = "void";
    made.name = "boundHitError";
    Parameter self = byConstReference(context.names.of(definition.get()), "self");
    self.isUnread = true;
    made.parameters = {byReference("State", "rt"), self};
    made.body = HitErrorWriter(context.names, *definition).body(source);
    if (!made.body)
      context.fail();
    appendApart(all, declare(std::move(made),
                             "/// Bounds the error of HitDistance where `intersect` of `" +
                                 definition->name + "` has found it: running error analysis."));
  }
  return all;
}

} // namespace rtsl::cpp
