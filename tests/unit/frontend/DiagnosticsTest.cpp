//===- DiagnosticsTest.cpp - messages as they are recorded and shown ------===//
#include "frontend/diagnostics/Diagnostics.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cctype>
#include <set>

namespace rtsl {
namespace {

constexpr const char *text = "half a = b + c;\n"
                             "\tfloat tabbed = x;\n"
                             "line three\n"
                             "line four\n"
                             "line five\n";

class Messages : public testing::Test {
protected:
  std::uint32_t find(std::string_view what) const {
    return static_cast<std::uint32_t>(sources.text(file).find(what));
  }
  /// The range of the first place where `what` stands.
  SourceRange at(std::string_view what) const {
    const std::uint32_t begin = find(what);
    return {file, begin, begin + static_cast<std::uint32_t>(what.size())};
  }
  std::string shown() const { return renderText(diagnostics, false); }

  SourceManager sources;
  FileId file = sources.add("a.rtsl", text);
  Diagnostics diagnostics{sources};
};

TEST(CodeTable, IsInOrder) {
  std::set<std::string> numbers, names;
  const Code all[] = {
#define RTSL_DIAGNOSTIC(id, number, severity, message) Code::id,
#include "frontend/diagnostics/DiagnosticCodes.def"
  };
  for (const Code code : all) {
    const CodeInfo &row = info(code);
    const std::string number = row.number, message = row.message;
    EXPECT_TRUE(numbers.insert(number).second) << number << " is used twice";
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " is used twice";
    EXPECT_EQ(number[0], std::toupper(nameOf(row.severity)[0])) << number;
    EXPECT_EQ(number.size(), 5u) << number;
    ASSERT_FALSE(message.empty());
    EXPECT_NE(message.back(), '.') << number << " ends in a full stop";
    // Lower case, unless the first word is a name such as RTSL.
    EXPECT_FALSE(std::isupper(static_cast<unsigned char>(message[0])) &&
                 std::islower(static_cast<unsigned char>(message[1])))
        << number << " begins with a capital";
  }
}

TEST_F(Messages, ShowPlaceLineAndCaret) {
  diagnostics.report(Code::unknownCharacter, at("b"), "b");
  EXPECT_EQ(shown(), "a.rtsl:1:10: error[E0103]: unknown character `b`\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |          ^\n"
                     "\n");
}

TEST_F(Messages, UnderlineTheWholeRange) {
  diagnostics.report(Code::notCallable, at("b + c"));
  EXPECT_EQ(shown(), "a.rtsl:1:10: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |          ^^^^^\n"
                     "\n");
}

TEST_F(Messages, ShowOneCaretForAnEmptyRangeAtTheEndOfALine) {
  diagnostics.report(Code::missingSemicolon, SourceRange{file, 15, 15}, "`c`");
  EXPECT_EQ(shown(), "a.rtsl:1:16: error[E0112]: missing `;` after `c`\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |                ^\n"
                     "\n");
}

TEST_F(Messages, ExpandTabs) {
  diagnostics.report(Code::notCallable, at("tabbed"));
  EXPECT_EQ(shown(), "a.rtsl:2:8: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "2 |     float tabbed = x;\n"
                     "  |           ^^^^^^\n"
                     "\n");
}

TEST_F(Messages, PutTheTextOfTheLastLabelBehindItsUnderline) {
  diagnostics.report(Code::notCallable, at("b")).label(at("c"), "a `float`");
  EXPECT_EQ(shown(), "a.rtsl:1:10: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |          ^   - a `float`\n"
                     "\n");
}

TEST_F(Messages, HangTheOtherLabelsOfALineBelowIt) {
  diagnostics.report(Code::notCallable, at("+"))
      .label(at("half"), "declared here")
      .label(at("b"), "a `vec3`")
      .label(at("c"), "a `float`")
      .label(at("+"), "no such operator");
  EXPECT_EQ(shown(), "a.rtsl:1:12: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  | ----     - ^ - a `float`\n"
                     "  | |        | |\n"
                     "  | |        | no such operator\n"
                     "  | |        a `vec3`\n"
                     "  | declared here\n"
                     "\n");
}

TEST_F(Messages, ShowLabelsOnOtherLines) {
  diagnostics.report(Code::notCallable, at("five")).label(at("a ="), "here");
  EXPECT_EQ(shown(), "a.rtsl:5:6: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |      --- here\n"
                     "...\n"
                     "5 | line five\n"
                     "  |      ^^^^\n"
                     "\n");
}

TEST_F(Messages, ShowTheOneLineBetweenTwoOthers) {
  diagnostics.report(Code::notCallable, at("five")).label(at("three"), "here");
  EXPECT_EQ(shown(), "a.rtsl:5:6: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "3 | line three\n"
                     "  |      ----- here\n"
                     "4 | line four\n"
                     "5 | line five\n"
                     "  |      ^^^^\n"
                     "\n");
}

TEST_F(Messages, ShowLabelsInOtherFiles) {
  const FileId other = sources.add("other.rtsl", "class Base : rt_Light;\n");
  diagnostics.report(Code::notCallable, at("b")).label({other, 6, 10}, "declared here");
  EXPECT_EQ(shown(), "a.rtsl:1:10: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |          ^\n"
                     " --> other.rtsl:1:7\n"
                     "  |\n"
                     "1 | class Base : rt_Light;\n"
                     "  |       ---- declared here\n"
                     "\n");
}

TEST_F(Messages, ShowTheFirstAndTheLastLineOfALongRange) {
  diagnostics.report(Code::notCallable, SourceRange{file, find("b +"), find(" five")});
  EXPECT_EQ(shown(), "a.rtsl:1:10: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |          ^^^^^^\n"
                     "...\n"
                     "5 | line five\n"
                     "  | ^^^^\n"
                     "\n");
}

TEST_F(Messages, EndALineRangeAtItsLineEnding) {
  diagnostics.report(Code::notCallable, SourceRange{file, find("three"), find("line four")});
  EXPECT_EQ(shown(), "a.rtsl:3:6: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "3 | line three\n"
                     "  |      ^^^^^\n"
                     "\n");
}

TEST_F(Messages, ShowNotesAndFixes) {
  diagnostics.report(Code::notCallable, at("c"))
      .note("a note")
      .fix(at("c"), "cc")
      .fix({file, 14, 14}, ")")
      .fix(at(" + c"), "");
  EXPECT_EQ(shown(), "a.rtsl:1:14: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |              ^\n"
                     "  = note: a note\n"
                     "help: replace `c` by `cc`\n"
                     "  |\n"
                     "1 | half a = b + cc;\n"
                     "  |              ~~\n"
                     "help: insert `)`\n"
                     "  |\n"
                     "1 | half a = b + c);\n"
                     "  |               +\n"
                     "help: remove `+ c`\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |           ----\n"
                     "\n");
}

TEST_F(Messages, ShowFixesOfSeveralLines) {
  diagnostics.report(Code::notCallable, at("b")).fix({file, 0, 0}, "int x;\nint y;\n");
  EXPECT_EQ(shown(), "a.rtsl:1:10: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | half a = b + c;\n"
                     "  |          ^\n"
                     "help: insert this\n"
                     "  |\n"
                     "  + int x;\n"
                     "  + int y;\n"
                     "\n");
}

TEST_F(Messages, AlignTheGutterToTheLargestLineNumber) {
  const FileId other = sources.add("long.rtsl", std::string(99, '\n') + "bad\n");
  diagnostics.report(Code::notCallable, SourceRange{other, 99, 102})
      .label({other, 98, 98}, "the line before");
  EXPECT_EQ(shown(), "long.rtsl:100:1: error[E0122]: expression is not callable\n"
                     "    |\n"
                     " 99 |\n"
                     "    | - the line before\n"
                     "100 | bad\n"
                     "    | ^^^\n"
                     "\n");
}

TEST_F(Messages, NeedNoPlace) {
  diagnostics.report(Code::cannotReadSource, SourceRange{}, "a", "No such file");
  diagnostics.report(Code::cannotReadSource, SourceRange{}, "b", "No such file");
  diagnostics.report(Code::cannotReadSource, SourceRange{}, "b", "No such file");
  EXPECT_EQ(shown(), "error[E0100]: cannot read `a`: No such file\n"
                     "\n"
                     "error[E0100]: cannot read `b`: No such file\n"
                     "\n");
}

TEST_F(Messages, ShowBytesThatAreNoCharacters) {
  const FileId other = sources.add("b\x1B.rtsl", "x = \xFF\x1B[31m \xC3\xA9 y;\n");
  diagnostics.report(Code::unknownCharacter, SourceRange{other, 14, 15}, "\xFE");
  EXPECT_EQ(shown(), "b\\x1B.rtsl:1:15: error[E0103]: unknown character `\\xFE`\n"
                     "  |\n"
                     "1 | x = \\xFF\\x1B[31m \xC3\xA9 y;\n"
                     "  |                    ^\n"
                     "\n");
}

TEST_F(Messages, CountTheCellsOfWideCharacters) {
  const FileId other = sources.add("wide.rtsl", "\xE6\x97\xA5\xE6\x9C\xAC x;\n");
  diagnostics.report(Code::notCallable, SourceRange{other, 7, 8});
  EXPECT_EQ(shown(), "wide.rtsl:1:8: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | \xE6\x97\xA5\xE6\x9C\xAC x;\n"
                     "  |      ^\n"
                     "\n");
}

TEST_F(Messages, ShowAWindowOfAVeryLongLine) {
  const std::string line = std::string(500000, 'a') + "!" + std::string(500000, 'b');
  const FileId other = sources.add("line.rtsl", line);
  diagnostics.report(Code::notCallable, SourceRange{other, 500000, 500001})
      .fix({other, 500000, 500001}, "?");
  EXPECT_EQ(shown(), "line.rtsl:1:500001: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | ..." +
                         std::string(50, 'a') + "!" + std::string(109, 'b') +
                         "...\n"
                         "  | " +
                         std::string(53, ' ') +
                         "^\n"
                         "help: replace `!` by `?`\n"
                         "  |\n"
                         "1 | ..." +
                         std::string(50, 'a') + "?" + std::string(109, 'b') +
                         "...\n"
                         "  | " +
                         std::string(53, ' ') +
                         "~\n"
                         "\n");
}

// Bytes as in the middle of a character, where no character begins: the window must not leave the
// place out.
TEST_F(Messages, ShowTheBeginningOfALongLineOfNoCharacters) {
  const FileId other = sources.add("line.rtsl", std::string(3, '\x80') + std::string(200, 'a'));
  diagnostics.report(Code::notCallable, SourceRange{other, 0, 1});
  EXPECT_EQ(shown(), "line.rtsl:1:1: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | \\x80\\x80\\x80" +
                         std::string(157, 'a') +
                         "...\n"
                         "  | ^^^^\n"
                         "\n");
}

TEST_F(Messages, ShowFarPlacesOfALongLineApart) {
  const FileId other = sources.add("line.rtsl", "(" + std::string(1000, 'a') + "!");
  diagnostics.report(Code::notCallable, SourceRange{other, 1001, 1002})
      .label({other, 0, 1}, "opened here");
  EXPECT_EQ(shown(), "line.rtsl:1:1002: error[E0122]: expression is not callable\n"
                     "  |\n"
                     "1 | ..." +
                         std::string(159, 'a') +
                         "!\n"
                         "  | " +
                         std::string(162, ' ') +
                         "^\n"
                         "1 | (" +
                         std::string(159, 'a') +
                         "...\n"
                         "  | - opened here\n"
                         "\n");
}

TEST_F(Messages, ClipRangesOfAMegabyte) {
  const FileId other = sources.add("line.rtsl", std::string(1000000, 'a'));
  diagnostics.report(Code::notCallable, SourceRange{other, 0, 1000000})
      .fix({other, 0, 1000000}, "");
  EXPECT_LT(shown().size(), 2000u);
}

TEST_F(Messages, AreColouredOnRequest) {
  diagnostics.report(Code::unknownCharacter, at("b"), "b").label(at("c"), "x");
  EXPECT_EQ(renderText(diagnostics, true),
            "\033[1ma.rtsl:1:10: \033[0m\033[1;31merror[E0103]\033[0m\033[1m: unknown character "
            "`b`\033[0m\n"
            "\033[34m  |\033[0m\n"
            "\033[34m1 |\033[0m half a = b + c;\n"
            "\033[34m  |\033[0m          \033[1;31m^\033[0m   \033[1;34m-\033[0m "
            "\033[1;34mx\033[0m\n"
            "\n");
}

TEST_F(Messages, AreRecordedOnce) {
  diagnostics.report(Code::notCallable, at("b"));
  diagnostics.report(Code::notCallable, at("b")).note("this goes nowhere");
  diagnostics.report(Code::missingIndex, at("b"));
  EXPECT_EQ(diagnostics.errorCount(), 2u);
  EXPECT_EQ(diagnostics.all().size(), 2u);
  EXPECT_TRUE(diagnostics.all()[0].notes.empty());
}

TEST_F(Messages, AreLimited) {
  for (std::uint32_t i = 0; i < 37; ++i)
    diagnostics.report(Code::notCallable, SourceRange{file, i, i + 1});
  EXPECT_EQ(diagnostics.errorCount(), 37u);
  EXPECT_EQ(diagnostics.hiddenErrors(), 17u);
  EXPECT_EQ(diagnostics.all().size(), 20u);
  EXPECT_TRUE(diagnostics.limitReached());
  const std::string output = shown();
  EXPECT_EQ(output.substr(output.rfind("\n\n") + 2), "17 more errors are not shown (limit 20)\n");
}

TEST_F(Messages, AreNotLimitedByZero) {
  diagnostics.errorLimit = 0;
  for (std::uint32_t i = 0; i < 37; ++i)
    diagnostics.report(Code::notCallable, SourceRange{file, i, i + 1});
  EXPECT_EQ(diagnostics.all().size(), 37u);
  EXPECT_FALSE(diagnostics.limitReached());
}

TEST_F(Messages, TurnWarningsIntoErrors) {
  diagnostics.reportText(Code::sceneWarning, at("b"), "odd");
  EXPECT_FALSE(diagnostics.hasErrors());
  EXPECT_EQ(shown().substr(0, shown().find('\n')), "a.rtsl:1:10: warning[W2800]: odd [-Wscene]");
  EXPECT_EQ(diagnostics.warnings.apply("error"), "");
  diagnostics.reportText(Code::sceneWarning, at("c"), "odd");
  EXPECT_TRUE(diagnostics.hasErrors());
}

TEST_F(Messages, OfSeveralStepsAreSortedByPlace) {
  Diagnostics found(sources);
  found.errorLimit = 3;
  found.report(Code::notCallable, at("c"));
  found.report(Code::notCallable, at("b"));
  found.report(Code::missingIndex, at("b"));
  found.report(Code::notCallable, at("five"));
  diagnostics.report(Code::notCallable, at("line"));
  diagnostics.addSorted(std::move(found));
  ASSERT_EQ(diagnostics.all().size(), 4u);
  EXPECT_EQ(diagnostics.all()[0].range, at("line"));
  EXPECT_EQ(diagnostics.all()[1].code, Code::notCallable);
  EXPECT_EQ(diagnostics.all()[1].range, at("b"));
  EXPECT_EQ(diagnostics.all()[2].code, Code::missingIndex);
  EXPECT_EQ(diagnostics.all()[3].range, at("c"));
  EXPECT_EQ(diagnostics.errorCount(), 5u);
  EXPECT_EQ(diagnostics.hiddenErrors(), 1u);
}

TEST_F(Messages, AsJson) {
  diagnostics.report(Code::unknownCharacter, at("b"), "b")
      .label(at("float"), "a label")
      .note("a note")
      .fix(at("b"), "c", true);
  const auto document = nlohmann::json::parse(renderJson(diagnostics));
  const auto expected = nlohmann::json::parse(R"({
    "version": 1,
    "diagnostics": [{
      "code": "E0103", "name": "unknownCharacter", "warning": null, "severity": "error",
      "message": "unknown character `b`",
      "range": {"file": "a.rtsl",
                "begin": {"offset": 9, "line": 1, "column": 10},
                "end": {"offset": 10, "line": 1, "column": 11}},
      "labels": [{"range": {"file": "a.rtsl",
                            "begin": {"offset": 17, "line": 2, "column": 2},
                            "end": {"offset": 22, "line": 2, "column": 7}},
                  "message": "a label"}],
      "notes": ["a note"],
      "fixes": [{"range": {"file": "a.rtsl",
                           "begin": {"offset": 9, "line": 1, "column": 10},
                           "end": {"offset": 10, "line": 1, "column": 11}},
                 "replacement": "c", "sure": true}]
    }],
    "hiddenErrors": 0
  })");
  EXPECT_EQ(document, expected);
}

TEST_F(Messages, AsJsonReplaceBytesThatAreNotUtf8) {
  const FileId other = sources.add("\xFF.rtsl", "\xFE");
  diagnostics.report(Code::unknownCharacter, SourceRange{other, 0, 1}, "\xFE");
  diagnostics.report(Code::notCallable, SourceRange{});
  const auto document = nlohmann::json::parse(renderJson(diagnostics));
  EXPECT_EQ(document["diagnostics"][0]["message"], "unknown character `\xEF\xBF\xBD`");
  EXPECT_EQ(document["diagnostics"][0]["range"]["file"], "\xEF\xBF\xBD.rtsl");
  EXPECT_TRUE(document["diagnostics"][1]["range"].is_null());
}

} // namespace
} // namespace rtsl
