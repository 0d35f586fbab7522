//===- Parser.h - RTSL text to syntax tree --------------------------------===//
#pragma once

#include "frontend/Ast.h"
#include "frontend/Diagnostics.h"

#include <memory>
#include <string>

namespace rtsl {

/// Parses one text of `diagnostics.sources()`. Always gives a tree; where errors were reported it is partial (broken
/// statements and declarations are left out, broken expressions are `ast::ErrorExpr`). Time is linear in the text for
/// texts without errors. Nesting deeper than 256 brackets is refused before parsing.
std::unique_ptr<ast::TranslationUnit> parse(FileId file, Diagnostics &diagnostics);

/// The tree as indented text, one node a line: `--emit=ast`.
std::string dump(const ast::TranslationUnit &unit);

} // namespace rtsl
