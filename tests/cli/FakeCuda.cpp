// Stands in for libcuda.so.1: devices whose memory is the process's, and whose kernel rtsl_render,
// or the kernels of a wavefront, paint a pattern after having checked that they were launched as
// they have to be. There are FAKE_CUDA_DEVICES of them, or one; a thread that uses memory of
// another one than its own fails. FAKE_CUDA makes them fail in one of the ways in which drivers and
// devices do, or paint half of the picture and go on until they are stopped, again and again
// ("endless"), or take longer on one of them ("uneven"). The driver is of CUDA 12.4, or of 13.0
// ("new-driver"), whose compiler has to be told to use all cores.
#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/SampleSums.h"
#include "runtime/device/trees/Clusters.h"
#include "runtime/device/trees/Refit.h"
#include "runtime/device/trees/Sort.h"
#include "runtime/device/trees/Widen.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace {

enum Status {
  Success = 0,
  InvalidValue = 1,
  OutOfMemory = 2,
  NoDevice = 100,
  NoBinaryForGpu = 209,
  UnsupportedPtxVersion = 222,
  NotFound = 500,
  IllegalAddress = 700,
};

constexpr std::size_t littleMemory = 100000;
constexpr unsigned multiprocessors = 2, blocksAtOnce = 3;

bool is(const char *failure) {
  const char *wanted = std::getenv("FAKE_CUDA");
  return wanted && std::strcmp(wanted, failure) == 0;
}

/// With "uneven" one device is slower than the others.
constexpr std::size_t mostDevices = 4, slowDevice = 1;

struct Device {
  std::mutex mutex;
  std::map<std::uintptr_t, std::size_t> allocations;
  std::size_t allocated = 0;
  std::string code;                    // of all programs
  std::size_t waveStates = 0;          // of the last one
  std::uint32_t sharedBytes = 0;       // of a persistent block
  RtslLaunch launch = {};              // the variable of the last one
  RtslStatus *endlessStatus = nullptr; // of a kernel that runs until it is stopped
};
Device devices[mostDevices];
thread_local Device *current = nullptr; // of this thread

/// With "copies" the bytes that were copied to and from the devices are printed at the end.
struct Copies {
  std::atomic<std::size_t> bytes{0};
  ~Copies() {
    if (is("copies"))
      std::fprintf(stderr, "%zu bytes were copied\n", bytes.load());
  }
};
Copies copies;

int deviceCount() {
  const char *count = std::getenv("FAKE_CUDA_DEVICES");
  return count ? std::atoi(count) : 1;
}

int driverVersion() {
  return is("old-driver") ? 9020 : is("new-driver") ? 13000 : 12040;
}

int mostSharedBytes() {
  return is("little-shared-memory") ? 4096 : 101376;
}

std::size_t totalMemory() {
  return is("little-memory") ? littleMemory : std::size_t(1) << 30;
}

/// Do `bytes` at the address belong to one allocation?
bool isAllocated(const void *address, std::size_t bytes) {
  if (!current)
    return false;
  const std::lock_guard<std::mutex> lock(current->mutex);
  const auto start = reinterpret_cast<std::uintptr_t>(address);
  auto after = current->allocations.upper_bound(start);
  if (after == current->allocations.begin())
    return false;
  --after;
  return start + bytes <= after->first + after->second;
}

/// Sample n of a pixel, from 1, is n times (x, y, seed).
void paint(const RtslJob &job, std::uint64_t sample) {
  const rtsl::device::Pixel pixel =
      rtsl::device::pixelAt(job, std::uint32_t(sample / job.sampleCount));
  const std::uint32_t number = job.firstSample + std::uint32_t(sample % job.sampleCount);
  if (job.taken && number < job.taken[pixel.number(job)])
    return;
  const float color[3] = {float(job.left + pixel.x), float(job.top + pixel.y),
                          float(job.launch->seed)};
  for (std::uint32_t c = 0; c < 3; ++c)
    job.samples[3 * sample + c] = float(number + 1) * color[c];
}

