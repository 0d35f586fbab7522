#include "codegen/cpp/HitErrors.h"

#include "codegen/cpp/Printer.h"
#include "codegen/cpp/errors/HitErrorWriter.h"
#include "codegen/passes/errors/DeriveHitErrors.h"

namespace rtsl::cpp {

/// `boundHitError(rt, self)` for each primitive that has one.
Declarations ModulePrinter::hitErrors() {
  Declarations all;
  if (!options.hitErrors)
    return all;
  mlir::ModuleOp ir = options.hitErrors->ir;
  for (const auto &definition : module.classes) {
    auto source =
        ir.lookupSymbol<mlir::func::FuncOp>(definition->name + "." + hitErrorMethod.str());
    if (!source)
      continue;
    withHitErrors.insert(definition.get());
    Function made;
    made.specifiers = "inline";
    made.result = "void";
    made.name = "boundHitError";
    Parameter self = byConstReference(names.of(definition.get()), "self");
    self.isUnread = true;
    made.parameters = {byReference("State", "rt"), self};
    made.body = HitErrorWriter(names, *definition).body(source);
    failed |= !made.body;
    appendApart(all, declare(std::move(made),
                             "/// Bounds the error of HitDistance where `intersect` of `" +
                                 definition->name + "` has found it: running error analysis."));
  }
  return all;
}

} // namespace rtsl::cpp
