//===- Parser.cpp - RTSL text to syntax tree ------------------------------===//
//
//   text --preprocessor/, or Tokenizer where there is nothing to preprocess--> tokens
//   --TokenCheck--> balanced tokens --RtslParser--> parse tree --AstBuilder--> syntax tree
//
//===----------------------------------------------------------------------===//
#include "frontend/syntax/Parser.h"
#include "frontend/lex/Tokenizer.h"
#include "frontend/syntax/AstBuilder.h"
#include "frontend/syntax/SyntaxErrors.h"
#include "frontend/syntax/TokenCheck.h"

#include "grammar/RtslParser.h"

#include <Exceptions.h>

#include <algorithm>

namespace rtsl {

namespace {

using antlr4::atn::ParserATNSimulator;
using antlr4::atn::PredictionMode;
using generated::RtslParser;

/// Upper limit on the errors of one text that are collected for sorting.
constexpr std::size_t maxFoundErrors = 1000;

/// Parses with predictions that ignore the rules around a decision, which is fast and nearly always
/// right. Only when that fails, usually because of a syntax error, the text is parsed again with
/// full context, and mistakes are reported.
RtslParser::TranslationUnitContext *parseWords(RtslParser &parser, SyntaxErrors &errors) {
  auto *simulator = parser.getInterpreter<ParserATNSimulator>();
  try {
    errors.isQuiet = true;
    simulator->setPredictionMode(PredictionMode::SLL);
    return parser.translationUnit();
  } catch (const antlr4::ParseCancellationException &) {
    errors.isQuiet = false;
    parser.reset();
    parser.getTreeTracker().reset();
    simulator->setPredictionMode(PredictionMode::LL);
    return parser.translationUnit();
  }
}

std::unique_ptr<ast::TranslationUnit> parseText(FileId file, Diagnostics &diagnostics) {
  TokenList list = tokenize(file, diagnostics);
  if (list.isUsable)
    checkTokens(file, list, diagnostics);
  if (list.isUsable && list.tokens.size() == 1 && !diagnostics.hasErrors())
    diagnostics.report(Code::emptySource, SourceRange{file, 0, 0});
  if (!list.isUsable) {
    auto unit = std::make_unique<ast::TranslationUnit>();
    unit->file = file;
    return unit;
  }

  TokenStream stream(list.tokens);
  RtslParser parser(&stream);
  const auto errors = std::make_shared<SyntaxErrors>(file, stream, diagnostics);
  parser.removeErrorListeners();
  parser.setErrorHandler(errors);
  AstBuilder builder(file, list.tokens, list.comments, diagnostics);
  for (RtslParser::FileItemContext *item : parseWords(parser, *errors)->fileItem())
    builder.addItem(item);
  return builder.finish();
}

} // namespace

std::unique_ptr<ast::TranslationUnit> parse(FileId file, Diagnostics &diagnostics) {
  // Each step processes the whole text, but messages are reported from top to bottom.
  Diagnostics found(diagnostics.sources());
  found.errorLimit =
      diagnostics.errorLimit == 0 ? 0 : std::max(diagnostics.errorLimit, maxFoundErrors);
  found.warnings = diagnostics.warnings;
  std::unique_ptr<ast::TranslationUnit> unit = parseText(file, found);
  diagnostics.addSorted(std::move(found));
  return unit;
}

} // namespace rtsl