/// What a kernel does that renders samples up to `last`, if its job is as it has to be, and there
/// are so many bytes for rays.
int render(const RtslJob &job, std::uint64_t last, std::uint64_t rays) {
  if (!isAllocated(job.launch, sizeof *job.launch))
    return IllegalAddress;
  const RtslLaunch &launch = *job.launch;
  const std::uint64_t samples = rtsl::device::samplesOfSlice(job);
  bool isFine = std::memcmp(&current->launch, &launch, sizeof launch) == 0;
  isFine &= isAllocated(job.lanes, rays);
  isFine &= isAllocated(job.samples, samples * launch.colorComponents * sizeof(float));
  isFine &= isAllocated(job.status, sizeof *job.status) && launch.status == job.status &&
            job.status->nextSample < samples && job.status->stop == 0;
  isFine &= job.firstSample + job.sampleCount <= job.samplesPerPixel;
  isFine &= !job.places || isAllocated(job.places, job.placeCount * sizeof(std::uint32_t));
  isFine &=
      isAllocated(launch.records, 16) &&
      (launch.lightCount == 0 || isAllocated(launch.lights, launch.lightCount * sizeof(RtslRef)));
  isFine &= isAllocated(launch.instances, launch.instanceCount * sizeof(RtslInstance));
  isFine &= isAllocated(launch.nodes, launch.nodeCount * sizeof(RtslBvhNode));
  for (std::uint32_t i = 0; i < launch.meshCount; ++i)
    isFine &= isAllocated(launch.meshes[i].positions, 12 * launch.meshes[i].vertexCount) &&
              isAllocated(launch.meshes[i].indices, 12 * launch.meshes[i].triangleCount);
  isFine &=
      job.left + job.width <= launch.width && job.top + job.height <= launch.height * launch.slices;
  if (!isFine)
    return IllegalAddress;
  const std::uint64_t first = job.status->nextSample,
                      end = !is("endless") ? last
                            : first == 0   ? samples / 2
                                           : first; // nothing more
  for (std::uint64_t i = first; i < end; ++i)
    paint(job, i);
  __atomic_store_n(&job.status->nextSample, end, __ATOMIC_RELAXED);
  current->endlessStatus = is("endless") ? job.status : nullptr;
  if (is("overflow"))
    job.status->problem = RTSL_PROBLEM_STACK;
  return Success;
}

/// Lanes that take samples until none is left.
int renderByLanes(const RtslJob &job, unsigned blocks, unsigned threads, std::uint64_t rays) {
  const bool isFine = blocks >= 1 && blocks <= multiprocessors * blocksAtOnce && threads % 32 == 0;
  return isFine ? render(job, rtsl::device::samplesOfSlice(job), rays) : IllegalAddress;
}

/// A thread for each sample or pixel of the launch.
int renderByThreads(const RtslJob &job, bool takePixels, unsigned blocks, unsigned threads) {
  const std::uint64_t first = job.firstOfLaunch, end = job.endOfLaunch,
                      ofThread = takePixels ? job.sampleCount : 1, count = (end - first) / ofThread;
  bool isFine = isAllocated(job.status, sizeof *job.status) && job.status->nextSample == first;
  isFine &= first < end && end <= rtsl::device::samplesOfSlice(job) && first % ofThread == 0 &&
            end % ofThread == 0;
  isFine &= threads % 32 == 0 && blocks == (count + threads - 1) / threads;
  return isFine ? render(job, end, 0) : IllegalAddress;
}

/// The kernels of a wavefront, on the lengths of the queues alone: a sample takes one traversal.
struct WaveTurn {
  std::uint32_t *now, *next; // the lengths of the queues: of traversal, and of each state
  std::size_t queues;

  bool isEmpty() const {
    return std::all_of(now, now + queues, [](std::uint32_t count) { return count == 0; });
  }
};
constexpr std::size_t traceQueue = 0;

WaveTurn waveTurn(const RtslJob &job, std::uint32_t turn) {
  auto *counts = reinterpret_cast<std::uint32_t *>(job.lanes);
  const std::size_t queues = current->waveStates + 1;
  return {counts + (turn & 1) * queues, counts + (~turn & 1) * queues, queues};
}

int beginWave(const RtslJob &job) {
  const std::uint64_t queues = 2 * (current->waveStates + 1) * sizeof(std::uint32_t);
  if (job.slots == 0 || !isAllocated(job.lanes, job.slots * (queues + job.laneBytes)))
    return IllegalAddress;
  return Success;
}

int traceWave(const RtslJob &job, std::uint32_t turn) {
  const WaveTurn counts = waveTurn(job, turn);
  if (counts.now[traceQueue] == 0)
    return IllegalAddress; // a launch for nothing
  return Success;
}

