//===- InputTest.cpp - texts that are no programs, or huge ones -----------===//
#include "Parsed.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace rtsl {
namespace {

using test::Parsed;

std::string repeated(const std::string &text, std::size_t count) {
  std::string result;
  result.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i)
    result += text;
  return result;
}

std::string inFunction(const std::string &statement) {
  return "void f() { " + statement + " }";
}

//===----------------------------------------------------------------------===//
// Nothing, and no text
//===----------------------------------------------------------------------===//

TEST(Input, OfNothing) {
  EXPECT_EQ(Parsed("").messages(), "E0102 1:1-1:1 file contains no declarations\n");
  EXPECT_EQ(Parsed("  \r\n\t\n").messages(), "E0102 1:1-1:1 file contains no declarations\n");
  EXPECT_EQ(Parsed("// only a comment").messages(),
            "E0102 1:1-1:1 file contains no declarations\n");
  EXPECT_EQ(Parsed("\xEF\xBB\xBF").messages(), "E0102 1:1-1:1 file contains no declarations\n");
}

TEST(Input, ThatIsNoText) {
  EXPECT_EQ(Parsed(std::string("float\n a\0b", 10)).messages(),
            "E0101 2:3-2:4 source is not valid text: it holds a NUL byte\n");
  EXPECT_EQ(Parsed("float \xE9;").messages(),
            "E0101 1:7-1:8 source is not valid text: the byte \\xE9 is not UTF-8\n");
  EXPECT_EQ(Parsed(std::string("\xFF\xFE\x61\0", 4)).messages(),
            "E0101 1:1-1:3 source is not valid text: it is encoded in UTF-16\n");
  EXPECT_EQ(Parsed(std::string("\x7F"
                               "ELF\2\1\1\0\0\xFF",
                               10))
                .shown(),
            "test.rtsl:1:8: error[E0101]: source is not valid text: it holds a NUL byte\n"
            "  |\n"
            "1 | \\x7FELF\\x02\\x01\\x01\\x00\\x00\\xFF\n"
            "  |                    ^^^^\n"
            "\n");
}

//===----------------------------------------------------------------------===//
// Too deep
//===----------------------------------------------------------------------===//

TEST(Depth, BracketsAreRefusedAtThe257th) {
  for (const char *bracket : {"(", "[", "{"}) {
    const Parsed parsed("float a = " + repeated(bracket, 200000));
    EXPECT_EQ(parsed.messages(), "E0109 1:267-1:268 brackets are nested deeper than 256 levels\n");
  }
  const std::string open = repeated("([", 128), close = repeated("])", 128);
  EXPECT_EQ(Parsed("const float a = " + open + "1" + close + ";").messages().substr(0, 5), "E0111")
      << "256 are not too many; that an index needs a base is another matter";
  EXPECT_EQ(
      Parsed("const float a = " + repeated("(", 256) + "1" + repeated(")", 256) + ";").messages(),
      "");
}

TEST(Depth, TheRefusedBracketIsShown) {
  EXPECT_EQ(Parsed("const float a = " + repeated("(", 200000)).shown(),
            "test.rtsl:1:273: error[E0109]: brackets are nested deeper than 256 levels\n"
            "  |\n"
            "1 | ..." +
                repeated("(", 160) +
                "...\n"
                "  | " +
                repeated(" ", 53) + "^\n\n");
}

TEST(Depth, OfOperatorsIsLimited) {
  const auto first = [](const std::string &statement) { // code, place and message
    return Parsed(inFunction(statement)).messages();
  };
  const std::string expression = "expression is nested deeper than 1000 levels\n";
  EXPECT_EQ(first(repeated("- ", 100000) + "1;"), "E0110 1:2012-1:2013 " + expression);
  EXPECT_EQ(first("x = " + repeated("1+", 100000) + "1;"), "E0110 1:2015-1:2016 " + expression);
  EXPECT_EQ(first(repeated("a = ", 100000) + "1;"), "E0110 1:4014-1:4015 " + expression);
  EXPECT_EQ(first("x = " + repeated("a ? b : ", 100000) + "1;"),
            "E0110 1:8010-1:8011 " + expression);
  EXPECT_EQ(first("x = " + repeated("a ? ", 100000) + "1;"), "E0110 1:4014-1:4015 " + expression);
  EXPECT_EQ(first("a" + repeated(".b", 100000) + ";"), "E0110 1:2013-1:2014 " + expression);
  EXPECT_EQ(first("a" + repeated("[0]", 100000) + ";"), "E0110 1:3012-1:3013 " + expression);
  EXPECT_EQ(first("a" + repeated("++", 100000) + ";"), "E0110 1:2013-1:2015 " + expression);
  EXPECT_EQ(first(repeated("a, ", 100000) + "1;"), "E0110 1:3012-1:3013 " + expression);
  EXPECT_EQ(first("x = (" + repeated("a, ", 100000) + "1);"), "E0110 1:3018-1:3019 " + expression);
  EXPECT_EQ(first("x = " + repeated("a ? b, ", 100000) + "1;"),
            "E0110 1:3514-1:3515 " + expression);
  // Neither brackets nor operators alone are too many.
  EXPECT_EQ(first(repeated("(" + repeated("-", 1) + repeated("~", 9), 110) + "1" +
                  repeated(")", 110) + ";")
                .substr(0, 6),
            "E0110 ");
  EXPECT_EQ(first("x = " + repeated("(", 110) + "1" + repeated(repeated("+1", 10) + ")", 110) + ";")
                .substr(0, 6),
            "E0110 ");
}

