//===- GpuRenderer.h - a scene on a CUDA device ---------------------------===//
#pragma once

#include "runtime/gpu/CudaDevice.h"
#include "runtime/gpu/GpuBlocks.h"
#include "runtime/gpu/GpuThreads.h"
#include "runtime/gpu/GpuWaves.h"
#include "runtime/render/Megakernel.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// The program of a scene, as in a package.
struct GpuCode {
  const std::string &ptx;
  std::uint64_t laneBytes;   // the result of the program's rtsl_lane_bytes for the options' depth
  unsigned maxRegisters = 0; // per thread; 0: as many as the code needs
  WaveFacts wave = {};
};

/// What ran on the GPU, to explain its speed.
struct GpuStatistics {
  std::string device;
  int registers = 0, localBytes = 0; // per thread; of a wavefront, of the kernel with most of them
  // Bytes, in the code; not known of code that the driver had compiled before.
  std::optional<int> spillStores, spillLoads;
  unsigned blocks = 0, threadsPerBlock = 0;
  std::uint64_t laneBytes = 0;
  double occupancy = 0;     // the share of the threads of a multiprocessor that run at once
  double loadSeconds = 0;   // the driver's compiler, on PTX that it has not seen
  double uploadSeconds = 0; // the scene
  std::optional<std::uint64_t> samples; // rendered in the last run, if there are several devices
};

class GpuRenderer final : public Megakernel {
public:
  /// Loads the program and copies the scene, which is not relocated, to the device, which must
  /// outlive the renderer and its trees. `kept`: trees of another scene's renderer on this device,
  /// or null. Throws NoDevice, OutOfMemory, OutOfRange.
  GpuRenderer(CudaDevice &device, const GpuCode &code, FlatScene scene,
              const RenderOptions &options, std::shared_ptr<DeviceTrees> kept = nullptr);
  ~GpuRenderer() override;

  const GpuStatistics &gpu() const { return figures; }

  void enterThread() override { device.use(); }
  PassSizes passSizes() const override;

private:
  std::uint64_t laneBytes(const RtslLaunch &) override { return figures.laneBytes; }
  std::uint64_t raysBytes(RtslJob &job) override;
  Address allocate(std::uint64_t bytes, const char *what) override;
  void upload(Address to, const void *from, std::uint64_t bytes) override;
  void download(void *to, Address from, std::uint64_t bytes) override;
  std::unique_ptr<BuildDevice> buildDevice() override;
  Address clearedPixels() override;
  void fetchPixels() override;
  std::uint64_t samplesInFlight() const override {
    return std::uint64_t(figures.blocks) * figures.threadsPerBlock;
  }
  std::uint64_t sliceBytes() override;
  double launchSeconds() const override;
  RtslPixelSums placeSums(PixelSums &sums) override;
  void clearSums(const PixelSums &sums, std::size_t first, std::size_t count) override;
  void uploadSums(const PixelSums &sums, std::size_t first, std::size_t count) override;
  void fetchSums(PixelSums &sums, std::size_t first, std::size_t count) override;
  RtslPixelSums clearedSums(std::uint64_t pixels) override;
  double runLanes(const RtslJob &job) override;
  double addSamples(const RtslJob &job) override;
  std::uint64_t get(Address number) override;
  void set(Address number, std::uint32_t value) override;

  void loadKernels(const GpuCode &code);
  void release();
  std::uint64_t pixelBytes() const { return pixelFloats() * sizeof(float); }

  CudaDevice &device;
  CudaDevice::Module program;
  CudaDevice::Kernel kernel, sumKernel;
  std::optional<GpuWaves> waves;     // in place of `kernel`
  std::optional<GpuBlocks> blocks;   // of `kernel`, if it runs persistent blocks
  std::optional<GpuThreads> threads; // of `kernel`, if it has a thread for each sample
  GpuStatistics figures;
  std::vector<Address> memory;
  Address pixelAddress = 0;
  RtslPixelSums sumsOnDevice{}, ownSums{}; // all null until there are such sums
};

} // namespace rtsl::runtime