int sampleWave(const RtslJob &job, std::uint32_t turn) {
  const WaveTurn counts = waveTurn(job, turn);
  if (!counts.isEmpty())
    return IllegalAddress; // samples begin when none is in flight
  if (is("overflow")) {
    job.status->problem = RTSL_PROBLEM_STACK;
    return Success;
  }
  const std::uint64_t samples = rtsl::device::samplesOfSlice(job);
  for (std::uint32_t slot = 0; slot < job.slots && !job.status->stop; ++slot)
    if (const std::uint64_t sample = job.status->nextSample++; sample < samples) {
      paint(job, sample);
      ++counts.next[traceQueue];
    }
  return Success;
}

/// The kernel of persistent blocks: their slots are in shared memory, apart from the stacks.
int persist(const RtslJob &job, unsigned blocks, unsigned threads) {
  if (job.slots == 0 || job.slots % 32 != 0 || job.slots * 16 > current->sharedBytes)
    return IllegalAddress;
  return renderByLanes(job, blocks, threads, std::uint64_t(blocks) * job.slots * job.laneBytes);
}

/// The kernel that adds the samples to the sums; it must follow the other one.
int sum(const RtslJob &job) {
  const std::uint64_t pixels = std::uint64_t(job.width) * job.height;
  const std::uint32_t components = job.launch->colorComponents;
  const RtslPixelSums &sums = job.sums;
  const std::uint64_t halves = pixels * rtsl::device::halvesOf(sums);
  bool isFine = job.status->nextSample > 0;
  if (job.pixels)
    isFine &= isAllocated(job.pixels, pixels * components * sizeof(float));
  if (sums.colors)
    isFine &= isAllocated(sums.colors, halves * components * sizeof(double)) &&
              isAllocated(sums.counted, halves * sizeof(std::uint32_t)) &&
              isAllocated(sums.taken, pixels * sizeof(std::uint32_t));
  if (sums.squares)
    isFine &= isAllocated(sums.squares, halves * sizeof(double));
  if (sums.closed)
    isFine &= isAllocated(sums.closed, pixels * sizeof(std::uint32_t)) &&
              isAllocated(sums.values, halves * sizeof(double)) &&
              isAllocated(sums.deciding, halves * sizeof(std::uint32_t));
  if (!isFine)
    return IllegalAddress;
  rtsl::device::addSamples(job, 0, 1);
  return Success;
}

/// What the driver gives out as kernels: those of programs, and those that build trees.
const char *const kernels[] = {
    "rtsl_render",        "rtsl_sum",         "rtsl_wave_begin", "rtsl_wave_trace",
    "rtsl_wave_sample",   "rtsl_wave_state_", "rtsl_persistent", "rtsl_render_samples",
    "rtsl_render_pixels", "rtsl_wave_light_",
#define RTSL_BUILD_STEP(name, call) "rtsl_build_" #name,
#include "runtime/device/trees/Steps.def"
};
constexpr std::size_t programKernels = 10;
constexpr const char *entry = ".entry ";

bool hasKernel(const char *code, const char *name) {
  return std::strstr(code, (std::string(entry) + name).c_str());
}

/// A step of a build, on warps of one lane.
int buildStep(std::size_t number, const rtsl::device::build::TreeBuild &build, std::uint32_t count,
              std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  using namespace rtsl::device::build;
  if (!isAllocated(&build, sizeof build))
    return IllegalAddress;
  std::size_t step = 0;
#define RTSL_BUILD_STEP(name, call)                                                                \
  if (number == step++)                                                                            \
    for (std::uint32_t i = 0; i < count; ++i)                                                      \
      call;
#define RTSL_BUILD_STEP_OF_WARPS(name, call)                                                       \
  if (number == step++)                                                                            \
    for (std::uint32_t i = 0; i < count / 32; ++i)                                                 \
      call;
#include "runtime/device/trees/Steps.def"
  return Success;
}

enum JitOption {
  maxRegisters = 0,
  infoLog = 3,
  errorLog = 5,
  overrideDirectives = 33,
  threadsOfCompiler = 34
};

std::map<int, void *> optionsOf(unsigned count, const int *options, void *const *values) {
  std::map<int, void *> given;
  for (unsigned i = 0; i < count; ++i)
    given[options[i]] = values[i];
  return given;
}

/// By the first kernel that does.
unsigned long registersStated(const void *ptx) {
  const char *const directive = ".maxnreg ";
  const char *const found = std::strstr(static_cast<const char *>(ptx), directive);
  return found ? std::strtoul(found + std::strlen(directive), nullptr, 10) : 0;
}

} // namespace

