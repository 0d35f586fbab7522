//===- Tokenizer.h - text to words ----------------------------------------===//
#pragma once

#include "frontend/Diagnostics.h"
#include "frontend/Token.h"

namespace rtsl {

/// Splits a text into words by grammar/RtslLexer.g4 and reports what is none: text that is not
/// UTF-8, unknown characters, comments and strings without an end, malformed numbers. What is
/// refused is left out of the list.
TokenList tokenize(FileId file, Diagnostics &diagnostics);

} // namespace rtsl
