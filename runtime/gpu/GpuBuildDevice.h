//===- GpuBuildDevice.h - builds trees on a CUDA device -------------------===//
#pragma once

#include "runtime/accel/trees/ClusterTree.h"
#include "runtime/gpu/CudaDevice.h"

#include <optional>
#include <vector>

namespace rtsl::runtime {

/// Its kernels are part of the program (runtime/device/trees/BuildKernels.cpp); the driver compiles
/// them for the device before the first of them runs.
class GpuBuildDevice final : public BuildDevice {
public:
  explicit GpuBuildDevice(CudaDevice &device) : device(device) {}
  ~GpuBuildDevice() override;

  Address allocate(std::size_t bytes, const char *what) override;
  void release(Address address) override;
  void upload(Address to, const void *from, std::size_t bytes) override;
  void download(void *to, Address from, std::size_t bytes) override;
  void copy(Address to, Address from, std::size_t bytes) override;
  std::uint32_t lanes() const override { return 32; }
  void run(BuildStep step, Address build, std::uint32_t count, std::uint32_t a, std::uint32_t b,
           std::uint32_t c) override;
  void wait() override;

private:
  void load();

  CudaDevice &device;
  std::optional<CudaDevice::Module> code;
  std::vector<CudaDevice::Kernel> kernels; // by step
};

} // namespace rtsl::runtime
