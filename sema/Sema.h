//===- Sema.h - checking: syntax trees to one typed module ----------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "sema/check/ImportResolver.h"
#include "sema/typed/TypedAst.h"

#include <memory>
#include <string>
#include <vector>

namespace rtsl {

/// Checks all `units` and what they import, once each. Reports through `diagnostics`. Returns a
/// module even if there were errors (broken parts are left out), so that tools can inspect the
/// rest. With `finder`, messages about unknown names say which module has them.
std::unique_ptr<typed::Module> check(const std::vector<const ast::TranslationUnit *> &units,
                                     const ImportResolver &resolver, Diagnostics &diagnostics,
                                     const ModuleFinder &finder = {});

namespace typed {
/// The module as indented text, one node per line with its type: `--emit=typed-ast`.
std::string dump(const Module &module);
} // namespace typed

} // namespace rtsl
