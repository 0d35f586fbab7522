//===- Harness.h - RTSL text in, messages and typed tree out --------------===//
//
// A test is RTSL text. A line such as
//
//     //   ^^^ E0200 unknown name
//
// expects, under the carets of the line of code above it, a message with this number that contains
// this text. Where the range begins in the first two columns, the carets stand at the right and
// `//<2 ^^^` says by how many columns they are to be moved to the left. Messages are compared
// exhaustively: each needs its line, and each line its message.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/Sema.h"

#include <map>
#include <string>
#include <vector>

namespace rtsl::test {

/// A text checked: the module and everything that was said.
struct Checked {
  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::map<std::string, FileId> files;
  std::vector<std::unique_ptr<ast::TranslationUnit>> trees;
  std::unique_ptr<typed::Module> module;

  /// The numbers of all messages in order: "E0200 W2200".
  std::string numbers() const;
};

/// Checks a text. After a line `//=== name.rtsl` another file begins that the text may import or
/// include.
std::unique_ptr<Checked> checkText(const std::string &text);

/// The text of all messages, empty if there are none.
std::string render(const Checked &checked);

/// `text` with the lines of expectations replaced by what was really said. Equal to `text` if all
/// was expected.
std::string withActualMessages(const std::string &text);

/// One test of a file that holds several, each after a line `//--- what it is about`.
struct Case {
  std::string title;
  std::string text;
};
std::vector<Case> splitCases(const std::string &fileText);

/// Letters and digits only, as names of GoogleTest must be.
std::string testName(const std::string &title);
std::string readFile(const std::string &path);
void writeFile(const std::string &path, const std::string &text);
/// The files of this name in the chapters of tests/language, sorted.
std::vector<std::string> languageFiles(const std::string &name);
/// The folder of such a file: "04-numbers".
std::string chapterOf(const std::string &path);
} // namespace rtsl::test
