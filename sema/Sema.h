//===- Sema.h - checking: syntax trees to one typed module ----------------===//
#pragma once

#include "frontend/Diagnostics.h"
#include "sema/TypedAst.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rtsl {

/// Finds the text of an import and parses it; null if it cannot (then it has reported why at `import.range`). The same
/// file asked for twice gives the same pointer. `importer` is the file that holds the import.
using ImportResolver =
    std::function<const ast::TranslationUnit *(const ast::ImportDecl &import, FileId importer)>;

/// Checks all `units` and what they import, once each. Reports through `diagnostics`. Returns a module even if there
/// were errors (what was broken is left out), so that tools may look at the rest.
std::unique_ptr<typed::Module> check(const std::vector<const ast::TranslationUnit *> &units,
                                     const ImportResolver &resolver, Diagnostics &diagnostics);

namespace typed {
/// The module as indented text, one node a line with its type: `--emit=typed-ast`.
std::string dump(const Module &module);
} // namespace typed

} // namespace rtsl
