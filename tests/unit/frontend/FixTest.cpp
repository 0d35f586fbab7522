//===- FixTest.cpp - fixes that are applied -------------------------------===//
#include "Parsed.h"

#include <gtest/gtest.h>

namespace rtsl {
namespace {

using test::fixed;

class Fixes : public testing::Test {
protected:
  SourceRange at(std::uint32_t begin, std::uint32_t end) const { return {file, begin, end}; }
  FixedText apply() const { return applyFixes(diagnostics, file); }

  SourceManager sources;
  FileId file = sources.add("a.rtsl", "0123456789");
  Diagnostics diagnostics{sources};
};

TEST_F(Fixes, ReplaceInsertAndRemove) {
  diagnostics.report(Code::notCallable, at(8, 9)).fix(at(8, 9), "", true);
  diagnostics.report(Code::notCallable, at(0, 1)).fix(at(0, 1), "zero", true);
  diagnostics.report(Code::notCallable, at(4, 4)).fix(at(4, 4), "+", true);
  const FixedText result = apply();
  EXPECT_EQ(result.text, "zero123+45679");
  EXPECT_EQ(result.applied, 3u);
  EXPECT_EQ(result.skipped, 0u);
}

TEST_F(Fixes, ThatAreNotSureAreLeft) {
  diagnostics.report(Code::notCallable, at(0, 1)).fix(at(0, 1), "zero");
  EXPECT_EQ(apply().text, "0123456789");
  EXPECT_EQ(apply().applied, 0u);
}

TEST_F(Fixes, ThatOverlapAreSkipped) {
  diagnostics.report(Code::notCallable, at(2, 5)).fix(at(2, 5), "abc", true);
  diagnostics.report(Code::notCallable, at(4, 6)).fix(at(4, 6), "x", true); // shares a byte
  diagnostics.report(Code::notCallable, at(3, 3)).fix(at(3, 3), "y", true); // inserts inside
  diagnostics.report(Code::notCallable, at(5, 6)).fix(at(5, 6), "z", true); // only touches
  diagnostics.report(Code::notCallable, at(7, 7)).fix(at(7, 7), "1", true);
  diagnostics.report(Code::missingIndex, at(7, 7)).fix(at(7, 7), "2", true); // same place
  const FixedText result = apply();
  EXPECT_EQ(result.text, "01abcz61789");
  EXPECT_EQ(result.applied, 3u);
  EXPECT_EQ(result.skipped, 3u);
}

TEST_F(Fixes, OfOneMessageAreAppliedTogetherOrNotAtAll) {
  diagnostics.report(Code::notCallable, at(1, 2)).fix(at(1, 2), "one", true);
  diagnostics.report(Code::notCallable, at(0, 9)).fix(at(0, 0), "(", true).fix(at(9, 9), ")", true);
  diagnostics.report(Code::missingIndex, at(0, 9))
      .fix(at(5, 6), "five", true)
      .fix(at(1, 2), "uno", true);
  const FixedText result = apply();
  EXPECT_EQ(result.text, "(0one2345678)9");
  EXPECT_EQ(result.applied, 2u);
  EXPECT_EQ(result.skipped, 1u);
}

TEST_F(Fixes, OfOtherFilesAreLeft) {
  const FileId other = sources.add("b.rtsl", "text");
  diagnostics.report(Code::notCallable, at(0, 1)).fix({other, 0, 4}, "changed", true);
  EXPECT_EQ(apply().text, "0123456789");
  EXPECT_EQ(applyFixes(diagnostics, other).text, "changed");
}

TEST(SyntaxFixes, MendTheText) {
  EXPECT_EQ(fixed("class A : public rt_Material {\n"
                  "  public highp float a = 1f\n"
                  "  void shade() {\n"
                  "    b->c = 2;\n"
                  "    d = 3 \xE2\x80\x93 4;\n"
                  "    return\n"
                  "  }\n"
                  "}\n"),
            "class A : rt_Material {\n"
            "  public float a = 1.0f;\n"
            "  void shade() {\n"
            "    b.c = 2;\n"
            "    d = 3 - 4;\n"
            "    return;\n"
            "  }\n"
            "};\n");
}

TEST(SyntaxFixes, LeaveNothingToMend) {
  const std::string text = fixed("precision highp float;\n"
                                 "class A : rt_Light;\n"
                                 "float x = 1\n"
                                 "constructor(float b) { x = b; }\n");
  EXPECT_EQ(test::Parsed(text).messages(), "");
}

} // namespace
} // namespace rtsl
