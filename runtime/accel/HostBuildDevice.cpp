#include "runtime/accel/HostBuildDevice.h"

#include "runtime/device/trees/Clusters.h"
#include "runtime/device/trees/Sort.h"
#include "runtime/device/trees/Widen.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace rtsl::runtime {

struct HostBuildDevice::Threads {
  tbb::task_arena arena;

  /// Calls work(0) ... work(count - 1), at least `together` of them on one thread.
  template <typename Work>
  void forEach(std::uint32_t count, std::uint32_t together, Work work) {
    using Range = tbb::blocked_range<std::uint32_t>;
    const auto some = [&](const Range &range) {
      for (std::uint32_t i = range.begin(); i != range.end(); ++i)
        work(i);
    };
    if (count <= together)
      return some(Range(0, count));
    arena.execute([&] { tbb::parallel_for(Range(0, count, together), some); });
  }
};

/// No more than there are cores: TBB prints a warning otherwise.
static int concurrency(unsigned threads) {
  const int most = tbb::this_task_arena::max_concurrency();
  return threads ? std::min(int(threads), most) : most;
}

HostBuildDevice::HostBuildDevice(unsigned threads)
    : threads(new Threads{tbb::task_arena(concurrency(threads))}) {}

HostBuildDevice::~HostBuildDevice() = default;

BuildDevice::Address HostBuildDevice::allocate(std::size_t bytes, const char *what) {
  void *const memory = std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (!memory)
    throw Error(message::noMemoryFor(what, bytes));
  return reinterpret_cast<Address>(memory);
}

void HostBuildDevice::release(Address address) {
  std::free(reinterpret_cast<void *>(address));
}

void HostBuildDevice::upload(Address to, const void *from, std::size_t bytes) {
  std::memcpy(reinterpret_cast<void *>(to), from, bytes);
}

void HostBuildDevice::download(void *to, Address from, std::size_t bytes) {
  std::memcpy(to, reinterpret_cast<const void *>(from), bytes);
}

void HostBuildDevice::copy(Address to, Address from, std::size_t bytes) {
  std::memcpy(reinterpret_cast<void *>(to), reinterpret_cast<const void *>(from), bytes);
}

void HostBuildDevice::run(BuildStep step, Address address, std::uint32_t count, std::uint32_t a,
                          std::uint32_t b, std::uint32_t c) {
  using namespace device::build;
  const TreeBuild &build = *reinterpret_cast<const TreeBuild *>(address);
  const bool isOfTiles = step == BuildStep::CountDigits || step == BuildStep::MoveByDigit ||
                         step == BuildStep::SumTile || step == BuildStep::SumElementsBefore;
  const std::uint32_t together = isOfTiles ? 2 : 512;
  switch (step) {
#define RTSL_BUILD_STEP(name, call)                                                                \
  case BuildStep::name:                                                                            \
    return threads->forEach(count, together, [&](std::uint32_t i) { call; });
#include "runtime/device/trees/Steps.def"
  }
}

} // namespace rtsl::runtime
