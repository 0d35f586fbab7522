//===- AcceptedTest.cpp - what the language allows, and what it means -----===//
//
// Each tests/language/*/accepted.rtsl is checked without a message, and its typed tree is compared
// with the `accepted.typed` beside it.
//
//===----------------------------------------------------------------------===//
#include "Harness.h"

#include <gtest/gtest.h>

#include <filesystem>

using namespace rtsl;
using namespace rtsl::test;

namespace {

class Accepted : public testing::TestWithParam<std::string> {};

TEST_P(Accepted, HasTheTypedTree) {
  const std::string path = GetParam();
  const std::unique_ptr<Checked> checked = checkText(readFile(path));
  ASSERT_EQ(render(*checked), "");
  const std::string golden = std::filesystem::path(path).replace_extension(".typed").string();
  EXPECT_EQ(typed::dump(*checked->module), readFile(golden));
}

INSTANTIATE_TEST_SUITE_P(Language, Accepted, testing::ValuesIn(languageFiles("accepted.rtsl")),
                         [](const testing::TestParamInfo<std::string> &param) {
                           return testName(chapterOf(param.param));
                         });

} // namespace