TEST(Depth, OfStatementsIsLimited) {
  const std::string statement = "statement is nested deeper than 1000 levels\n";
  const auto first = [](const std::string &text) { return Parsed(inFunction(text)).messages(); };
  EXPECT_EQ(first(repeated("if (x) ", 100000) + "y;"), "E0110 1:7005-1:7007 " + statement);
  EXPECT_EQ(first("if (x) {}" + repeated(" else if (x) {}", 10000)),
            "E0110 1:14997-1:14999 " + statement);
  EXPECT_EQ(first(repeated("for (;;) ", 100000) + "y;"), "E0110 1:9003-1:9006 " + statement);
  EXPECT_EQ(first(repeated("while (x) ", 100000) + "y;"), "E0110 1:10002-1:10007 " + statement);
  EXPECT_EQ(first(repeated("do ", 100000) + "y;"), "E0110 1:3012-1:3014 " + statement);
  EXPECT_EQ(first(repeated("switch (x) ", 100000) + "y;"), "E0110 1:11001-1:11007 " + statement);
  EXPECT_EQ(first(repeated("illuminance (x) ", 100000) + "y;"),
            "E0110 1:15996-1:16007 " + statement);
}

TEST(Depth, UpToTheLimitEverythingWorks) {
  // Parsed, built, dumped and destroyed on the stack of a test.
  for (const std::string &statement :
       {"x = " + repeated("1+", 990) + "1;", repeated("-", 1) + repeated(" -", 990) + "1;",
        repeated("a = ", 990) + "1;", "x = " + repeated("a ? b : ", 990) + "1;",
        repeated("if (x) ", 990) + "y;", "if (x) {}" + repeated(" else if (x) {}", 990),
        repeated("a, ", 990) + "1;", "a" + repeated("[0]", 990) + ";",
        "x = " + repeated("(-~", 250) + "1" + repeated(")", 250) + ";",
        repeated("if (x) {", 250) + repeated("}", 250)}) {
    const Parsed parsed(inFunction(statement));
    EXPECT_EQ(parsed.messages(), "") << statement.substr(0, 30);
    EXPECT_GT(parsed.tree().size(), 250u);
  }
}

TEST(Depth, LongIsNotDeep) {
  EXPECT_EQ(Parsed(inFunction(repeated("if (x) y; else z; ", 5000))).messages(), "");
  EXPECT_EQ(Parsed(inFunction(repeated("while (x) { } ", 5000))).messages(), "");
  EXPECT_EQ(Parsed(inFunction("f(" + repeated("-1, ", 5000) + "1);")).messages(), "");
  EXPECT_EQ(Parsed(inFunction("float " + repeated("a = -1, ", 5000) + "b;")).messages(), "");
  EXPECT_EQ(Parsed("const float a[] = {" + repeated("{-1, 2}, ", 5000) + "};").messages(), "");
  EXPECT_EQ(Parsed(inFunction("switch (x) { " + repeated("case -1: ", 5000) + " }")).messages(),
            "");
}

//===----------------------------------------------------------------------===//
// Long
//===----------------------------------------------------------------------===//

constexpr std::size_t tenMegabytes = 10'000'000;

/// Two megabytes take five seconds, so the rest is for `make deep`.
TEST(TenMegabytes, OfCode) {
  const std::string statement = "  if (r > 0.5) { x.xy = f(y, 1); }\n";
  const std::size_t bytes = std::getenv("RTSL_DEEP") ? tenMegabytes : tenMegabytes / 5;
  const Parsed parsed("void f() {\n" + repeated(statement, bytes / statement.size()) + "}\n");
  EXPECT_EQ(parsed.messages(), "");
  EXPECT_EQ(parsed.unit->functions.at(0).body->body.size(), bytes / statement.size());
}

TEST(TenMegabytes, OfOneComment) {
  const Parsed parsed("/*" + std::string(tenMegabytes, '*') + "*/ void f() { }");
  EXPECT_EQ(parsed.messages(), "");
  EXPECT_EQ(parsed.unit->functions.size(), 1u);
}

TEST(TenMegabytes, OfAnOpenComment) {
  EXPECT_EQ(Parsed("void f() { }\n/*" + repeated(" /* \n", tenMegabytes / 5)).messages(),
            "E0104 2:1-2:3 unterminated comment\n");
}

TEST(TenMegabytes, OfOneLine) {
  const Parsed parsed("class A : rt_Material; " + repeated("public float a; ", tenMegabytes / 16) +
                      "%");
  EXPECT_EQ(parsed.unit->classes.at(0).members.size(), tenMegabytes / 16);
  EXPECT_EQ(parsed.diagnostics.errorCount(), 1u);
  EXPECT_LT(parsed.shown().size(), 1000u);
}

TEST(ManyMistakes, AreCounted) {
  const Parsed parsed(inFunction(repeated("a b c; ", 5000)));
  EXPECT_EQ(parsed.diagnostics.all().size(), 20u);
  EXPECT_EQ(parsed.diagnostics.errorCount(), 5000u);
  const std::string shown = parsed.shown();
  EXPECT_EQ(shown.substr(shown.rfind("\n\n") + 2), "4980 more errors are not shown (limit 20)\n");
}

} // namespace
} // namespace rtsl
