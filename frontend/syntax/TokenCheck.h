//===- TokenCheck.h - what is checked on words, before parsing ------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/lex/Token.h"

namespace rtsl {

/// Brackets may be nested this deep.
constexpr unsigned maxBracketDepth = 256;
/// Height of an expression or statement: operators, statements within statements and brackets on
/// the longest way from its root to a leaf. Everything that walks the tree may call itself so
/// often.
constexpr unsigned maxNesting = 1000;

/// Prepares words for the parser: balances brackets (what is missing is put in, what is too much
/// left out), refuses what is nested too deep, and clears away slips that are known at sight:
/// precision qualifiers, keywords as names, qualifiers of GLSL. All of it is reported.
/// `illuminance` becomes a word of its own where it begins a statement.
void checkTokens(FileId file, TokenList &list, Diagnostics &diagnostics);

} // namespace rtsl
