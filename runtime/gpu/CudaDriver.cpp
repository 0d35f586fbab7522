#include "runtime/gpu/CudaDriver.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <dlfcn.h>
#include <string>

namespace rtsl::runtime::cuda {

/// CUDA 10.0: the first that supports PTX 6.3, which sm_75 needs.
static constexpr int oldestDriver = 10000;
/// CUDA 13.0: the first that is known to accept JitOption::ThreadsOfCompiler.
static constexpr int driverWithThreads = 13000;

static std::string versionText(int number) {
  return fmt::format("{}.{}", number / 1000, number % 1000 / 10);
}

template <typename Function>
void Driver::find(Function &function, const char *name) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function)
    throw Error(message::driverLacks(name, versionText(oldestDriver)));
}

void Driver::open() {
  library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw Error(message::noDriver(dlerror()));
  find(init, "cuInit");
  find(driverGetVersion, "cuDriverGetVersion");
  find(getErrorString, "cuGetErrorString");
  find(deviceGetCount, "cuDeviceGetCount");
  find(deviceGet, "cuDeviceGet");
  find(deviceGetName, "cuDeviceGetName");
  find(deviceGetAttribute, "cuDeviceGetAttribute");
  find(primaryContextRetain, "cuDevicePrimaryCtxRetain");
  find(primaryContextRelease, "cuDevicePrimaryCtxRelease_v2");
  find(contextSetCurrent, "cuCtxSetCurrent");
  find(memoryGetInfo, "cuMemGetInfo_v2");
  find(memoryAllocate, "cuMemAlloc_v2");
  find(memoryFree, "cuMemFree_v2");
  find(memorySet, "cuMemsetD8_v2");
  find(hostAllocate, "cuMemAllocHost_v2");
  find(hostFree, "cuMemFreeHost");
  find(copyToDevice, "cuMemcpyHtoD_v2");
  find(copyToHost, "cuMemcpyDtoH_v2");
  find(copyWithin, "cuMemcpyDtoD_v2");
  find(copyToDeviceAsync, "cuMemcpyHtoDAsync_v2");
  find(copyToHostAsync, "cuMemcpyDtoHAsync_v2");
  find(streamCreate, "cuStreamCreate");
  find(streamDestroy, "cuStreamDestroy_v2");
  find(streamSynchronize, "cuStreamSynchronize");
  find(moduleLoad, "cuModuleLoadDataEx");
  find(moduleUnload, "cuModuleUnload");
  find(moduleGetFunction, "cuModuleGetFunction");
  find(moduleGetGlobal, "cuModuleGetGlobal_v2");
  find(functionGetAttribute, "cuFuncGetAttribute");
  find(functionSetAttribute, "cuFuncSetAttribute");
  find(occupancy, "cuOccupancyMaxActiveBlocksPerMultiprocessor");
  find(launch, "cuLaunchKernel");
  find(synchronize, "cuCtxSynchronize");
  find(eventCreate, "cuEventCreate");
  find(eventDestroy, "cuEventDestroy_v2");
  find(eventRecord, "cuEventRecord");
  find(eventElapsedTime, "cuEventElapsedTime");

  check(driverGetVersion(&version), "cuDriverGetVersion");
  if (version < oldestDriver)
    throw Error(message::driverTooOld(versionText(version), versionText(oldestDriver)));
  const int status = init(0);
  if (status == NoDevice ||
      (status == Success && (deviceGetCount(&deviceCount) != Success || deviceCount == 0)))
    throw Error(message::noGpu());
  check(status, "cuInit");
}

Driver::Driver() {
  try {
    open();
  } catch (...) {
    if (library)
      dlclose(library);
    throw;
  }
}

Driver::~Driver() {
  dlclose(library);
}

bool Driver::compilesInThreads() const {
  return version >= driverWithThreads;
}

void Driver::check(int status, const char *call) const {
  if (status == Success)
    return;
  const char *text = nullptr;
  if (getErrorString(status, &text) != Success || !text)
    text = "unknown error";
  throw Error(status == OutOfMemory ? message::gpuOutOfMemory(call, text, status)
                                    : message::gpuFails(call, text, status));
}

} // namespace rtsl::runtime::cuda
