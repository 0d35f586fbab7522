//===- ParallelTest.cpp ---------------------------------------------------===//
#include "support/Parallel.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <immintrin.h>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace rtsl {
namespace {

TEST(Parallel, CallsWorkOncePerNumber) {
  for (const unsigned threads : {0u, 1u, 2u, 1000u})
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      forEachInParallel(threads, count, [&](std::size_t i) { ++calls[i]; });
      for (const std::atomic<int> &ofOne : calls)
        EXPECT_EQ(ofOne, 1);
    }
}

TEST(Parallel, RangesHaveAllNumbersOnce) {
  for (const std::size_t count : {0u, 1u, 7u, 8u, 1000u}) {
    std::vector<std::atomic<int>> calls(count);
    forRangesInParallel(0, count, 8, [&](std::size_t first, std::size_t end) {
      EXPECT_TRUE(first < end && end <= first + 8);
      for (; first < end; ++first)
        ++calls[first];
    });
    for (const std::atomic<int> &ofOne : calls)
      EXPECT_EQ(ofOne, 1);
  }
}

TEST(Parallel, SeveralAtOnceAreAllNumbersOnce) {
  for (const unsigned threads : {0u, 1u})
    for (const std::size_t count : {0u, 1u, 7u, 8u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      forEachInParallel(threads, count, 8, [&](std::size_t i) { ++calls[i]; });
      for (const std::atomic<int> &ofOne : calls)
        EXPECT_EQ(ofOne, 1);
    }
}

TEST(Parallel, RethrowsAnException) {
  for (const unsigned threads : {0u, 1u, 2u}) {
    const auto fail = [&] {
      forEachInParallel(threads, 100, [](std::size_t i) {
        if (i == 50)
          throw std::runtime_error("fifty");
      });
    };
    EXPECT_THROW(fail(), std::runtime_error);
  }
}

// A thread that waits for its inner calls must not run an outer one, which would lock again.
TEST(Parallel, MayBeCalledWithALock) {
  std::mutex mutex;
  std::atomic<int> calls = 0;
  forEachInParallel(0, 16, [&](std::size_t) {
    const std::lock_guard<std::mutex> lock(mutex);
    forEachInParallel(0, 16, [&](std::size_t) { ++calls; });
  });
  EXPECT_EQ(calls, 256);
}

// Embree starts TBB's threads while denormal numbers are flushed to zero.
TEST(Parallel, ComputesWithTheSettingsOfTheCaller) {
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | _MM_FLUSH_ZERO_ON);
  tbb::parallel_for(0, 100, [](int) {});
  _mm_setcsr(before);
  std::atomic<int> flushed = 0;
  forEachInParallel(0, 1000,
                    [&](std::size_t) { flushed += (_mm_getcsr() & _MM_FLUSH_ZERO_ON) != 0; });
  EXPECT_EQ(flushed, 0);
}

} // namespace
} // namespace rtsl
