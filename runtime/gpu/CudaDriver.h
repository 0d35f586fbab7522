//===- CudaDriver.h - the functions of the CUDA driver --------------------===//
//
// What we need of the CUDA driver API, declared here and looked up in libcuda.so.1 at run time:
// nothing of CUDA is needed to build, and a program without a driver reports that and exits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstddef>
#include <cstdint>

namespace rtsl::runtime::cuda {

// Values of the driver API's enumerations (CUDA Driver API reference, chapter "Data types").
enum Status {
  Success = 0,
  OutOfMemory = 2,
  NoDevice = 100,
  InvalidPtx = 218,
  NoBinaryForGpu = 209,
  UnsupportedPtxVersion = 222,
};
enum DeviceAttribute {
  ThreadsOfMultiprocessor = 39,
  MultiprocessorCount = 16,
  ComputeCapabilityMajor = 75,
  ComputeCapabilityMinor = 76,
  SharedBytesOfMultiprocessor = 81,
  MostSharedBytesOfBlock = 97,
};
enum FunctionAttribute { LocalSizeBytes = 3, RegisterCount = 4, MostDynamicSharedBytes = 8 };
enum StreamFlag : unsigned { NonBlocking = 1 };
enum JitOption {
  MaxRegisters = 0,
  InfoLogBuffer = 3,
  InfoLogBufferBytes = 4,
  ErrorLogBuffer = 5,
  ErrorLogBufferBytes = 6,
  LogVerbose = 12,
  OverrideDirectives = 33, // by MaxRegisters
  ThreadsOfCompiler = 34,  // "split compile"; from CUDA 13.0 on
};

/// The driver, while the object exists. Constructing it throws NoDevice without a driver, with one
/// that is too old, and without a device.
class Driver {
public:
  using Address = std::uint64_t;

  Driver();
  ~Driver();
  Driver(const Driver &) = delete;
  Driver &operator=(const Driver &) = delete;

  int devices() const { return deviceCount; }
  /// Does its compiler use several threads if it is told to?
  bool compilesInThreads() const;
  /// Throws OutOfMemory or Internal, unless the status is Success.
  void check(int status, const char *call) const;

  // Every function returns a status.
  int (*init)(unsigned flags);
  int (*driverGetVersion)(int *);
  int (*getErrorString)(int status, const char **);
  int (*deviceGetCount)(int *);
  int (*deviceGet)(int *device, int ordinal);
  int (*deviceGetName)(char *, int size, int device);
  int (*deviceGetAttribute)(int *, int attribute, int device);
  int (*primaryContextRetain)(void **context, int device);
  int (*primaryContextRelease)(int device);
  int (*contextSetCurrent)(void *context);
  int (*memoryGetInfo)(std::size_t *free, std::size_t *total);
  int (*memoryAllocate)(Address *, std::size_t bytes);
  int (*memoryFree)(Address);
  int (*memorySet)(Address, unsigned char value, std::size_t bytes);
  int (*hostAllocate)(void **, std::size_t bytes);
  int (*hostFree)(void *);
  int (*copyToDevice)(Address to, const void *from, std::size_t bytes);
  int (*copyToHost)(void *to, Address from, std::size_t bytes);
  int (*copyWithin)(Address to, Address from, std::size_t bytes);
  int (*copyToDeviceAsync)(Address to, const void *from, std::size_t bytes, void *stream);
  int (*copyToHostAsync)(void *to, Address from, std::size_t bytes, void *stream);
  int (*streamCreate)(void **stream, unsigned flags);
  int (*streamDestroy)(void *stream);
  int (*streamSynchronize)(void *stream);
  int (*moduleLoad)(void **module, const void *image, unsigned count, int *options, void **values);
  int (*moduleUnload)(void *module);
  int (*moduleGetFunction)(void **function, void *module, const char *name);
  int (*moduleGetGlobal)(Address *, std::size_t *bytes, void *module, const char *name);
  int (*functionGetAttribute)(int *, int attribute, void *function);
  int (*functionSetAttribute)(void *function, int attribute, int value);
  int (*occupancy)(int *blocks, void *function, int threads, std::size_t sharedBytes);
  int (*launch)(void *function, unsigned gridX, unsigned gridY, unsigned gridZ, unsigned blockX,
                unsigned blockY, unsigned blockZ, unsigned sharedBytes, void *stream,
                void **arguments, void **extra);
  int (*synchronize)();
  int (*eventCreate)(void **event, unsigned flags);
  int (*eventDestroy)(void *event);
  int (*eventRecord)(void *event, void *stream);
  int (*eventElapsedTime)(float *milliseconds, void *from, void *to);

private:
  void open();
  template <typename Function>
  void find(Function &function, const char *name);

  void *library = nullptr;
  int deviceCount = 0;
  int version = 0; // 13000: CUDA 13.0
};

} // namespace rtsl::runtime::cuda
