//===- HostMegakernel.h - the GPU's whole program on the CPU --------------===//
//
// One lane per thread, on a flat scene: the code is that of a GPU. It is the reference for GPUs,
// with the same bits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/render/HostThreads.h"
#include "runtime/render/Megakernel.h"
#include "support/MachineMemory.h"

#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

namespace rtsl::runtime {

class HostMegakernel : public Megakernel {
public:
  /// `scene` is not relocated; the code at `code` must stay loaded. `kept`: of another scene's
  /// HostMegakernel, or null. Throws OutOfRange, OutOfMemory.
  HostMegakernel(const MegakernelCode &code, FlatScene scene, const RenderOptions &options,
                 std::shared_ptr<DeviceTrees> kept = nullptr);

private:
  std::uint64_t laneBytes(const RtslLaunch &launch) override;
  std::uint64_t raysBytes(RtslJob &job) override { return threads.count() * job.laneBytes; }
  Address allocate(std::uint64_t bytes, const char *what) override;
  void upload(Address to, const void *from, std::uint64_t bytes) override;
  void download(void *to, Address from, std::uint64_t bytes) override;
  std::unique_ptr<BuildDevice> buildDevice() override;
  Address clearedPixels() override;
  void fetchPixels() override {} // they are there
  std::uint64_t samplesInFlight() const override { return threads.count(); }
  std::uint64_t sliceBytes() override { return std::uint64_t(64) << 20; }
  double launchSeconds() const override { return std::numeric_limits<double>::infinity(); }
  // The sums are used where they are.
  RtslPixelSums placeSums(PixelSums &sums) override { return sums.pointers(); }
  void clearSums(const PixelSums &, std::size_t, std::size_t) override {} // they are
  void uploadSums(const PixelSums &, std::size_t, std::size_t) override {}
  void fetchSums(PixelSums &, std::size_t, std::size_t) override {}
  RtslPixelSums clearedSums(std::uint64_t pixels) override;
  double runLanes(const RtslJob &job) override;
  double addSamples(const RtslJob &job) override;
  std::uint64_t get(Address number) override;
  void set(Address number, std::uint32_t value) override;

  struct Free {
    void operator()(void *memory) const { std::free(memory); }
  };
  struct Allocation {
    MemoryReservation reservation;
    std::unique_ptr<std::uint8_t, Free> bytes;
  };

  const MegakernelCode code;
  const HostThreads threads;
  std::vector<Allocation> memory;
  PixelSums ownSums; // of clearedSums
};

} // namespace rtsl::runtime
