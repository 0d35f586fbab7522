//===- TokenErrorTest.cpp - mistakes in single tokens ----------------------===//
//
// Each text states all of its messages: one that is not expected fails its test, so that no slip
// gives two.
//
//===----------------------------------------------------------------------===//
#include "Parsed.h"

#include <gtest/gtest.h>

namespace rtsl {
namespace {

using test::inFunction;
using test::messages;
using test::Parsed;

TEST(Words, UnknownCharacters) {
  EXPECT_EQ(inFunction("a = b @ c;"), "E0103 2:7-2:8 unknown character `@`\n");
  EXPECT_EQ(inFunction("a = $b + c;"), "E0103 2:5-2:6 unknown character `$`\n");
  EXPECT_EQ(inFunction("a = \xCF\x80 * 2;"), "E0103 2:5-2:7 unknown character `\xCF\x80`\n");
  EXPECT_EQ(inFunction("'c';"), "E0103 2:1-2:4 unknown character `'c'`\n");
  EXPECT_EQ(inFunction("a = 'b + c;"), "E0103 2:5-2:6 unknown character `'`\n");
  EXPECT_EQ(Parsed("void f() {\n  a = b \xE2\x80\x93 c;\n}\n").shown(),
            "test.rtsl:2:9: error[E0103]: unknown character `\xE2\x80\x93`\n"
            "  |\n"
            "2 |   a = b \xE2\x80\x93 c;\n"
            "  |         ^\n"
            "help: replace `\xE2\x80\x93` by `-`\n"
            "  |\n"
            "2 |   a = b - c;\n"
            "  |         ~\n"
            "\n");
}

TEST(Words, CommentsAndStringsWithoutAnEnd) {
  EXPECT_EQ(Parsed("void f() { }\n  /* never\n  closed * /\n").shown(),
            "test.rtsl:2:3: error[E0104]: unterminated comment\n"
            "  |\n"
            "2 |   /* never\n"
            "  |   ^^\n"
            "\n");
  EXPECT_EQ(messages("/*"), "E0104 1:1-1:3 unterminated comment\n");
  EXPECT_EQ(messages("/*/"), "E0104 1:1-1:3 unterminated comment\n");
  EXPECT_EQ(Parsed("void f() {\n  print(\"a \\\" b);\n  c;\n}\n").shown(),
            "test.rtsl:2:9: error[E0105]: unterminated string\n"
            "  |\n"
            "2 |   print(\"a \\\" b);\n"
            "  |         ^\n"
            "help: insert `\"`\n"
            "  |\n"
            "2 |   print(\"a \\\" b\");\n"
            "  |                +\n"
            "\n");
  EXPECT_EQ(messages("import \"a"), "E0105 1:8-1:9 unterminated string\n");
}

TEST(Words, EscapesThatMeanNothing) {
  EXPECT_EQ(inFunction(R"(print("a\q b\n\0");)"),
            "E0107 2:9-2:11 unknown escape sequence `\\q`\n"
            "E0107 2:15-2:17 unknown escape sequence `\\0`\n");
}

TEST(Words, NumbersThatAreNone) {
  EXPECT_EQ(inFunction("a = 09;"), "E0106 2:5-2:7 `09` is not a valid number\n");
  EXPECT_EQ(inFunction("a = 0x;"), "E0106 2:5-2:7 `0x` is not a valid number\n");
  EXPECT_EQ(inFunction("a = 0xfg;"), "E0106 2:5-2:9 `0xfg` is not a valid number\n");
  EXPECT_EQ(inFunction("a = 1.2.3;"), "E0106 2:5-2:10 `1.2.3` is not a valid number\n");
  EXPECT_EQ(inFunction("a = 12abc;"), "E0106 2:5-2:10 `12abc` is not a valid number\n");
  EXPECT_EQ(inFunction("a = 1e+ + 1;"), "E0106 2:5-2:8 `1e+` is not a valid number\n");
  EXPECT_EQ(inFunction("a = 1.5h;"), "E0106 2:5-2:9 `1.5h` is not a valid number\n");
  EXPECT_EQ(inFunction("float 3x;"), "E0106 2:7-2:9 `3x` is not a valid number\n");
  EXPECT_EQ(Parsed("void f() {\n  a = 1f;\n}\n").shown(),
            "test.rtsl:2:7: error[E0106]: `1f` is not a valid number\n"
            "  |\n"
            "2 |   a = 1f;\n"
            "  |       ^^\n"
            "help: insert `.0`\n"
            "  |\n"
            "2 |   a = 1.0f;\n"
            "  |        ++\n"
            "\n");
}

TEST(Words, KeywordsAsNames) {
  EXPECT_EQ(messages("class A : rt_Light;\npublic float in = 3;\n"),
            "E0115 2:14-2:16 `in` is a keyword and cannot be used as a name\n");
  EXPECT_EQ(messages("void f(float out, vec3 class) { }\n"),
            "E0115 1:14-1:17 `out` is a keyword and cannot be used as a name\n"
            "E0115 1:24-1:29 `class` is a keyword and cannot be used as a name\n");
  EXPECT_EQ(inFunction("float default; int for = 1, a;"),
            "E0115 2:7-2:14 `default` is a keyword and cannot be used as a name\n"
            "E0115 2:20-2:23 `for` is a keyword and cannot be used as a name\n");
  EXPECT_EQ(inFunction("a.in = 2;"),
            "E0115 2:3-2:5 `in` is a keyword and cannot be used as a name\n");
  EXPECT_EQ(messages("void return() { }"),
            "E0115 1:6-1:12 `return` is a keyword and cannot be used as a name\n");
  EXPECT_EQ(messages("struct switch { float a; };\nclass do : rt_Light { };\n"),
            "E0115 1:8-1:14 `switch` is a keyword and cannot be used as a name\n"
            "E0115 2:7-2:9 `do` is a keyword and cannot be used as a name\n");
}

TEST(Words, PrecisionQualifiersAreToBeRemoved) {
  EXPECT_EQ(Parsed("precision mediump float;\nvoid f(highp vec3 a) { }\n").shown(),
            "test.rtsl:1:1: error[E0116]: RTSL has no precision qualifiers\n"
            "  |\n"
            "1 | precision mediump float;\n"
            "  | ^^^^^^^^^^^^^^^^^^^^^^^^\n"
            "help: remove `precision mediump float;`\n"
            "  |\n"
            "1 | precision mediump float;\n"
            "  | ------------------------\n"
            "\n"
            "test.rtsl:2:8: error[E0116]: RTSL has no precision qualifiers\n"
            "  |\n"
            "2 | void f(highp vec3 a) { }\n"
            "  |        ^^^^^\n"
            "help: remove `highp`\n"
            "  |\n"
            "2 | void f(highp vec3 a) { }\n"
            "  |        ------\n"
            "\n");
}

TEST(Words, PrecisionIsANameElsewhere) {
  EXPECT_EQ(messages("class A { public float precision = 0.1; public vec2 lowp; float highp; };\n"
                     "struct S { float precision; };\n"
                     "float mediump(float precision, S s) {\n"
                     "  precision = s.precision;\n"
                     "  float lowp = mediump(precision, s), highp = precision;\n"
                     "  return lowp * highp;\n"
                     "}\n"),
            "");
}

TEST(Words, Directives) { // those that the preprocessor left
  EXPECT_EQ(messages("void f() { } #define A 1\nvoid g() { }\n"),
            "E0141 1:14-1:15 `#` starts a directive only at the start of a line\n");
}

} // namespace
} // namespace rtsl
