//===- ErrorsTest.cpp - every message, at its exact place -----------------===//
//
// The texts stand in tests/language/*/errors.rtsl. Adding a case there adds a test here.
//
//===----------------------------------------------------------------------===//
#include "Harness.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

using namespace rtsl;
using namespace rtsl::test;

namespace {

struct NamedCase {
  std::string name;
  Case content;
};

/// What GoogleTest shows of a parameter.
void PrintTo(const NamedCase &named, std::ostream *stream) {
  *stream << named.name;
}

std::vector<NamedCase> allCases() {
  std::vector<NamedCase> cases;
  for (const std::string &path : languageFiles("errors.rtsl"))
    for (Case &each : splitCases(readFile(path)))
      cases.push_back({testName(chapterOf(path) + "_" + each.title), std::move(each)});
  return cases;
}

class Errors : public testing::TestWithParam<NamedCase> {};

TEST_P(Errors, AreReportedWhereTheyAre) {
  const std::string &text = GetParam().content.text;
  EXPECT_EQ(withActualMessages(text), text) << render(*checkText(text));
}

INSTANTIATE_TEST_SUITE_P(Language, Errors, testing::ValuesIn(allCases()),
                         [](const testing::TestParamInfo<NamedCase> &param) {
                           return param.param.name;
                         });

// Codes that no text of reasonable length can provoke; LimitsTest.cpp does, and
// ../frontend/PreprocessorTest.cpp and cli/common/test_preprocessor.py. W2901 is found after sema,
// and tests/cli provokes it.
const char *const provokedElsewhere[] = {"E0320", "E0606", "E0608", "E0609", "E0611", "W2901",
                                         "E0145", "E0147", "E0148", "E0164", "E0165"};

TEST(Errors, EveryMessageOfSemaAndThePreprocessorHasATest) {
  std::string expectations;
  for (const std::string &path : languageFiles("errors.rtsl"))
    expectations += readFile(path);
  static const char *const numbers[] = {
#define RTSL_DIAGNOSTIC(id, number, severity, message) #number,
#include "frontend/diagnostics/DiagnosticCodes.def"
  };
  for (const char *number : numbers) {
    // E014x to E06xx, and the warnings that go with them or concern performance.
    const bool isSemas =
        std::strlen(number) == 5 && ((number[0] == 'E' && number[1] == '0') || number[1] == '2') &&
        ((number[2] >= '2' && number[2] <= '6') || (number[2] == '1' && number[3] >= '4') ||
         (number[0] == 'W' && number[2] == '9'));
    bool elsewhere = false;
    for (const char *other : provokedElsewhere)
      elsewhere |= std::strcmp(number, other) == 0;
    if (isSemas && !elsewhere) {
      EXPECT_NE(expectations.find(std::string("^ ") + number + " "), std::string::npos)
          << number << " has no test in tests/language/*/errors.rtsl";
    }
  }
}

} // namespace
