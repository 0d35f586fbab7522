// Stands in for libcuda.so.1: a device whose memory is the process's, and whose one kernel paints a
// pattern after having checked that it was launched as rtsl_render has to be. FAKE_CUDA makes it
// fail in one of the ways in which drivers and devices do, or paint half of the picture and go on
// until it is stopped ("endless").
#include "runtime/device/ray/Abi.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <thread>

namespace {

enum Status {
  Success = 0,
  InvalidValue = 1,
  OutOfMemory = 2,
  NoDevice = 100,
  NoBinaryForGpu = 209,
  UnsupportedPtxVersion = 222,
  IllegalAddress = 700,
};

constexpr std::size_t littleMemory = 100000;
constexpr unsigned multiprocessors = 2, blocksAtOnce = 3;

bool is(const char *failure) {
  const char *wanted = std::getenv("FAKE_CUDA");
  return wanted && std::strcmp(wanted, failure) == 0;
}

RtslStatus *endlessStatus = nullptr; // of a kernel that runs until it is stopped

std::map<std::uintptr_t, std::size_t> allocations;
std::size_t allocated = 0;

std::size_t totalMemory() {
  return is("little-memory") ? littleMemory : std::size_t(1) << 30;
}

/// Do `bytes` at the address belong to one allocation?
bool isAllocated(const void *address, std::size_t bytes) {
  const auto start = reinterpret_cast<std::uintptr_t>(address);
  auto after = allocations.upper_bound(start);
  if (after == allocations.begin())
    return false;
  --after;
  return start + bytes <= after->first + after->second;
}

/// Sample n of a pixel, from 1, is n times the color.
void takeSamples(const RtslPixelSums &sums, std::uint64_t pixel, std::uint32_t count,
                 const float *color) {
  for (; sums.taken[pixel] < count; ++sums.counted[pixel]) {
    ++sums.taken[pixel];
    for (std::uint32_t c = 0; c < 3; ++c)
      sums.colors[3 * pixel + c] += double(sums.taken[pixel]) * double(color[c]);
  }
}

} // namespace

