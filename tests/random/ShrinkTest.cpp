//===- ShrinkTest.cpp - shrinking of failing programs --------------------===//
#include "Shrink.h"

#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::random;

namespace {

bool isValid(const Program &program) {
  SourceManager sources;
  Diagnostics diagnostics(sources);
  const std::string text = program.text();
  auto unit = parse(sources.add("random.rtsl", prelude(text) + text), diagnostics);
  check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
  return !diagnostics.hasErrors();
}

TEST(Random, ProgramsAreValidAndTheSameEveryTime) {
  for (std::uint32_t seed = 0; seed != 200; ++seed) {
    const Program program = generate(seed);
    EXPECT_TRUE(isValid(program)) << "seed " << seed;
    EXPECT_EQ(program.text(), generate(seed).text()) << "seed " << seed;
  }
}

// An oracle that is broken on purpose: it calls every program wrong that holds `construct`. What is
// left is little more than that.
TEST(Random, ShrinkingLeavesWhatFails) {
  unsigned shrunk = 0;
  for (std::uint32_t seed = 0; seed != 60 && shrunk != 5; ++seed) {
    if (hasImages(seed)) // most of the text is the library's
      continue;
    for (const char *construct : {" % ", "trace(", "switch"}) {
      auto fails = [&](const Program &program) {
        return program.text().find(construct) != std::string::npos && isValid(program);
      };
      Program program = generate(seed);
      if (!fails(program))
        continue;
      const std::size_t before = sizeOf(*program.tree);
      shrink(program, fails);
      EXPECT_TRUE(fails(program)) << "seed " << seed;
      EXPECT_LT(sizeOf(*program.tree), 40u) << "seed " << seed << ", of " << before << "\n"
                                            << program.text();
      ++shrunk;
    }
  }
  EXPECT_GE(shrunk, 5u);
}

} // namespace
