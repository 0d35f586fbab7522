//===- PreprocessorTest.cpp - expanded texts, the way back, and limits ----===//
//
// What the preprocessor accepts and refuses is in tests/language/preprocessor. Here: how messages
// are shown, what fixes touch, what the text looks like, and limits of what a few lines can expand
// to.
//
//===----------------------------------------------------------------------===//
#include "frontend/preprocessor/Preprocessor.h"
#include "frontend/source/Expansion.h"
#include "frontend/syntax/Parser.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>

using namespace rtsl;

namespace {

/// Texts that include one another, in memory, of which "main.rtsl" is preprocessed and parsed.
struct Preprocessed {
  explicit Preprocessed(const std::string &main,
                        const std::map<std::string, std::string> &others = {},
                        const PreprocessorOptions &options = {})
      : file(sources.add("main.rtsl", main)) {
    for (const auto &[name, text] : others)
      sources.add(name, text);
    result = preprocess(file, sources, options, diagnostics);
    if (result.isUsable)
      unit = parse(result.text, diagnostics);
  }

  std::string text() const { return std::string(sources.text(result.text)); }
  std::string printed() const { return printPreprocessed(result.text, sources); }
  std::string shown() const { return renderText(diagnostics, false); }
  std::string fixed() const { return applyFixes(diagnostics, file).text; }
  std::string codes() const {
    std::string codes;
    for (const Diagnostic &diagnostic : diagnostics.all())
      codes += std::string(codes.empty() ? "" : " ") + info(diagnostic.code).number;
    return codes;
  }

  SourceManager sources;
  Diagnostics diagnostics{sources};
  FileId file;
  PreprocessedFile result;
  std::unique_ptr<ast::TranslationUnit> unit;
};

std::string repeated(const std::string &text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i)
    result += text;
  return result;
}

//===----------------------------------------------------------------------===//
// Texts
//===----------------------------------------------------------------------===//

TEST(Preprocessor, LeavesATextAloneThatNeedsNothing) {
  const Preprocessed source("float f() { return 1.0; } // \\ __ nothing\n");
  const Preprocessed plain("float f() { print(\"\\n\"); return 1.0; }\n");
  EXPECT_EQ(plain.result.text, plain.file);
  EXPECT_NE(source.result.text, source.file); // two underscores may be a macro of the language
  EXPECT_EQ(source.text(), source.sources.text(source.file));
}

TEST(Preprocessor, KeepsCommentsSpacesAndLines) {
  const std::string text = "// head\n\n/* a\n   b */ float  f( ) // tail\n{\treturn 1.0; }\n";
  const Preprocessed source("#define X 1\n" + text + "#undef X // gone\n" + text);
  EXPECT_EQ(source.text(), "\n" + text + "\n" + text);
}

TEST(Preprocessor, KeepsCommentsWithWhatTheyStandAbove) {
  const Preprocessed source(
      "// of nothing\n#define X\nfloat a;\n#ifdef X\n// of b\nfloat b;\n#endif\n"
      "// of nothing\n#include \"c.rtsl\"\nfloat d;\n",
      {{"c.rtsl", "float c;\n// of nothing"}});
  std::string comments;
  for (const ast::VariableDecl &variable : source.unit->constants)
    comments += variable.name.text + ": " + variable.comment + "\n";
  EXPECT_EQ(comments, "a: \nb: // of b\nc: \nd: \n");
}

TEST(Preprocessor, PrintsWhatCanBeReadAgain) {
  const std::map<std::string, std::string> others = {
      {"lib.rtsl", "#define HALF(x) ((x) * 0.5)\nfloat lib() { return 1.0; }\n"}};
  const Preprocessed source("#include \"lib.rtsl\"\n#if 0\n" + repeated("\n", 20) +
                                "#endif\nfloat f() {\n  return HALF(lib()); }\n",
                            others);
  EXPECT_EQ(source.printed(), "#line 2 \"lib.rtsl\"\n"
                              "float lib() { return 1.0; }\n"
                              "#line 24 \"main.rtsl\"\n"
                              "float f() {\n"
                              "  return ((lib()) * 0.5); }\n");
  const Preprocessed again(source.printed());
  EXPECT_EQ(dump(*again.unit), dump(*source.unit));
  EXPECT_EQ(again.shown(), "");
}

