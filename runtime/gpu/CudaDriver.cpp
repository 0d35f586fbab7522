#include "runtime/gpu/CudaDriver.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <memory>

namespace rtsl::runtime {

namespace {

/// CUDA 10.0: the first that supports PTX 6.3, which sm_75 needs.
constexpr int oldestDriver = 10000;

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
  MultiprocessorCount = 16,
  ComputeCapabilityMajor = 75,
  ComputeCapabilityMinor = 76,
};
enum FunctionAttribute { LocalSizeBytes = 3, RegisterCount = 4 };
enum StreamFlag : unsigned { NonBlocking = 1 };
enum JitOption { MaxRegisters = 0, ErrorLogBuffer = 5, ErrorLogBufferBytes = 6 };

std::string version(int number) {
  return fmt::format("{}.{}", number / 1000, number % 1000 / 10);
}

} // namespace

// Every function gives a status.
struct CudaDevice::Functions {
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
  int (*functionGetAttribute)(int *, int attribute, void *function);
  int (*occupancy)(int *blocks, void *function, int threads, std::size_t sharedBytes);
  int (*launch)(void *function, unsigned gridX, unsigned gridY, unsigned gridZ, unsigned blockX,
                unsigned blockY, unsigned blockZ, unsigned sharedBytes, void *stream,
                void **arguments, void **extra);
  int (*synchronize)();
  int (*eventCreate)(void **event, unsigned flags);
  int (*eventDestroy)(void *event);
  int (*eventRecord)(void *event, void *stream);
  int (*eventElapsedTime)(float *milliseconds, void *from, void *to);
};

template <typename Function>
void CudaDevice::find(Function &function, const char *name) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function)
    throw Error(message::driverLacks(name, version(oldestDriver)));
}

void CudaDevice::open() {
  library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw Error(message::noDriver(dlerror()));
  functions = new Functions;
  Functions &f = *functions;
  find(f.init, "cuInit");
  find(f.driverGetVersion, "cuDriverGetVersion");
  find(f.getErrorString, "cuGetErrorString");
  find(f.deviceGetCount, "cuDeviceGetCount");
  find(f.deviceGet, "cuDeviceGet");
  find(f.deviceGetName, "cuDeviceGetName");
  find(f.deviceGetAttribute, "cuDeviceGetAttribute");
  find(f.primaryContextRetain, "cuDevicePrimaryCtxRetain");
  find(f.primaryContextRelease, "cuDevicePrimaryCtxRelease_v2");
  find(f.contextSetCurrent, "cuCtxSetCurrent");
  find(f.memoryGetInfo, "cuMemGetInfo_v2");
  find(f.memoryAllocate, "cuMemAlloc_v2");
  find(f.memoryFree, "cuMemFree_v2");
  find(f.memorySet, "cuMemsetD8_v2");
  find(f.hostAllocate, "cuMemAllocHost_v2");
  find(f.hostFree, "cuMemFreeHost");
  find(f.copyToDevice, "cuMemcpyHtoD_v2");
  find(f.copyToHost, "cuMemcpyDtoH_v2");
  find(f.copyWithin, "cuMemcpyDtoD_v2");
  find(f.copyToDeviceAsync, "cuMemcpyHtoDAsync_v2");
  find(f.copyToHostAsync, "cuMemcpyDtoHAsync_v2");
  find(f.streamCreate, "cuStreamCreate");
  find(f.streamDestroy, "cuStreamDestroy_v2");
  find(f.streamSynchronize, "cuStreamSynchronize");
  find(f.moduleLoad, "cuModuleLoadDataEx");
  find(f.moduleUnload, "cuModuleUnload");
  find(f.moduleGetFunction, "cuModuleGetFunction");
  find(f.functionGetAttribute, "cuFuncGetAttribute");
  find(f.occupancy, "cuOccupancyMaxActiveBlocksPerMultiprocessor");
  find(f.launch, "cuLaunchKernel");
  find(f.synchronize, "cuCtxSynchronize");
  find(f.eventCreate, "cuEventCreate");
  find(f.eventDestroy, "cuEventDestroy_v2");
  find(f.eventRecord, "cuEventRecord");
  find(f.eventElapsedTime, "cuEventElapsedTime");

  int driver = 0;
  check(f.driverGetVersion(&driver), "cuDriverGetVersion");
  if (driver < oldestDriver)
    throw Error(message::driverTooOld(version(driver), version(oldestDriver)));
  const int status = f.init(0);
  int count = 0;
  if (status == NoDevice ||
      (status == Success && (f.deviceGetCount(&count) != Success || count == 0)))
    throw Error(message::noGpu());
  check(status, "cuInit");
  check(f.deviceGet(&device, 0), "cuDeviceGet");
  char text[256] = {};
  check(f.deviceGetName(text, sizeof text - 1, device), "cuDeviceGetName");
  deviceName = text;
  int major = 0, minor = 0;
  check(f.deviceGetAttribute(&major, ComputeCapabilityMajor, device), "cuDeviceGetAttribute");
  check(f.deviceGetAttribute(&minor, ComputeCapabilityMinor, device), "cuDeviceGetAttribute");
  computeCapability = 10 * major + minor;
  check(f.deviceGetAttribute(&multiprocessorCount, MultiprocessorCount, device),
        "cuDeviceGetAttribute");
  check(f.primaryContextRetain(&context, device), "cuDevicePrimaryCtxRetain");
  check(f.contextSetCurrent(context), "cuCtxSetCurrent");
  for (void *&event : events)
    check(f.eventCreate(&event, 0), "cuEventCreate");
}

