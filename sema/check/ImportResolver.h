//===- ImportResolver.h - where imported files come from ------------------===//
#pragma once

#include "frontend/syntax/Ast.h"

#include <functional>

namespace rtsl {

/// Finds and parses the text of an import; null on failure (which is reported at `import.range`).
/// The same file gives the same pointer each time. `importer` is the file that contains the import.
using ImportResolver =
    std::function<const ast::TranslationUnit *(const ast::ImportDecl &import, FileId importer)>;

/// Returns the module of the standard library that defines a class, struct, constant or function of
/// the given name, "std.noise", or an empty string. Called only after an unknown name was reported.
using ModuleFinder = std::function<std::string(const std::string &name)>;

} // namespace rtsl