TEST(Preprocessor, PutsSpacesBetweenWordsThatWouldJoin) {
  const Preprocessed source("#define N -x\n#define E =\n#define W a\nfloat f = -N + 1 E= W b;\n");
  EXPECT_EQ(source.text(), "\n\n\nfloat f = - -x + 1 = = a b;\n");
}

TEST(Preprocessor, TakesMacrosFromTheCommandLineInTheirOrder) {
  PreprocessorOptions options;
  options.macros = {{"A", "1.0"}, {"B", "2.0"}, {"B", "", true}, {"A", "3.0"}};
  const Preprocessed source("#ifdef B\nfloat b;\n#endif\nconst float a = A;\n", {}, options);
  EXPECT_EQ(source.printed(), "#line 4 \"main.rtsl\"\nconst float a = 3.0;\n");
  const Preprocessed plain("const float a = A;\n", {}, options); // no directive in sight
  EXPECT_EQ(plain.text(), "const float a = 3.0;\n");
}

//===----------------------------------------------------------------------===//
// Places
//===----------------------------------------------------------------------===//

TEST(Preprocessor, ShowsTheUseAndTheDefinitionOfAMacro) {
  const Preprocessed source("#define OPEN(x) ((x) + 2.0\n"
                            "float f() { return OPEN(1.0); }\n");
  EXPECT_EQ(source.shown(), "main.rtsl:2:20: error[E0113]: `(` is never closed\n"
                            "  |\n"
                            "1 | #define OPEN(x) ((x) + 2.0\n"
                            "  |                 - expanded from macro `OPEN`\n"
                            "2 | float f() { return OPEN(1.0); }\n"
                            "  |                    ^^^^^^^^^ in this use of macro `OPEN`\n"
                            "help: insert `)`\n"
                            "  |\n"
                            "2 | float f() { return OPEN(1.0)); }\n"
                            "  |                             +\n"
                            "\n");
}

TEST(Preprocessor, ShowsArgumentsWhereTheyStand) {
  const Preprocessed source("#define TWICE(x) ((x) * 2.0)\n"
                            "#define MORE(y) (TWICE(y) + 1.0)\n"
                            "float f() { return MORE(3.0 4.0); }\n");
  EXPECT_EQ(source.shown(), "main.rtsl:3:29: error[E0111]: expected `,` or `)`, found `4.0`\n"
                            "  |\n"
                            "1 | #define TWICE(x) ((x) * 2.0)\n"
                            "  |                    - expanded from macro `TWICE`\n"
                            "2 | #define MORE(y) (TWICE(y) + 1.0)\n"
                            "  |                        - expanded from macro `MORE`\n"
                            "3 | float f() { return MORE(3.0 4.0); }\n"
                            "  |                             ^^^ in this use of macro `MORE`\n"
                            "\n");
}

TEST(Preprocessor, ShowsAWordOverTwoLines) {
  const Preprocessed source("float f() { return 1.0 mis\\\nsing; }\n");
  EXPECT_EQ(source.shown(), "main.rtsl:1:24: error[E0111]: expected `;`, found `missing`\n"
                            "  |\n"
                            "1 | float f() { return 1.0 mis\\\n"
                            "  |                        ^^^^\n"
                            "2 | sing; }\n"
                            "  | ^^^^\n"
                            "\n");
}

TEST(Preprocessor, ReportsOnceWhatAMacroExpandsTwice) {
  const Preprocessed source("#define TWICE(x) float a = x; float b = x;\nTWICE(1.0 2.0)\n");
  EXPECT_EQ(source.codes(), "E0111");
}

