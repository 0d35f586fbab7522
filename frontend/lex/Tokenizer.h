//===- Tokenizer.h - text to tokens ---------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/lex/Token.h"

namespace rtsl {

/// Reports a text that cannot be RTSL: NUL bytes, or bytes that are not UTF-8. Returns the message,
/// or null.
Diagnostic *reportIfNotText(FileId file, Diagnostics &diagnostics);

/// Splits a text into tokens by grammar/RtslLexer.g4 and reports the rest: text that is not UTF-8,
/// unknown characters, comments and strings without an end, malformed numbers. Rejected text is
/// left out of the list.
TokenList tokenize(FileId file, Diagnostics &diagnostics);

} // namespace rtsl
