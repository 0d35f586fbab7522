//===- CudaDriver.h - a CUDA device through the driver alone --------------===//
//
// What we need of the CUDA driver API, declared here and looked up in libcuda.so.1 at run time:
// nothing of CUDA is needed to build, and a program without a driver reports that and exits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Error.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace rtsl::runtime {

/// The first CUDA device of the machine. Calls throw NoDevice (no driver, one that is too old, no
/// device, a device that rejects the code), OutOfMemory, or Internal (the code failed).
class CudaDevice {
public:
  CudaDevice();
  ~CudaDevice();
  CudaDevice(const CudaDevice &) = delete;
  CudaDevice &operator=(const CudaDevice &) = delete;

  const std::string &name() const { return deviceName; }
  /// 90 for sm_90.
  int capability() const { return computeCapability; }
  int multiprocessors() const { return multiprocessorCount; }
  std::size_t freeMemory() const;

  using Address = std::uint64_t;
  /// `what` is for messages. All memory is freed with the device.
  Address allocate(std::size_t bytes, const char *what);
  void release(Address address);
  void clear(Address address, std::size_t bytes);
  void upload(Address to, const void *from, std::size_t bytes);
  void download(void *to, Address from, std::size_t bytes);
  /// Within the device, after what was launched.
  void copy(Address to, Address from, std::size_t bytes);
  /// Copies of up to mostBytesMeanwhile bytes while a kernel runs, without waiting for the kernel.
  /// Called from another thread than launch().
  void uploadMeanwhile(Address to, const void *from, std::size_t bytes);
  void downloadMeanwhile(void *to, Address from, std::size_t bytes);
  static constexpr std::size_t mostBytesMeanwhile = 64;

  /// Compiles PTX for the device; one module at a time. `maxRegisters` 0: as many as the code
  /// needs.
  void load(const std::string &ptx, unsigned maxRegisters = 0);

  struct Kernel {
    void *function = nullptr;
    int registers = 0;  // of a thread
    int localBytes = 0; // of a thread: spills and arrays
  };
  Kernel kernel(const char *name) const { return kernel(name, module); }
  /// Code beside that of load(), until it is unloaded.
  using Module = void *;
  Module compile(const char *ptx, unsigned maxRegisters = 0);
  void unload(Module code);
  Kernel kernel(const char *name, Module code) const;
  /// How many blocks of the kernel run at once on a multiprocessor.
  int blocksAtOnce(const Kernel &kernel, unsigned threadsPerBlock) const;
  /// Runs a kernel and waits for it. `arguments` points to as many pointers to arguments as it has.
  /// Returns the seconds that the kernel took, by the device's clock.
  double launch(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock, void **arguments);
  /// Runs a kernel after those launched before, without waiting for it. An error is reported by a
  /// later call.
  void launchLater(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                   void **arguments);
  /// Waits for all kernels.
  void wait();

private:
  struct Functions;
  template <typename Function>
  void find(Function &function, const char *name);
  void check(int status, const char *call) const;
  void open();
  void close();
  void openMeanwhile();

  void *library = nullptr;
  Functions *functions = nullptr;
  int device = 0;
  void *context = nullptr;
  Module module = nullptr;
  // For copies while a kernel runs: a stream that does not wait for the kernel, and page-locked
  // host memory.
  void *stream = nullptr, *pageLocked = nullptr;
  void *events[2] = {}; // before and after a kernel
  std::string deviceName;
  int computeCapability = 0, multiprocessorCount = 0;
};

} // namespace rtsl::runtime