TEST(Preprocessor, NamesTheFilesThatIncluded) {
  const Preprocessed source("\n#include \"a.rtsl\"\n", {{"a.rtsl", "\n\n#include \"b.rtsl\"\n"},
                                                        {"b.rtsl", "float f() { return 1.0 }\n"}});
  EXPECT_EQ(source.shown(), "b.rtsl:1:23: error[E0112]: missing `;` after `1.0`\n"
                            "  |\n"
                            "1 | float f() { return 1.0 }\n"
                            "  |                       ^\n"
                            "  = note: included from a.rtsl:3\n"
                            "  = note: included from main.rtsl:2\n"
                            "help: insert `;`\n"
                            "  |\n"
                            "1 | float f() { return 1.0; }\n"
                            "  |                       +\n"
                            "\n");
  EXPECT_EQ(source.result.includes, (std::vector<std::string>{"a.rtsl", "b.rtsl"}));
}

TEST(Preprocessor, ShowsWhatTheCommandLineDefined) {
  PreprocessorOptions options;
  options.macros = {{"VALUE", "1.0 2.0"}};
  const Preprocessed source("float f() { return VALUE; }\n", {}, options);
  EXPECT_EQ(source.shown(), "main.rtsl:1:20: error[E0111]: expected `;`, found `2.0`\n"
                            "  |\n"
                            "1 | float f() { return VALUE; }\n"
                            "  |                    ^^^^^ in this use of macro `VALUE`\n"
                            " --> <command line>:2:19\n"
                            "  |\n"
                            "2 | #define VALUE 1.0 2.0\n"
                            "  |                   --- expanded from macro `VALUE`\n"
                            "\n");
}

TEST(Preprocessor, ShowsBothEndsOfAConflict) {
  const Preprocessed source("#define A 1\n#define A 2\n#if 1\nfloat f() { return 1.0; }\n");
  EXPECT_EQ(source.shown(),
            "main.rtsl:2:9: error[E0157]: macro `A` is already defined differently\n"
            "  |\n"
            "1 | #define A 1\n"
            "  |         - defined here first\n"
            "2 | #define A 2\n"
            "  |         ^\n"
            "  = note: write `#undef A` before it\n"
            "\n"
            "main.rtsl:3:2: error[E0151]: `#if` without `#endif`\n"
            "  |\n"
            "3 | #if 1\n"
            "  |  ^^\n"
            "4 | float f() { return 1.0; }\n"
            "5 |\n"
            "  | - the file ends here\n"
            "\n");
}

TEST(Preprocessor, ReportsUnderTheNameAndLineOfALineDirective) {
  const Preprocessed source("#line 70 \"other.rtsl\"\n\nfloat f() { return 1.0 }\n");
  EXPECT_NE(source.shown().find("other.rtsl:71:23: error[E0112]"), std::string::npos)
      << source.shown();
  EXPECT_NE(source.shown().find("71 | float f() { return 1.0 }"), std::string::npos)
      << source.shown();
  EXPECT_EQ(source.fixed(),
            "#line 70 \"other.rtsl\"\n\nfloat f() { return 1.0; }\n"); // in the file itself
  const std::string json = renderJson(source.diagnostics);
  EXPECT_NE(json.find("\"file\": \"other.rtsl\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"written\": {"), std::string::npos) << json;
}

//===----------------------------------------------------------------------===//
// Fixes
//===----------------------------------------------------------------------===//

TEST(Preprocessor, FixesWhatTheAuthorWroteInPlace) {
  const Preprocessed source("#define ONE 1.0\nfloat f() {\n  float a = ONE\n  return a + ONE\n}\n");
  EXPECT_EQ(source.fixed(),
            "#define ONE 1.0\nfloat f() {\n  float a = ONE;\n  return a + ONE;\n}\n");
}

TEST(Preprocessor, FixesNothingInsideOfMacrosAndIncludes) {
  const std::string text = "#include \"a.rtsl\"\n"
                           "#define BODY uniform float x; float y = 1f;\n"
                           "#define SAME(x) x\n"
                           "BODY\n"
                           "SAME(float z = 1f;)\n";
  const std::string included = "float f() { return 1.0 }\n";
  const Preprocessed source(text, {{"a.rtsl", included}});
  EXPECT_GE(source.diagnostics.errorCount(), 3u) << source.shown();
  EXPECT_EQ(source.fixed(), text);
  EXPECT_EQ(applyFixes(source.diagnostics, source.sources.find("a.rtsl")).text, included);
  EXPECT_TRUE(filesToFix(source.diagnostics).empty());
}