CudaDevice::CudaDevice() {
  try {
    open();
  } catch (...) {
    close();
    throw;
  }
}

CudaDevice::~CudaDevice() {
  close();
}

void CudaDevice::close() {
  if (context) { // frees its memory, unless another CudaDevice of this process uses it
    if (pageLocked)
      functions->hostFree(pageLocked);
    if (stream)
      functions->streamDestroy(stream);
    for (void *event : events)
      if (event)
        functions->eventDestroy(event);
    if (module)
      functions->moduleUnload(module);
    functions->primaryContextRelease(device);
  }
  delete functions;
  if (library)
    dlclose(library);
}

void CudaDevice::check(int status, const char *call) const {
  if (status == Success)
    return;
  const char *text = nullptr;
  if (functions->getErrorString(status, &text) != Success || !text)
    text = "unknown error";
  throw Error(status == runtime::OutOfMemory ? message::gpuOutOfMemory(call, text, status)
                                             : message::gpuFails(call, text, status));
}

std::size_t CudaDevice::freeMemory() const {
  std::size_t free = 0, total = 0;
  check(functions->memoryGetInfo(&free, &total), "cuMemGetInfo");
  return free;
}

CudaDevice::Address CudaDevice::allocate(std::size_t bytes, const char *what) {
  Address address = 0;
  const int status = functions->memoryAllocate(&address, std::max<std::size_t>(bytes, 1));
  if (status == runtime::OutOfMemory)
    throw Error(
        message::noGpuMemory(what, double(bytes) / (1 << 20), double(freeMemory()) / (1 << 20)));
  check(status, "cuMemAlloc");
  return address;
}

void CudaDevice::release(Address address) {
  check(functions->memoryFree(address), "cuMemFree");
}

void CudaDevice::clear(Address address, std::size_t bytes) {
  check(functions->memorySet(address, 0, bytes), "cuMemsetD8");
}

void CudaDevice::upload(Address to, const void *from, std::size_t bytes) {
  check(functions->copyToDevice(to, from, bytes), "cuMemcpyHtoD");
}

void CudaDevice::download(void *to, Address from, std::size_t bytes) {
  check(functions->copyToHost(to, from, bytes), "cuMemcpyDtoH");
}

void CudaDevice::copy(Address to, Address from, std::size_t bytes) {
  check(functions->copyWithin(to, from, bytes), "cuMemcpyDtoD");
}

