#include "support/Fibers.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using rtsl::Fibers;

TEST(Fibers, TakeTurnsAtPauses) {
  std::string turns;
  Fibers::run(3, 0, [&](unsigned number) {
    for (unsigned i = 0; i <= 2 * number; ++i) {
      turns += char('a' + number);
      Fibers::pauseThread();
    }
  });
  EXPECT_EQ(turns, "abcbcbccc");
  EXPECT_EQ(Fibers::ofThread(), nullptr);
}

TEST(Fibers, OneHasNoOther) {
  unsigned runs = 0;
  Fibers::run(1, 0, [&](unsigned number) {
    EXPECT_EQ(number, 0u);
    EXPECT_EQ(Fibers::ofThread(), nullptr);
    ++runs;
  });
  EXPECT_EQ(runs, 1u);
}

TEST(Fibers, WithinOneThereIsOne) {
  std::string turns;
  Fibers::run(2, 0, [&](unsigned number) {
    Fibers::run(2, 0, [&](unsigned inner) {
      turns += std::to_string(inner) + char('a' + number);
      Fibers::pauseThread();
      turns += char('a' + number);
    });
  });
  EXPECT_EQ(turns, "0a0bab");
  EXPECT_EQ(Fibers::ofThread(), nullptr);
}

struct Numbers {
  std::uint64_t sum = 0;
  double total = 0;
};

/// Pauses where integers and vectors of doubles are in use.
Numbers compute(unsigned number) {
  std::vector<double> doubles(16, number);
  std::uint64_t sum = number, other = 3 * number, third = 7 * number;
  for (unsigned i = 0; i < 1000; ++i) {
    sum = sum * 31 + i;
    other += sum >> 7;
    third ^= other;
    for (double &a : doubles)
      a += 0.5 * a + number;
    Fibers::pauseThread();
    for (double &a : doubles)
      a *= 0.5;
  }
  return {sum ^ other ^ third, std::accumulate(doubles.begin(), doubles.end(), 0.0)};
}

/// Registers, also those of vectors, and frames on the stack survive pauses.
TEST(Fibers, KeepTheirNumbers) {
  std::vector<Numbers> inTurns(Fibers::most);
  Fibers::run(Fibers::most + 1, 1 << 20,
              [&](unsigned number) { inTurns.at(number) = compute(number); });
  for (unsigned number = 0; number < Fibers::most; ++number) {
    const Numbers alone = compute(number); // which does not pause outside fibers
    EXPECT_EQ(inTurns[number].sum, alone.sum) << number;
    EXPECT_EQ(inTurns[number].total, alone.total) << number;
  }
}

TEST(Fibers, ThrowTheFirstExceptionWhenAllHaveEnded) {
  constexpr unsigned thrower = 2;
  unsigned ended = 0;
  try {
    Fibers::run(4, 0, [&](unsigned number) {
      Fibers::pauseThread();
      if (number == thrower)
        throw std::runtime_error("number " + std::to_string(number));
      Fibers::pauseThread();
      ++ended;
    });
    FAIL() << "no exception";
  } catch (const std::runtime_error &error) {
    EXPECT_EQ(error.what(), "number " + std::to_string(thrower));
  }
  EXPECT_EQ(ended, 3u);
  EXPECT_EQ(Fibers::ofThread(), nullptr);
}

} // namespace
