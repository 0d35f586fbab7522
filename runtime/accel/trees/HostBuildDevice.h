//===- HostBuildDevice.h - builds trees on the CPU ------------------------===//
#pragma once

#include "runtime/accel/trees/ClusterTree.h"

namespace rtsl::runtime {

class HostBuildDevice final : public BuildDevice {
public:
  /// `threads` 0: one per core; the tree does not depend on their number.
  explicit HostBuildDevice(unsigned threads) : threads(threads) {}

  Address allocate(std::size_t bytes, const char *what) override;
  void release(Address address) override;
  void upload(Address to, const void *from, std::size_t bytes) override;
  void download(void *to, Address from, std::size_t bytes) override;
  void copy(Address to, Address from, std::size_t bytes) override;
  std::uint32_t lanes() const override { return 1; }
  void run(BuildStep step, Address build, std::uint32_t count, std::uint32_t a, std::uint32_t b,
           std::uint32_t c) override;
  void wait() override {}

private:
  unsigned threads;
};

} // namespace rtsl::runtime
