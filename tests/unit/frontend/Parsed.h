//===- Parsed.h - a text and what the front end makes of it ---------------===//
#pragma once

#include "frontend/syntax/Parser.h"

#include <string>

namespace rtsl::test {

/// Parses a text named "test.rtsl" and holds everything that came out.
struct Parsed {
  explicit Parsed(std::string text)
      : diagnostics(sources), file(sources.add("test.rtsl", std::move(text))),
        unit(parse(file, diagnostics)) {}

  /// Every message, a line each: "E0112 2:14-2:14 missing `;` after `1`". The range is half open.
  std::string messages() const {
    std::string result;
    for (const Diagnostic &diagnostic : diagnostics.all()) {
      const LineColumn begin = sources.lineColumn(diagnostic.range.file, diagnostic.range.begin);
      const LineColumn end = sources.lineColumn(diagnostic.range.file, diagnostic.range.end);
      result += fmt::format("{} {}:{}-{}:{} {}\n", info(diagnostic.code).number, begin.line,
                            begin.column, end.line, end.column, diagnostic.message);
    }
    return result;
  }

  /// The messages with their source lines, as they are shown.
  std::string shown() const { return renderText(diagnostics, false); }
  std::string tree() const { return dump(*unit); }

  SourceManager sources;
  Diagnostics diagnostics;
  FileId file;
  std::unique_ptr<ast::TranslationUnit> unit;
};

/// Parsed::messages of a text.
inline std::string messages(const std::string &text) {
  return Parsed(text).messages();
}

/// The same for a statement that stands on line 2 of a function.
inline std::string inFunction(const std::string &statement) {
  return messages("void f() {\n" + statement + "\n  last();\n}\n");
}

/// The text with the sure fixes of its messages applied.
inline std::string fixed(const std::string &text) {
  const Parsed parsed(text);
  return applyFixes(parsed.diagnostics, parsed.file).text;
}

} // namespace rtsl::test
