//===- MachineMemoryTest.cpp ----------------------------------------------===//
#include "tests/unit/support/Files.h"

#include "support/MachineMemory.h"

#include <cstdio>
#include <limits>
#include <new>

namespace rtsl {

namespace {

/// A folder in which a test writes what the system says in /proc and /sys.
class System : public test::Files {
protected:
  void say(const std::string &file, const std::string &text) const {
    test::fs::create_directories((folder / file).parent_path());
    put(file, text);
  }
  void group(const std::string &name, const std::string &limit, std::uint64_t usage,
             std::uint64_t cached) const {
    const std::string at = "sys/fs/cgroup/" + name + "/memory.";
    say(at + "max", limit + "\n");
    say(at + "current", std::to_string(usage) + "\n");
    say(at + "stat", "anon 7\ninactive_file " + std::to_string(cached) + "\nactive_file 5\n");
  }
};

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

TEST_F(System, SaysNothing) {
  EXPECT_EQ(availableMemory(folder), unlimited);
  say("proc/self/cgroup", "rubbish\n0:\n:memory:\n");
  say("proc/meminfo", "MemAvailable: lots\n");
  EXPECT_EQ(availableMemory(folder), unlimited);
}

TEST_F(System, HasMemory) {
  say("proc/meminfo", "MemTotal:  4000 kB\nMemFree:  1000 kB\nMemAvailable:  3000 kB\n");
  EXPECT_EQ(availableMemory(folder), 3000u * 1024);
}

TEST_F(System, LimitsGroups) {
  say("proc/meminfo", "MemAvailable:  3000 kB\n");
  say("proc/self/cgroup", "1:name=systemd:/\n0::/outer/inner\n");
  group("outer/inner", "max", 1000, 0);
  EXPECT_EQ(availableMemory(folder), 3000u * 1024);
  group("outer", "500000", 400000, 100000); // with 100005 bytes of files
  EXPECT_EQ(availableMemory(folder), 200005u);
  group("outer/inner", "1000", 4000, 0); // above its limit, which was lowered
  EXPECT_EQ(availableMemory(folder), 0u);
}

TEST_F(System, LimitsGroupsOfTheFirstVersion) {
  say("proc/self/cgroup", "5:cpu,memory:/elsewhere\n4:cpuset:/\n");
  const std::string at = "sys/fs/cgroup/memory/memory."; // where a container's mount begins
  say(at + "limit_in_bytes", "9000\n");
  say(at + "usage_in_bytes", "6000\n");
  say(at + "stat", "inactive_file 1\ntotal_inactive_file 2000\ntotal_active_file 1000\n");
  EXPECT_EQ(availableMemory(folder), 6000u);
}

TEST(MemoryReservations, AreAddedUp) {
  const std::uint64_t before = MemoryReservation::all();
  // Each would fit, but not all of them. Nothing is allocated.
  const std::uint64_t most = availableMemory();
  if (most == unlimited) {
    // In a line that `make check` shows.
    std::puts("skipped: MemoryReservations.AreAddedUp: the system does not say how much memory "
              "there is");
    GTEST_SKIP();
  }
  {
    MemoryReservation first(most / 2), second(most / 4);
    EXPECT_THROW(MemoryReservation(most / 2 + (std::uint64_t(1) << 33)), std::bad_alloc);
    MemoryReservation third = std::move(first);
    EXPECT_EQ(MemoryReservation::all(), before + most / 2 + most / 4);
  }
  EXPECT_EQ(MemoryReservation::all(), before);
}

} // namespace

} // namespace rtsl
