#include "runtime/gpu/CudaDevice.h"

#include "runtime/gpu/PtxKernels.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

namespace rtsl::runtime {

int CudaDevice::count() {
  return cuda::Driver().devices();
}

CudaDevice::CudaDevice(int ordinal) : driver(std::make_unique<cuda::Driver>()) {
  try {
    open(ordinal);
  } catch (...) {
    close();
    throw;
  }
}

void CudaDevice::open(int ordinal) {
  const cuda::Driver &f = *driver;
  f.check(f.deviceGet(&device, ordinal), "cuDeviceGet");
  char text[256] = {};
  f.check(f.deviceGetName(text, sizeof text - 1, device), "cuDeviceGetName");
  deviceName = text;
  const auto attribute = [&](cuda::DeviceAttribute which) {
    int value = 0;
    f.check(f.deviceGetAttribute(&value, which, device), "cuDeviceGetAttribute");
    return value;
  };
  computeCapability =
      10 * attribute(cuda::ComputeCapabilityMajor) + attribute(cuda::ComputeCapabilityMinor);
  multiprocessorCount = attribute(cuda::MultiprocessorCount);
  threadsOfMultiprocessor = attribute(cuda::ThreadsOfMultiprocessor);
  sharedBytesOfMultiprocessor = attribute(cuda::SharedBytesOfMultiprocessor);
  mostSharedBytesOfBlock = attribute(cuda::MostSharedBytesOfBlock);
  f.check(f.primaryContextRetain(&context, device), "cuDevicePrimaryCtxRetain");
  use();
  for (void *&event : events)
    f.check(f.eventCreate(&event, 0), "cuEventCreate");
}

void CudaDevice::use() const {
  driver->check(driver->contextSetCurrent(context), "cuCtxSetCurrent");
}

CudaDevice::~CudaDevice() {
  close();
}

void CudaDevice::close() {
  if (!context)
    return;
  driver->contextSetCurrent(context);
  if (pageLocked)
    driver->hostFree(pageLocked);
  if (stream)
    driver->streamDestroy(stream);
  for (void *event : events)
    if (event)
      driver->eventDestroy(event);
  // Frees its memory and code, unless another CudaDevice of this process uses it.
  driver->primaryContextRelease(device);
}

std::size_t CudaDevice::freeMemory() const {
  std::size_t free = 0, total = 0;
  driver->check(driver->memoryGetInfo(&free, &total), "cuMemGetInfo");
  return free;
}

CudaDevice::Address CudaDevice::allocate(std::size_t bytes, const char *what) {
  Address address = 0;
  const int status = driver->memoryAllocate(&address, std::max<std::size_t>(bytes, 1));
  if (status == cuda::OutOfMemory)
    throw Error(
        message::noGpuMemory(what, double(bytes) / (1 << 20), double(freeMemory()) / (1 << 20)));
  driver->check(status, "cuMemAlloc");
  return address;
}

void CudaDevice::release(Address address) {
  driver->check(driver->memoryFree(address), "cuMemFree");
}

void CudaDevice::clear(Address address, std::size_t bytes) {
  driver->check(driver->memorySet(address, 0, bytes), "cuMemsetD8");
}

void CudaDevice::upload(Address to, const void *from, std::size_t bytes) {
  driver->check(driver->copyToDevice(to, from, bytes), "cuMemcpyHtoD");
}

void CudaDevice::download(void *to, Address from, std::size_t bytes) {
  driver->check(driver->copyToHost(to, from, bytes), "cuMemcpyDtoH");
}

void CudaDevice::copy(Address to, Address from, std::size_t bytes) {
  driver->check(driver->copyWithin(to, from, bytes), "cuMemcpyDtoD");
}

void CudaDevice::openMeanwhile() {
  use();
  if (!stream)
    driver->check(driver->streamCreate(&stream, cuda::NonBlocking), "cuStreamCreate");
  if (!pageLocked)
    driver->check(driver->hostAllocate(&pageLocked, mostBytesMeanwhile), "cuMemAllocHost");
}

void CudaDevice::uploadMeanwhile(Address to, const void *from, std::size_t bytes) {
  openMeanwhile();
  std::memcpy(pageLocked, from, bytes);
  driver->check(driver->copyToDeviceAsync(to, pageLocked, bytes, stream), "cuMemcpyHtoDAsync");
  driver->check(driver->streamSynchronize(stream), "cuStreamSynchronize");
}

void CudaDevice::downloadMeanwhile(void *to, Address from, std::size_t bytes) {
  openMeanwhile();
  driver->check(driver->copyToHostAsync(pageLocked, from, bytes, stream), "cuMemcpyDtoHAsync");
  driver->check(driver->streamSynchronize(stream), "cuStreamSynchronize");
  std::memcpy(to, pageLocked, bytes);
}

CudaDevice::Module CudaDevice::compile(const std::string &ptx, unsigned maxRegisters) {
  std::string errors(4096, '\0'), log(65536, '\0');
  const auto value = [](std::uintptr_t number) { return reinterpret_cast<void *>(number); };
  std::vector<int> options;
  std::vector<void *> values;
  const auto add = [&](cuda::JitOption option, void *setting) {
    options.push_back(option);
    values.push_back(setting);
  };
  add(cuda::ErrorLogBuffer, errors.data());
  add(cuda::ErrorLogBufferBytes, value(errors.size() - 1));
  add(cuda::InfoLogBuffer, log.data());
  add(cuda::InfoLogBufferBytes, value(log.size() - 1));
  add(cuda::LogVerbose, value(1));
  if (maxRegisters) {
    add(cuda::MaxRegisters, value(maxRegisters));
    if (maxRegisters < mostRegistersStated(ptx))
      add(cuda::OverrideDirectives, value(1));
  }
  if (driver->compilesInThreads())
    add(cuda::ThreadsOfCompiler, value(0)); // one for each core
  Module code;
  const int status = driver->moduleLoad(&code.handle, ptx.c_str(), unsigned(options.size()),
                                        options.data(), values.data());
  errors.resize(errors.find('\0'));
  log.resize(log.find('\0'));
  code.log = std::move(log);
  if (status == cuda::UnsupportedPtxVersion)
    throw Error(message::driverTooOldForPtx());
  if (status == cuda::NoBinaryForGpu || status == cuda::InvalidPtx)
    throw Error(message::gpuRefusesCode(deviceName, computeCapability,
                                        errors.empty() ? "it was made for a newer GPU" : errors));
  driver->check(status, "cuModuleLoadDataEx");
  return code;
}

void CudaDevice::unload(const Module &code) {
  driver->check(driver->moduleUnload(code.handle), "cuModuleUnload");
}

/// Finds "... properties for KERNEL" in the log, and "8 bytes spill stores, 12 bytes spill loads"
/// after it.
static void readSpills(const std::string &log, const char *name, CudaDevice::Kernel &kernel) {
  const std::size_t properties = log.find(fmt::format("properties for {}\n", name));
  const std::size_t frame =
      properties == std::string::npos ? properties : log.find("bytes stack frame, ", properties);
  int stores = 0, loads = 0;
  if (frame == std::string::npos ||
      std::sscanf(log.c_str() + frame, "bytes stack frame, %d bytes spill stores, %d bytes",
                  &stores, &loads) != 2)
    return;
  kernel.spillStores = stores;
  kernel.spillLoads = loads;
}

CudaDevice::Kernel CudaDevice::kernel(const char *name, const Module &code) const {
  const cuda::Driver &f = *driver;
  Kernel kernel;
  f.check(f.moduleGetFunction(&kernel.function, code.handle, name), "cuModuleGetFunction");
  f.check(f.functionGetAttribute(&kernel.registers, cuda::RegisterCount, kernel.function),
          "cuFuncGetAttribute");
  f.check(f.functionGetAttribute(&kernel.localBytes, cuda::LocalSizeBytes, kernel.function),
          "cuFuncGetAttribute");
  readSpills(code.log, name, kernel);
  return kernel;
}

CudaDevice::Address CudaDevice::variable(const char *name, const Module &code) const {
  Address address = 0;
  driver->check(driver->moduleGetGlobal(&address, nullptr, code.handle, name), "cuModuleGetGlobal");
  return address;
}

void CudaDevice::giveSharedMemory(Kernel &kernel, unsigned bytes) const {
  driver->check(
      driver->functionSetAttribute(kernel.function, cuda::MostDynamicSharedBytes, int(bytes)),
      "cuFuncSetAttribute");
  kernel.sharedBytes = bytes;
}

int CudaDevice::blocksAtOnce(const Kernel &kernel, unsigned threadsPerBlock) const {
  int blocks = 0;
  driver->check(
      driver->occupancy(&blocks, kernel.function, int(threadsPerBlock), kernel.sharedBytes),
      "cuOccupancyMaxActiveBlocksPerMultiprocessor");
  return blocks;
}

double CudaDevice::launch(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                          const void *const *arguments) {
  driver->check(driver->eventRecord(events[0], nullptr), "cuEventRecord");
  launchLater(kernel, blocks, threadsPerBlock, arguments);
  driver->check(driver->eventRecord(events[1], nullptr), "cuEventRecord");
  wait();
  float milliseconds = 0;
  driver->check(driver->eventElapsedTime(&milliseconds, events[0], events[1]),
                "cuEventElapsedTime");
  return double(milliseconds) * 1e-3;
}

void CudaDevice::launchLater(const Kernel &kernel, unsigned blocks, unsigned threadsPerBlock,
                             const void *const *arguments) {
  driver->check(driver->launch(kernel.function, blocks, 1, 1, threadsPerBlock, 1, 1,
                               kernel.sharedBytes, nullptr, const_cast<void **>(arguments),
                               nullptr),
                "cuLaunchKernel");
}

void CudaDevice::wait() {
  driver->check(driver->synchronize(), "cuCtxSynchronize");
}

} // namespace rtsl::runtime
