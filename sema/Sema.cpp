//===- Sema.cpp - checking: syntax trees to one typed module --------------===//
#include "sema/Sema.h"

#include "sema/check/Program.h"
#include "sema/derive/Derive.h"

namespace rtsl {

std::unique_ptr<typed::Module> check(const std::vector<const ast::TranslationUnit *> &units,
                                     const ImportResolver &resolver, Diagnostics &diagnostics,
                                     const ModuleFinder &finder) {
  auto module = std::make_unique<typed::Module>();
  Program program(*module, diagnostics, finder);
  program.collect(units, resolver);
  program.resolveStructs();
  program.resolveConstants();
  program.resolveClasses();
  program.declareFunctions();
  program.checkBodies();
  program.judgeCalls();
  program.checkPerformance();
  if (!diagnostics.hasErrors())
    replaceDerivatives(*module);
  return module;
}

} // namespace rtsl