extern "C" {

int cuInit(unsigned) {
  return is("no-device") ? NoDevice : Success;
}
int cuDriverGetVersion(int *version) {
  *version = driverVersion();
  return Success;
}
int cuGetErrorString(int status, const char **text) {
  *text = status == IllegalAddress ? "an illegal memory access was encountered" : "some error";
  return Success;
}
int cuDeviceGetCount(int *count) {
  *count = deviceCount();
  return Success;
}
int cuDeviceGet(int *device, int ordinal) {
  *device = ordinal;
  return ordinal < deviceCount() ? Success : InvalidValue;
}
int cuDeviceGetName(char *name, int size, int) {
  std::snprintf(name, std::size_t(size), "Fake 1000");
  return Success;
}
int cuDeviceGetAttribute(int *value, int attribute, int) {
  *value = attribute == 16   ? int(multiprocessors)
           : attribute == 39 ? 1024
           : attribute == 75 ? 7
           : attribute == 81 ? 102400
           : attribute == 97 ? mostSharedBytes()
                             : 5;
  return Success;
}
int cuDevicePrimaryCtxRetain(void **context, int device) {
  *context = &devices[device];
  return Success;
}
int cuDevicePrimaryCtxRelease_v2(int device) {
  for (auto &one : devices[device].allocations)
    std::free(reinterpret_cast<void *>(one.first));
  devices[device].allocations.clear();
  return Success;
}
int cuCtxSetCurrent(void *context) {
  current = static_cast<Device *>(context);
  return Success;
}
int cuMemGetInfo_v2(std::size_t *free, std::size_t *total) {
  *total = totalMemory();
  *free = *total - current->allocated;
  return Success;
}
int cuMemAlloc_v2(std::uint64_t *address, std::size_t bytes) {
  const std::lock_guard<std::mutex> lock(current->mutex);
  if (bytes > totalMemory() - current->allocated)
    return OutOfMemory;
  const std::size_t rounded = (bytes + 255) / 256 * 256;
  void *memory = std::aligned_alloc(256, rounded);
  std::memset(memory, 0xa5, rounded);
  *address = reinterpret_cast<std::uintptr_t>(memory);
  current->allocations[*address] = bytes;
  current->allocated += bytes;
  return Success;
}
int cuMemFree_v2(std::uint64_t address) {
  const std::lock_guard<std::mutex> lock(current->mutex);
  const auto found = current->allocations.find(address);
  if (found == current->allocations.end())
    return InvalidValue;
  current->allocated -= found->second;
  current->allocations.erase(found);
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
  copies.bytes += bytes;
  return Success;
}
int cuMemcpyDtoH_v2(void *to, std::uint64_t from, std::size_t bytes) {
  if (!isAllocated(reinterpret_cast<void *>(from), bytes))
    return InvalidValue;
  std::memcpy(to, reinterpret_cast<void *>(from), bytes);
  copies.bytes += bytes;
  return Success;
}
int cuMemcpyDtoD_v2(std::uint64_t to, std::uint64_t from, std::size_t bytes) {
  const bool isVariable = reinterpret_cast<void *>(to) == &current->launch;
  if (!(isVariable ? bytes == sizeof current->launch
                   : isAllocated(reinterpret_cast<void *>(to), bytes)) ||
      !isAllocated(reinterpret_cast<void *>(from), bytes))
    return InvalidValue;
  std::memcpy(reinterpret_cast<void *>(to), reinterpret_cast<void *>(from), bytes);
  return Success;
}
int cuStreamCreate(void **stream, unsigned flags) {
  *stream = current;
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
  const std::map<int, void *> given = optionsOf(count, options, values);
  if (given.count(threadsOfCompiler) != (driverVersion() >= 13000)) // older ones do not know it
    return InvalidValue;
  if (given.count(maxRegisters) &&
      reinterpret_cast<std::uintptr_t>(given.at(maxRegisters)) < registersStated(image) &&
      !given.count(overrideDirectives))
    return InvalidValue; // the kernel would have more
  if (is("other-gpu")) {
    std::strcpy(static_cast<char *>(given.at(errorLog)), "SM version 120 is needed");
    return NoBinaryForGpu;
  }
  std::strcpy(static_cast<char *>(given.at(infoLog)),
              "ptxas info    : Function properties for rtsl_render\n"
              "    16 bytes stack frame, 8 bytes spill stores, 12 bytes spill loads\n");
  const char *code = static_cast<const char *>(image);
  *module = current;
  current->code += code;
  if (!hasKernel(code, "rtsl_build_")) {
    current->waveStates = 0;
    const std::string state = std::string(entry) + "rtsl_wave_state_";
    for (const char *at = code; (at = std::strstr(at, state.c_str())); at += state.size())
      ++current->waveStates;
    const bool isWavefront = hasKernel(code, "rtsl_wave_begin(");
    const int organisations =
        isWavefront + hasKernel(code, "rtsl_render(") + hasKernel(code, "rtsl_persistent(") +
        hasKernel(code, "rtsl_render_samples(") + hasKernel(code, "rtsl_render_pixels(");
    return hasKernel(code, "rtsl_sum(") && organisations == 1 ? Success : InvalidValue;
  }
  for (std::size_t i = programKernels; i < std::size(kernels); ++i)
    if (!hasKernel(code, (std::string(kernels[i]) + "(").c_str()))
      return InvalidValue;
  return Success;
}
int cuModuleUnload(void *) {
  return Success;
}
int cuModuleGetFunction(void **function, void *, const char *name) {
  if (!hasKernel(current->code.c_str(), (std::string(name) + "(").c_str()))
    return NotFound;
  for (const char *const &kernel : kernels)
    if (std::strcmp(name, kernel) == 0 ||
        (kernel[std::strlen(kernel) - 1] == '_' && std::strstr(name, kernel) == name)) {
      *function = const_cast<void *>(static_cast<const void *>(&kernel));
      return Success;
    }
  return InvalidValue;
}
int cuModuleGetGlobal_v2(std::uint64_t *address, std::size_t *bytes, void *, const char *name) {
  if (std::strcmp(name, "rtsl_launch") != 0 ||
      current->code.find(".const .align 8 .b8 rtsl_launch[") == std::string::npos)
    return NotFound;
  *address = reinterpret_cast<std::uint64_t>(&current->launch);
  return Success;
}
int cuFuncGetAttribute(int *value, int, void *) {
  *value = 40;
  return Success;
}
int cuFuncSetAttribute(void *, int attribute, int value) {
  current->sharedBytes = std::uint32_t(value);
  return attribute == 8 && value <= mostSharedBytes() ? Success : InvalidValue;
}
int cuOccupancyMaxActiveBlocksPerMultiprocessor(int *blocks, void *, int, std::size_t) {
  *blocks = blocksAtOnce;
  return Success;
}

int cuLaunchKernel(void *function, unsigned blocks, unsigned, unsigned, unsigned threads, unsigned,
                   unsigned, unsigned sharedBytes, void *, void **arguments, void **) {
  if (is("fault"))
    return Success; // it shows when the kernel is waited for
  const auto kernel = std::size_t(static_cast<const char *const *>(function) - kernels);
  if (kernel >= programKernels) {
    const auto number = [&](int i) { return *static_cast<const std::uint32_t *>(arguments[i]); };
    const std::uint32_t count = number(1);
    if (blocks != (count + threads - 1) / threads)
      return InvalidValue;
    return buildStep(kernel - programKernels,
                     **static_cast<const rtsl::device::build::TreeBuild **>(arguments[0]), count,
                     number(2), number(3), number(4));
  }
  const RtslJob &job = *static_cast<const RtslJob *>(arguments[0]);
  const std::string name = kernels[kernel];
  if (name == "rtsl_render")
    return renderByLanes(job, blocks, threads, std::uint64_t(blocks) * threads * job.laneBytes);
  if (name == "rtsl_render_samples" || name == "rtsl_render_pixels")
    return renderByThreads(job, name == "rtsl_render_pixels" && job.mayTakePixels, blocks, threads);
  if (name == "rtsl_persistent")
    return sharedBytes == current->sharedBytes ? persist(job, blocks, threads) : InvalidValue;
  if (name == "rtsl_sum")
    return sum(job);
  if (name == "rtsl_wave_begin")
    return beginWave(job);
  const std::uint32_t turn = *static_cast<const std::uint32_t *>(arguments[1]);
  if (name == "rtsl_wave_trace")
    return traceWave(job, turn);
  return name == "rtsl_wave_sample" ? sampleWave(job, turn) : IllegalAddress;
}
int cuCtxSynchronize() {
  if (is("uneven") && current == &devices[slowDevice])
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  RtslStatus *const endless = current->endlessStatus;
  while (endless && !__atomic_load_n(&endless->stop, __ATOMIC_RELAXED))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return is("fault") ? IllegalAddress : Success;
}
int cuEventCreate(void **event, unsigned) {
  *event = current; // anything but null
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