TEST(Preprocessor, RemovesDirectivesOfGlsl) {
  const Preprocessed source("#version 460\nfloat f() { return 1.0; }\n");
  EXPECT_EQ(source.fixed(), "\nfloat f() { return 1.0; }\n");
}

//===----------------------------------------------------------------------===//
// Bad input
//===----------------------------------------------------------------------===//

/// `size` macros, each of which uses the one before it twice.
std::string doublingMacros(int size, const std::string &join) {
  std::string text = "#define A0 1\n";
  for (int i = 1; i < size; ++i)
    text += fmt::format("#define A{0} A{1} {2} A{1}\n", i, i - 1, join);
  return text;
}

struct Bomb {
  const char *name;
  std::string text;
  const char *codes;
};

void PrintTo(const Bomb &bomb, std::ostream *stream) {
  *stream << bomb.name;
}

class Bombs : public testing::TestWithParam<Bomb> {};

// None of them takes long, and none of them takes the stack.
TEST_P(Bombs, AreRefused) {
  const auto start = std::chrono::steady_clock::now();
  const Preprocessed source(GetParam().text,
                            {{"self.rtsl", "#include \"self.rtsl\"\n#include \"self.rtsl\"\n"}});
  EXPECT_EQ(source.codes(), GetParam().codes) << source.shown().substr(0, 2000);
  EXPECT_LT(std::chrono::steady_clock::now() - start,
            std::chrono::seconds(60)); // seconds on a loaded machine
}

INSTANTIATE_TEST_SUITE_P(
    Preprocessor, Bombs,
    testing::Values(Bomb{"Objects", doublingMacros(31, "+") + "const int x = A30;\n", "E0164"},
                    Bomb{"Condition", doublingMacros(31, "+") + "#if A30\n#endif\n", "E0164"},
                    Bomb{"Include", doublingMacros(31, "") + "#include A30\n", "E0146"},
                    Bomb{"Arguments",
                         "#define F(x) x x\nconst int x = " + repeated("F(", 30) + "1" +
                             repeated(")", 30) + ";\n",
                         "E0164"},
                    Bomb{"ArgumentsOfOthers",
                         [] {
                           std::string text = "#define B0(x) x\n";
                           for (int i = 1; i < 40; ++i)
                             text += fmt::format("#define B{}(x) B{}(x x)\n", i, i - 1);
                           return text + "const int x = B39(1);\n";
                         }(),
                         "E0164"},
                    Bomb{"DeepArguments",
                         "#define F(x) x\nconst int x = " + repeated("F(", 300) + "1" +
                             repeated(")", 300) + ";\n",
                         "E0165"},
                    Bomb{"VeryDeepArguments",
                         "#define F(x) x\nconst int x = " + repeated("F(", 100000) + "1" +
                             repeated(")", 100000) + ";\n",
                         "E0164"},
                    Bomb{"DeepBodies",
                         [] {
                           std::string text = "#define C0 1\n";
                           for (int i = 1; i < 100000; ++i)
                             text += fmt::format("#define C{} C{}\n", i, i - 1);
                           return text + "const int x = C99999;\n";
                         }(),
                         "E0165"},
                    Bomb{"DeepCondition", "#if " + repeated("(", 1000000) + "1\n#endif\n", "E0154"},
                    Bomb{"DeepSigns", "#if 1\n#elif " + repeated("!", 1000000) + "1\n#endif\n",
                         "E0154"},
                    Bomb{"Includes", "#include \"self.rtsl\"\n", "E0147"},
                    Bomb{"Itself", "#include \"main.rtsl\"\n", "E0147"}),
    [](const testing::TestParamInfo<Bomb> &info) { return std::string(info.param.name); });

