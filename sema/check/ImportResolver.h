//===- ImportResolver.h - where imported files come from ------------------===//
#pragma once

#include "frontend/syntax/Ast.h"

#include <functional>

namespace rtsl {

/// Finds the text of an import and parses it; null if it cannot (then it has reported why at
/// `import.range`). The same file asked for twice gives the same pointer. `importer` is the file
/// that holds the import.
using ImportResolver =
    std::function<const ast::TranslationUnit *(const ast::ImportDecl &import, FileId importer)>;

} // namespace rtsl
