//===- TokenCheck.h - checks on the tokens, before parsing ----------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/lex/Token.h"

namespace rtsl {

/// Brackets may be nested this deep.
constexpr unsigned maxBracketDepth = 256;
/// Height of an expression or statement: operators, nested statements and brackets on the longest
/// path from its root to a leaf. It bounds the recursion of all tree walks.
constexpr unsigned maxNesting = 1000;

/// Prepares tokens for the parser: balances brackets (missing ones are inserted, superfluous ones
/// removed), rejects excessive nesting, and repairs mistakes that can be recognised locally:
/// precision qualifiers, keywords as names, qualifiers of GLSL. All of this is reported.
/// `illuminance` becomes a keyword where it begins a statement.
void checkTokens(FileId file, TokenList &list, Diagnostics &diagnostics);

} // namespace rtsl
