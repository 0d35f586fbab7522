#include "runtime/device/ray/Search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace rtsl::device {
namespace {

TEST(Search, FindsTheFirstThatIsNotBeforeOrTheLast) {
  std::mt19937 random(7);
  for (std::uint32_t count = 1; count <= 70; ++count) {
    std::vector<std::uint32_t> values(count); // some of them equal
    for (std::uint32_t &value : values)
      value = std::uint32_t(random()) % count;
    std::sort(values.begin(), values.end());
    for (std::uint32_t wanted = 0; wanted <= count; ++wanted) {
      const auto first = std::lower_bound(values.begin(), values.end() - 1, wanted);
      const std::uint32_t found = indexInTable(count, [&](std::uint32_t i) {
        EXPECT_LT(i, count - 1); // the last one is not compared
        return values[i] < wanted;
      });
      EXPECT_EQ(found, std::uint32_t(first - values.begin())) << count << " " << wanted;
    }
  }
}

} // namespace
} // namespace rtsl::device