extern "C" {

int cuInit(unsigned) {
  return is("no-device") ? NoDevice : Success;
}
int cuDriverGetVersion(int *version) {
  *version = is("old-driver") ? 9020 : 12040;
  return Success;
}
int cuGetErrorString(int status, const char **text) {
  *text = status == IllegalAddress ? "an illegal memory access was encountered" : "some error";
  return Success;
}
int cuDeviceGetCount(int *count) {
  *count = 1;
  return Success;
}
int cuDeviceGet(int *device, int) {
  *device = 0;
  return Success;
}
int cuDeviceGetName(char *name, int size, int) {
  std::snprintf(name, std::size_t(size), "Fake 1000");
  return Success;
}
int cuDeviceGetAttribute(int *value, int attribute, int) {
  *value = attribute == 16 ? int(multiprocessors) : attribute == 75 ? 7 : 5;
  return Success;
}
int cuDevicePrimaryCtxRetain(void **context, int) {
  *context = &allocations;
  return Success;
}
int cuDevicePrimaryCtxRelease_v2(int) {
  for (auto &one : allocations)
    std::free(reinterpret_cast<void *>(one.first));
  allocations.clear();
  return Success;
}
int cuCtxSetCurrent(void *) {
  return Success;
}
int cuMemGetInfo_v2(std::size_t *free, std::size_t *total) {
  *total = totalMemory();
  *free = *total - allocated;
  return Success;
}
int cuMemAlloc_v2(std::uint64_t *address, std::size_t bytes) {
  if (bytes > totalMemory() - allocated)
    return OutOfMemory;
  const std::size_t rounded = (bytes + 255) / 256 * 256;
  void *memory = std::aligned_alloc(256, rounded);
  std::memset(memory, 0xa5, rounded);
  *address = reinterpret_cast<std::uintptr_t>(memory);
  allocations[*address] = bytes;
  allocated += bytes;
  return Success;
}
int cuMemFree_v2(std::uint64_t address) {
  const auto found = allocations.find(address);
  if (found == allocations.end())
    return InvalidValue;
  allocated -= found->second;
  allocations.erase(found);
  std::free(reinterpret_cast<void *>(address));
  return Success;
}
int cuMemAllocHost_v2(void **memory, std::size_t bytes) {
  *memory = std::malloc(bytes);
  return Success;
}
int cuMemFreeHost(void *memory) {
  std::free(memory);
  return Success;
}
int cuMemsetD8_v2(std::uint64_t address, unsigned char value, std::size_t bytes) {
  if (!isAllocated(reinterpret_cast<void *>(address), bytes))
    return InvalidValue;
  std::memset(reinterpret_cast<void *>(address), value, bytes);
  return Success;
}
int cuMemcpyHtoD_v2(std::uint64_t to, const void *from, std::size_t bytes) {
  if (!isAllocated(reinterpret_cast<void *>(to), bytes))
    return InvalidValue;
  std::memcpy(reinterpret_cast<void *>(to), from, bytes);
  return Success;
}
int cuMemcpyDtoH_v2(void *to, std::uint64_t from, std::size_t bytes) {
  if (!isAllocated(reinterpret_cast<void *>(from), bytes))
    return InvalidValue;
  std::memcpy(to, reinterpret_cast<void *>(from), bytes);
  return Success;
}
int cuStreamCreate(void **stream, unsigned flags) {
  *stream = &allocations;
  return flags == 1 ? Success : InvalidValue; // it must not wait for the kernel
}
int cuStreamDestroy_v2(void *) {
  return Success;
}
int cuStreamSynchronize(void *) {
  return Success;
}
int cuMemcpyHtoDAsync_v2(std::uint64_t to, const void *from, std::size_t bytes, void *stream) {
  if (!stream || !isAllocated(reinterpret_cast<void *>(to), bytes) ||
      bytes != sizeof(std::uint32_t))
    return InvalidValue;
  std::uint32_t value;
  std::memcpy(&value, from, sizeof value);
  __atomic_store_n(reinterpret_cast<std::uint32_t *>(to), value, __ATOMIC_RELAXED);
  return Success;
}
int cuMemcpyDtoHAsync_v2(void *to, std::uint64_t from, std::size_t bytes, void *stream) {
  if (!stream || !isAllocated(reinterpret_cast<void *>(from), bytes) ||
      bytes != sizeof(std::uint64_t))
    return InvalidValue;
  const std::uint64_t value =
      __atomic_load_n(reinterpret_cast<std::uint64_t *>(from), __ATOMIC_RELAXED);
  std::memcpy(to, &value, sizeof value);
  return Success;
}
int cuModuleLoadDataEx(void **module, const void *image, unsigned count, int *options,
                       void **values) {
  if (is("old-ptx"))
    return UnsupportedPtxVersion;
  if (is("other-gpu")) {
    for (unsigned i = 0; i < count; ++i)
      if (options[i] == 5)
        std::strcpy(static_cast<char *>(values[i]), "SM version 120 is needed");
    return NoBinaryForGpu;
  }
  const char *ptx = static_cast<const char *>(image);
  *module = &allocations;
  return std::strstr(ptx, ".entry rtsl_render") ? Success : InvalidValue;
}
int cuModuleUnload(void *) {
  return Success;
}
int cuModuleGetFunction(void **function, void *, const char *name) {
  *function = &allocations;
  return std::strcmp(name, "rtsl_render") == 0 ? Success : InvalidValue;
}
int cuFuncGetAttribute(int *value, int, void *) {
  *value = 40;
  return Success;
}
int cuOccupancyMaxActiveBlocksPerMultiprocessor(int *blocks, void *, int, std::size_t) {
  *blocks = blocksAtOnce;
  return Success;
}

/// Paints (x, y, seed): the launch must have arrived, and every pointer of it must lead to device
/// memory.
int cuLaunchKernel(void *, unsigned blocks, unsigned, unsigned, unsigned threads, unsigned,
                   unsigned, unsigned, void *, void **arguments, void **) {
  if (is("fault"))
    return Success; // it shows when the kernel is waited for
  const RtslJob &job = **static_cast<RtslJob **>(arguments[0]);
  if (!isAllocated(&job, sizeof job) || !isAllocated(job.launch, sizeof *job.launch))
    return IllegalAddress;
  const RtslLaunch &launch = *job.launch;
  const std::uint64_t pixels = std::uint64_t(job.width) * job.height;
  bool isFine = blocks >= 1 && blocks <= multiprocessors * blocksAtOnce && threads % 32 == 0;
  isFine &= isAllocated(job.lanes, blocks * threads * job.laneBytes);
  isFine &= isAllocated(job.pixels, pixels * launch.colorComponents * sizeof(float));
  isFine &= isAllocated(job.status, sizeof *job.status) && launch.status == job.status &&
            job.status->nextPixel == 0;
  isFine &=
      isAllocated(launch.records, 16) &&
      (launch.lightCount == 0 || isAllocated(launch.lights, launch.lightCount * sizeof(RtslRef)));
  isFine &= isAllocated(launch.instances, launch.instanceCount * sizeof(RtslInstance));
  isFine &= isAllocated(launch.nodes, launch.nodeCount * sizeof(RtslBvhNode));
  for (std::uint32_t i = 0; i < launch.meshCount; ++i)
    isFine &= isAllocated(launch.meshes[i].positions, 12 * launch.meshes[i].vertexCount) &&
              isAllocated(launch.meshes[i].indices, 12 * launch.meshes[i].triangleCount);
  isFine &= job.left + job.width <= launch.width && job.top + job.height <= launch.height;
  const RtslPixelSums &sums = job.sums;
  if (sums.colors)
    isFine &= isAllocated(sums.colors, pixels * launch.colorComponents * sizeof(double)) &&
              isAllocated(sums.squares, pixels * sizeof(double)) &&
              isAllocated(sums.counted, pixels * sizeof(std::uint32_t)) &&
              isAllocated(sums.taken, pixels * sizeof(std::uint32_t));
  if (!isFine)
    return IllegalAddress;
  const std::uint64_t painted = is("endless") ? pixels / 2 : pixels;
  for (std::uint64_t i = 0; i < pixels * launch.colorComponents; ++i)
    if (job.pixels[i] != 0)
      return IllegalAddress;
  for (std::uint64_t i = 0; i < painted; ++i) {
    const float color[3] = {float(job.left + i % job.width), float(job.top + i / job.width),
                            float(launch.seed)};
    for (std::uint32_t c = 0; c < 3 && !sums.colors; ++c)
      job.pixels[3 * i + c] = color[c];
    if (sums.colors)
      takeSamples(sums, i, job.samplesPerPixel, color);
  }
  __atomic_store_n(&job.status->nextPixel, painted, __ATOMIC_RELAXED);
  endlessStatus = is("endless") ? job.status : nullptr;
  if (is("overflow"))
    job.status->problem = RTSL_PROBLEM_STACK;
  return Success;
}
int cuCtxSynchronize() {
  while (endlessStatus && !__atomic_load_n(&endlessStatus->stop, __ATOMIC_RELAXED))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return is("fault") ? IllegalAddress : Success;
}
int cuEventCreate(void **event, unsigned) {
  *event = &allocated; // anything but null
  return Success;
}
int cuEventDestroy_v2(void *) {
  return Success;
}
int cuEventRecord(void *, void *) {
  return Success;
}
int cuEventElapsedTime(float *milliseconds, void *, void *) {
  *milliseconds = 250;
  return Success;
}

} // extern "C"