TEST(Preprocessor, CountsNestingBehindMacros) {
  const Preprocessed source("#define TEN(x) ((((((((((x))))))))))\n"
                            "const int x = " +
                            repeated("TEN(", 30) + "1" + repeated(")", 30) + ";\n");
  EXPECT_EQ(source.codes(), "E0109") << source.shown();
}

TEST(Preprocessor, ShowsTheWayIntoACircle) {
  const Preprocessed source("#include \"a.rtsl\"\n", {{"a.rtsl", "#include \"b.rtsl\"\n"},
                                                      {"b.rtsl", "\n#include \"a.rtsl\"\n"}});
  EXPECT_EQ(source.shown(),
            "b.rtsl:2:10: error[E0147]: includes are nested deeper than 100 levels\n"
            "  |\n"
            "2 | #include \"a.rtsl\"\n"
            "  |          ^^^^^^^^\n"
            "  = note: included from a.rtsl:1\n"
            "  = note: included from b.rtsl:2\n"
            "  = note: included from a.rtsl:1\n"
            "  = note: included from b.rtsl:2\n"
            "  = note: included from a.rtsl:1\n"
            "  = note: included from main.rtsl:1\n"
            "  = note: `#pragma once` in an included file keeps it from being included again\n"
            "\n");
}

TEST(Preprocessor, LimitsWhatIsIncluded) {
  std::map<std::string, std::string> others;
  for (int i = 0; i < 30; ++i)
    others[fmt::format("{}.rtsl", i)] =
        fmt::format("#include \"{0}.rtsl\"\n#include \"{0}.rtsl\"\n", i + 1);
  others["30.rtsl"] = "";
  const Preprocessed source("#include \"0.rtsl\"\n", others);
  EXPECT_EQ(source.codes(), "E0148") << source.shown();
}

TEST(Preprocessor, RefusesFilesThatAreNoText) {
  const Preprocessed source("#include \"a.bin\"\nfloat f() { return missing(; }\n",
                            {{"a.bin", std::string("a\0b", 3)}});
  EXPECT_EQ(source.shown(),
            "a.bin:1:2: error[E0101]: source is not valid text: it holds a NUL byte\n"
            "  |\n"
            "1 | a\\x00b\n"
            "  |  ^^^^\n"
            "  = note: included from main.rtsl:1\n"
            "\n");
}

TEST(Preprocessor, ReadsLongLinesAndLongTexts) {
  const Preprocessed line("#define X(a) a\nconst float x = 0.0" + repeated(" + X(1.0)", 900) + ";" +
                          repeated(" ", 1 << 20) + "\n");
  EXPECT_EQ(line.shown(), "");
  const Preprocessed text("#define ONE 1.0\n" +
                          repeated("/* ONE */ const float x = ONE;\n", 100000));
  EXPECT_EQ(text.shown(), "");
  EXPECT_EQ(text.sources.text(text.result.text).size(), 1u + 31u * 100000u);
}

// Every position of the expanded text has an origin, and verbatim pieces say what stands there.
TEST(Preprocessor, MapsEveryByteToItsSource) {
  const Preprocessed source("#include \"a.rtsl\"\n#define F(x, y) x##y + #x y\nfloat g = F(one, "
                            "two(F(3, 4)));\\\n int h;\n#if 0\n#else\n"
                            "int k = __LINE__;\n#endif\n",
                            {{"a.rtsl", "\xEF\xBB\xBF// included\nint a;"}});
  const ExpandedText *text = source.sources.expanded(source.result.text);
  ASSERT_TRUE(text);
  for (std::uint32_t begin = 0; begin < text->text.size(); ++begin)
    for (const std::uint32_t size : {0u, 1u, 5u, 1000u}) {
      const WrittenRange place = source.sources.written({source.result.text, begin, begin + size});
      ASSERT_TRUE(place.range.isValid());
      ASSERT_LE(place.range.begin, place.range.end) << begin << " " << size;
      ASSERT_LE(place.range.end, source.sources.text(place.range.file).size());
      if (place.isVerbatim && size == 1 && place.range.end > place.range.begin) {
        ASSERT_EQ(source.sources.text(place.range), text->text.substr(begin, 1)) << begin;
      }
    }
}

} // namespace
