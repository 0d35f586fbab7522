//===- Parser.h - RTSL text to syntax tree --------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/syntax/Ast.h"

#include <memory>
#include <string>

namespace rtsl {

/// Parses one text of `diagnostics.sources()`. Always returns a tree; where errors were reported it
/// is partial (broken statements and declarations are left out, broken expressions are
/// `ast::ErrorExpr`). For texts without errors the time is linear. More than 256 nested brackets
/// are rejected before parsing, and so are expressions and statements nested deeper than 1000
/// levels (TokenCheck.h), which bounds the recursion of tree walks. Messages are sorted by
/// position.
std::unique_ptr<ast::TranslationUnit> parse(FileId file, Diagnostics &diagnostics);

/// The tree as indented text, one node per line: `--emit=ast`.
std::string dump(const ast::TranslationUnit &unit);

} // namespace rtsl