void CudaDevice::openMeanwhile() {
  check(functions->contextSetCurrent(context), "cuCtxSetCurrent"); // of this thread
  if (!stream)
    check(functions->streamCreate(&stream, NonBlocking), "cuStreamCreate");
  if (!pageLocked)
    check(functions->hostAllocate(&pageLocked, mostBytesMeanwhile), "cuMemAllocHost");
}

void CudaDevice::uploadMeanwhile(Address to, const void *from, std::size_t bytes) {
  openMeanwhile();
  std::memcpy(pageLocked, from, bytes);
  check(functions->copyToDeviceAsync(to, pageLocked, bytes, stream), "cuMemcpyHtoDAsync");
  check(functions->streamSynchronize(stream), "cuStreamSynchronize");
}

void CudaDevice::downloadMeanwhile(void *to, Address from, std::size_t bytes) {
  openMeanwhile();
  check(functions->copyToHostAsync(pageLocked, from, bytes, stream), "cuMemcpyDtoHAsync");
  check(functions->streamSynchronize(stream), "cuStreamSynchronize");
  std::memcpy(to, pageLocked, bytes);
}

void CudaDevice::load(const std::string &ptx, unsigned maxRegisters) {
  if (module)
    unload(module);
  module = nullptr;
  module = compile(ptx.c_str(), maxRegisters);
}

void CudaDevice::unload(Module code) {
  check(functions->moduleUnload(code), "cuModuleUnload");
}

CudaDevice::Module CudaDevice::compile(const char *ptx, unsigned maxRegisters) {
  Module code = nullptr;
  std::string log(4096, '\0');
  const auto value = [](std::uintptr_t number) { return reinterpret_cast<void *>(number); };
  int options[] = {ErrorLogBuffer, ErrorLogBufferBytes, MaxRegisters};
  void *values[] = {log.data(), value(log.size() - 1), value(maxRegisters)};
  const int status = functions->moduleLoad(&code, ptx, maxRegisters ? 3 : 2, options, values);
  log.resize(log.find('\0'));
  if (status == UnsupportedPtxVersion)
    throw Error(message::driverTooOldForPtx());
  if (status == NoBinaryForGpu || status == InvalidPtx)
    throw Error(message::gpuRefusesCode(deviceName, computeCapability,
                                        log.empty() ? "it was made for a newer GPU" : log));
  check(status, "cuModuleLoadDataEx");
  return code;
}

CudaDevice::Kernel CudaDevice::kernel(const char *name, Module code) const {
  Kernel kernel;
  check(functions->moduleGetFunction(&kernel.function, code, name), "cuModuleGetFunction");
  check(functions->functionGetAttribute(&kernel.registers, RegisterCount, kernel.function),
        "cuFuncGetAttribute");
  check(functions->functionGetAttribute(&kernel.localBytes, LocalSizeBytes, kernel.function),
        "cuFuncGetAttribute");
  return kernel;
}

int CudaDevice::blocksAtOnce(const Kernel &kernel, unsigned threadsPerBlock) const {
  int blocks = 0;
  check(functions->occupancy(&blocks, kernel.function, int(threadsPerBlock), 0),
        "cuOccupancyMaxActiveBlocksPerMultiprocessor");
  return blocks;
}

double CudaDevice::launch(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                          void **arguments) {
  check(functions->eventRecord(events[0], nullptr), "cuEventRecord");
  launchLater(kernel, blocks, threadsPerBlock, arguments);
  check(functions->eventRecord(events[1], nullptr), "cuEventRecord");
  wait();
  float milliseconds = 0;
  check(functions->eventElapsedTime(&milliseconds, events[0], events[1]), "cuEventElapsedTime");
  return double(milliseconds) * 1e-3;
}

void CudaDevice::launchLater(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                             void **arguments) {
  check(functions->launch(kernel.function, blocks, 1, 1, threadsPerBlock, 1, 1, 0, nullptr,
                          arguments, nullptr),
        "cuLaunchKernel");
}

void CudaDevice::wait() {
  check(functions->synchronize(), "cuCtxSynchronize");
}

} // namespace rtsl::runtime
