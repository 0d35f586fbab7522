//===- WarningsTest.cpp - which warnings are shown: -W --------------------===//
#include "frontend/diagnostics/Diagnostics.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <set>

namespace rtsl {
namespace {

/// What becomes of a warning: "off", "on" or "error".
std::string stateOf(Code code, std::initializer_list<const char *> options) {
  WarningOptions warnings;
  for (const char *option : options)
    EXPECT_EQ(warnings.apply(option), "") << option;
  return !warnings.isOn(code) ? "off" : warnings.isError(code) ? "error" : "on";
}

constexpr Code usual = Code::unusedVariable; // unused-variable
constexpr Code perf = Code::tailTrace;       // tail-trace

TEST(WarningTable, NamesAreUniqueAndWellFormed) {
  std::set<std::string> names = {"all", "perf", "error", "help"};
  for (const CodeInfo &row : codeTable) {
    EXPECT_EQ(row.warning != nullptr, row.severity == Severity::Warning)
        << row.number << " needs a name: RTSL_WARNING";
    if (!row.warning)
      continue;
    const std::string name = row.warning;
    const bool isShared = name == "scene"; // by all warnings of scenes
    EXPECT_TRUE(names.insert(name).second || isShared) << name << " is used twice";
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string::npos) << name;
    EXPECT_NE(name.substr(0, 3), "no-") << name;
  }
}

TEST(WarningOptions, ConcernAllWarningsOfAName) {
  EXPECT_EQ(stateOf(Code::sceneWarning, {"no-scene"}), "off");
  EXPECT_EQ(stateOf(Code::endlessRays, {"no-scene"}), "off");
}

TEST(WarningOptions, StandByGroupUntilTheyAreNamed) {
  EXPECT_EQ(stateOf(usual, {}), "on");
  EXPECT_EQ(stateOf(perf, {}), "off");
  EXPECT_EQ(stateOf(usual, {"no-unused-variable"}), "off");
  EXPECT_EQ(stateOf(perf, {"tail-trace"}), "on");
  EXPECT_EQ(stateOf(perf, {"perf"}), "on");
  EXPECT_EQ(stateOf(usual, {"no-perf"}), "on");
  EXPECT_EQ(stateOf(perf, {"all"}), "on");
  EXPECT_EQ(stateOf(usual, {"no-all"}), "off");
}

TEST(WarningOptions, WhatComesLaterCounts) {
  EXPECT_EQ(stateOf(perf, {"perf", "no-tail-trace"}), "off");
  EXPECT_EQ(stateOf(perf, {"no-tail-trace", "perf"}), "on");
  EXPECT_EQ(stateOf(usual, {"no-all", "unused-variable"}), "on");
  EXPECT_EQ(stateOf(Code::noEffect, {"no-all", "unused-variable"}), "off");
}

TEST(WarningOptions, BecomeErrors) {
  EXPECT_EQ(stateOf(usual, {"error"}), "error");
  EXPECT_EQ(stateOf(perf, {"error"}), "off") << "what is off stays off";
  EXPECT_EQ(stateOf(perf, {"error=tail-trace"}), "error") << "this turns it on";
  EXPECT_EQ(stateOf(usual, {"error=tail-trace"}), "on");
  EXPECT_EQ(stateOf(usual, {"error", "no-error=unused-variable"}), "on");
  EXPECT_EQ(stateOf(usual, {"no-error=unused-variable", "error"}), "on") << "in either order";
  EXPECT_EQ(stateOf(usual, {"error", "no-error"}), "on");
  EXPECT_EQ(stateOf(perf, {"no-error=tail-trace"}), "off") << "this does not turn it on";
  EXPECT_EQ(stateOf(perf, {"error=perf", "no-tail-trace"}), "off");
}

TEST(WarningOptions, UnknownNamesAreRefused) {
  WarningOptions warnings;
  EXPECT_EQ(warnings.apply("unused-varable"),
            "there is no warning `unused-varable`; did you mean `unused-variable`?");
  EXPECT_EQ(warnings.apply("no-pref"), "there is no warning `pref`; did you mean `perf`?");
  EXPECT_EQ(warnings.apply("error=xyzzy-plugh"),
            "there is no warning `xyzzy-plugh`; `-Whelp` lists them");
  EXPECT_EQ(warnings.apply(""), "there is no warning ``; `-Whelp` lists them");
}

class Shown : public testing::Test {
protected:
  Diagnostic &report() { return diagnostics.report(usual, {file, 0, 1}, "x"); }

  SourceManager sources;
  FileId file = sources.add("a.rtsl", "x\n");
  Diagnostics diagnostics{sources};
};

TEST_F(Shown, WithTheirName) {
  report();
  EXPECT_EQ(renderText(diagnostics, false),
            "a.rtsl:1:1: warning[W2200]: `x` is never used [-Wunused-variable]\n"
            "  |\n1 | x\n  | ^\n\n");
  EXPECT_NE(renderJson(diagnostics).find("\"warning\": \"unused-variable\""), std::string::npos);
  EXPECT_FALSE(diagnostics.hasErrors());
}

TEST_F(Shown, AsErrors) {
  diagnostics.warnings.apply("error=unused-variable");
  report();
  EXPECT_EQ(renderText(diagnostics, false).substr(0, 73),
            "a.rtsl:1:1: error[W2200]: `x` is never used [-Werror=unused-variable]\n  |");
  EXPECT_NE(renderJson(diagnostics).find("\"severity\": \"error\""), std::string::npos);
  EXPECT_EQ(diagnostics.errorCount(), 1u);
}

TEST_F(Shown, NotWhenTheyAreOff) {
  diagnostics.warnings.apply("no-unused-variable");
  diagnostics.warnings.apply("error");
  report().note("nobody reads this");
  EXPECT_TRUE(diagnostics.all().empty());
  EXPECT_FALSE(diagnostics.hasErrors());
}

TEST_F(Shown, WhenStepsAreJoined) {
  Diagnostics found(sources);
  found.warnings.apply("perf");
  found.report(perf, {file, 0, 1}, "shade");
  diagnostics.warnings = found.warnings;
  diagnostics.warnings.apply("error");
  diagnostics.addSorted(std::move(found));
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].severity, Severity::Error);
}

} // namespace
} // namespace rtsl
