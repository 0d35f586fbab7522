//===- ConformanceTest.cpp - the chapters' programs, on every path --------===//
#include "Program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace rtsl::test {
namespace {

std::vector<ProgramFile> chapters() {
  std::vector<ProgramFile> files;
  for (const auto &chapter : std::filesystem::directory_iterator(RTSL_ROOT "/tests/language")) {
    std::ifstream stream(chapter.path() / "run.rtsl");
    if (stream)
      files.push_back({chapter.path().filename().string() + "/run.rtsl",
                       {std::istreambuf_iterator<char>(stream), {}}});
  }
  std::sort(files.begin(), files.end(),
            [](const ProgramFile &a, const ProgramFile &b) { return a.name < b.name; });
  return files;
}

class Conformance : public testing::TestWithParam<Configuration> {};

TEST_P(Conformance, OfEveryChapter) {
  std::size_t count = 0;
  EXPECT_EQ(runProgram(chapters(), GetParam(), count), "");
  EXPECT_GT(count, 40u);
}

INSTANTIATE_TEST_SUITE_P(Paths, Conformance, testing::ValuesIn(configurations()),
                         [](const testing::TestParamInfo<Configuration> &param) {
                           return param.param.name;
                         });

INSTANTIATE_TEST_SUITE_P(FastPaths, Conformance, testing::ValuesIn(fastConfigurations()),
                         [](const testing::TestParamInfo<Configuration> &param) {
                           return param.param.name;
                         });

INSTANTIATE_TEST_SUITE_P(DoublePaths, Conformance, testing::ValuesIn(doubleConfigurations()),
                         [](const testing::TestParamInfo<Configuration> &param) {
                           return param.param.name;
                         });

TEST(Conformance, FailuresAreSeen) {
  std::size_t count = 0;
  const std::string wrong = runProgram(
      {{"a", "int good(int zero) { return zero; }\nint bad(int zero) { return zero + 7; }\n"
             "class Bad : rt_Material { void shade() { rt_SampleColor = color(3.0); } };\n"
             "//! material: {\"class\": \"Bad\"}\n"}},
      configurations().front(), count);
  EXPECT_EQ(wrong, "a: bad says 7\na: Bad says 3\n");
  EXPECT_EQ(count, 3u);
}

} // namespace
} // namespace rtsl::test
