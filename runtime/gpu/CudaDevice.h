//===- CudaDevice.h - a CUDA device through the driver alone --------------===//
#pragma once

#include "runtime/gpu/CudaDriver.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace rtsl::runtime {

/// One of the CUDA devices of the machine. Calls throw NoDevice (no driver, one that is too old, no
/// device, a device that rejects the code), OutOfMemory, or Internal (the code failed). Threads
/// other than the one that made it call use() first.
class CudaDevice {
public:
  /// The number of devices. Throws NoDevice if it is 0.
  static int count();

  /// `ordinal` is below count().
  explicit CudaDevice(int ordinal = 0);
  ~CudaDevice();
  CudaDevice(const CudaDevice &) = delete;
  CudaDevice &operator=(const CudaDevice &) = delete;

  /// Makes it the device of the calling thread.
  void use() const;

  const std::string &name() const { return deviceName; }
  /// 90 for sm_90.
  int capability() const { return computeCapability; }
  int multiprocessors() const { return multiprocessorCount; }
  /// The threads that a multiprocessor runs at once, at most.
  int mostThreads() const { return threadsOfMultiprocessor; }
  /// The shared memory of a multiprocessor, and how much of it a block may have.
  int sharedBytes() const { return sharedBytesOfMultiprocessor; }
  int mostSharedBytes() const { return mostSharedBytesOfBlock; }
  std::size_t freeMemory() const;

  using Address = cuda::Driver::Address;
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

  /// Code on the device.
  struct Module {
    void *handle = nullptr;
    std::string log; // what the driver's compiler says of it; empty if the driver had compiled it
                     // before, and kept it on disk
  };
  /// Compiles PTX for the device. A thread has at most `maxRegisters`, or as many as its kernel
  /// states if those are fewer; 0: as many as the code needs.
  Module compile(const std::string &ptx, unsigned maxRegisters = 0);
  void unload(const Module &code);

  struct Kernel {
    void *function = nullptr;
    int registers = 0;        // of a thread
    int localBytes = 0;       // of a thread: spills and arrays
    unsigned sharedBytes = 0; // of a block, beside those in its code
    // Bytes, in the code; nothing if the log does not say.
    std::optional<int> spillStores, spillLoads;
  };
  Kernel kernel(const char *name, const Module &code) const;
  /// Of a variable of the code.
  Address variable(const char *name, const Module &code) const;
  /// Sets Kernel::sharedBytes, up to mostSharedBytes().
  void giveSharedMemory(Kernel &kernel, unsigned bytes) const;
  /// How many blocks of the kernel run at once on a multiprocessor.
  int blocksAtOnce(const Kernel &kernel, unsigned threadsPerBlock) const;
  /// Runs a kernel and waits for it. `arguments` points to as many pointers to arguments as it has.
  /// Returns the seconds that the kernel took, by the device's clock.
  double launch(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                const void *const *arguments);
  /// Runs a kernel after those launched before, without waiting for it. An error is reported by a
  /// later call.
  void launchLater(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                   const void *const *arguments);
  /// Waits for all kernels.
  void wait();

private:
  void open(int ordinal);
  void close();
  void openMeanwhile();

  const std::unique_ptr<cuda::Driver> driver;
  int device = 0;
  void *context = nullptr;
  // For copies while a kernel runs: a stream that does not wait for the kernel, and page-locked
  // host memory.
  void *stream = nullptr, *pageLocked = nullptr;
  void *events[2] = {}; // before and after a kernel
  std::string deviceName;
  int computeCapability = 0, multiprocessorCount = 0, threadsOfMultiprocessor = 0;
  int sharedBytesOfMultiprocessor = 0, mostSharedBytesOfBlock = 0;
};

} // namespace rtsl::runtime
