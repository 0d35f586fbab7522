//===- Parser.h - RTSL text to syntax tree --------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/syntax/Ast.h"

#include <memory>
#include <string>

namespace rtsl {

/// Parses one text of `diagnostics.sources()`. Always gives a tree; where errors were reported it
/// is partial (broken statements and declarations are left out, broken expressions are
/// `ast::ErrorExpr`). Time is linear in the text for texts without errors. More than 256 brackets
/// within each other are refused before parsing, and so are expressions and statements nested
/// deeper than 1000 levels (TokenCheck.h): what walks a tree may call itself so often. Messages
/// come in the order of their places.
std::unique_ptr<ast::TranslationUnit> parse(FileId file, Diagnostics &diagnostics);

/// The tree as indented text, one node a line: `--emit=ast`.
std::string dump(const ast::TranslationUnit &unit);

} // namespace rtsl
