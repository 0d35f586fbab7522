#include "runtime/render/MachineStack.h"

#include "runtime/device/ray/Abi.h"
#include "support/Fibers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace {

using rtsl::Fibers;

constexpr std::size_t size = 4096;

/// Each fiber of a thread finds its numbers again after pauses.
TEST(MachineStack, IsTheFibersOwn) {
  const void *const ofThread = rtsl_machine_stack(size);
  unsigned fibersThatRan = 0;
  Fibers::run(Fibers::most, 0, [&](unsigned number) {
    auto *const mine = static_cast<std::uint8_t *>(rtsl_machine_stack(size));
    EXPECT_EQ(mine == ofThread, number == 0);
    std::fill_n(mine, size, std::uint8_t(number + 1));
    Fibers::pauseThread();
    EXPECT_EQ(std::count(mine, mine + size, std::uint8_t(number + 1)), std::ptrdiff_t(size));
    EXPECT_EQ(rtsl_machine_stack(size), mine);
    ++fibersThatRan;
  });
  EXPECT_GE(fibersThatRan, 1u);
  EXPECT_EQ(rtsl_machine_stack(size), ofThread);
}

} // namespace
