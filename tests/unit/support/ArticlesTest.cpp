#include "support/Articles.h"

#include <gtest/gtest.h>

using namespace rtsl;

TEST(Articles, AreThoseOfTheNamesAfterThem) {
  EXPECT_EQ(withArticles("`e` is a `Emitter`, where a `rt_Light` is needed"),
            "`e` is an `Emitter`, where an `rt_Light` is needed");
  EXPECT_EQ(withArticles("a `int[]`, not (a `uint`) or a `uvec2`"),
            "an `int[]`, not (a `uint`) or a `uvec2`");
  EXPECT_EQ(withArticles("an `A`, a `B` and alpha `A`"), "an `A`, a `B` and alpha `A`");
  EXPECT_EQ(withArticles("a `"), "a `");
}
