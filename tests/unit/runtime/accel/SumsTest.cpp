// Sums of all elements before each, on many threads at once.
#include "runtime/accel/trees/BuildMemory.h"
#include "runtime/accel/trees/HostBuildDevice.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace rtsl::runtime;
using rtsl::device::build::TreeBuild;

namespace {

constexpr std::size_t most = 300000;

/// Two numbers, as steps sum them.
std::uint64_t pair(std::mt19937 &random) {
  return std::uint64_t(random() % 5000) << 32 | random() % 5000;
}

} // namespace

/// One call after the other, with more elements and with fewer: nothing is left of those before.
TEST(Sums, AreThoseOfAllElementsBefore) {
  std::mt19937 random(1);
  for (const unsigned threads : {1, 4, 16}) {
    HostBuildDevice device(threads);
    BuildMemory memory(device, TreeBuild{}, [&](TreeBuild &build, Block &block) {
      block.place(build.numbers, most);
      placeSums(build, block, most, device.lanes());
    });
    memory.beginSums(most);
    for (const std::uint32_t count :
         {1u, 511u, 512u, 513u, 300000u, 2u, 100000u, 300000u, 299999u, 1u, 5000u}) {
      std::vector<std::uint64_t> numbers(count), sums(count);
      for (std::uint64_t &number : numbers)
        number = pair(random);
      device.upload(addressOf(memory.build.numbers), numbers.data(), count * sizeof numbers[0]);
      memory.sum(BuildStep::SumNumbers, count, count);
      device.download(sums.data(), addressOf(memory.build.numbers), count * sizeof sums[0]);
      std::uint64_t sum = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(sums[i], sum) << i << " of " << count;
        sum += numbers[i];
      }
      EXPECT_EQ(memory.sumOfAll(), sum);
    }
  }
}
