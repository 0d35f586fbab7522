#include "runtime/accel/trees/HostBuildDevice.h"

#include "runtime/device/trees/Clusters.h"
#include "runtime/device/trees/Refit.h"
#include "runtime/device/trees/Sort.h"
#include "runtime/device/trees/Widen.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace rtsl::runtime {

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
  if (bytes != 0) // else there may be no `from`, which memcpy does not allow
    std::memcpy(reinterpret_cast<void *>(to), from, bytes);
}

void HostBuildDevice::download(void *to, Address from, std::size_t bytes) {
  if (bytes != 0)
    std::memcpy(to, reinterpret_cast<const void *>(from), bytes);
}

void HostBuildDevice::copy(Address to, Address from, std::size_t bytes) {
  std::memcpy(reinterpret_cast<void *>(to), reinterpret_cast<const void *>(from), bytes);
}

void HostBuildDevice::run(BuildStep step, Address address, std::uint32_t count, std::uint32_t a,
                          std::uint32_t b, std::uint32_t c) {
  using namespace device::build;
  const TreeBuild &build = *reinterpret_cast<const TreeBuild *>(address);
  // `together`: at least so many on one thread.
  const auto forEach = [&](std::uint32_t together, auto work) {
    forEachInParallel(threads, (count + together - 1) / together, [&](std::uint32_t part) {
      const std::uint32_t end = std::min(count, (part + 1) * together);
      for (std::uint32_t i = part * together; i < end; ++i)
        work(i);
    });
  };
  switch (step) {
#define RTSL_BUILD_STEP(name, call)                                                                \
  case BuildStep::name:                                                                            \
    return forEach(512, [&](std::uint32_t i) { call; });
#define RTSL_BUILD_STEP_OF_WARPS(name, call)                                                       \
  case BuildStep::name:                                                                            \
    return forEach(1, [&](std::uint32_t i) { call; });
#include "runtime/device/trees/Steps.def"
  }
}

} // namespace rtsl::runtime
