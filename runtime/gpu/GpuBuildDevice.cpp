#include "runtime/gpu/GpuBuildDevice.h"

#include "support/Error.h"

// The PTX, which ends in a zero.
extern "C" const char rtslBuildKernelsBegin[];

namespace rtsl::runtime {

GpuBuildDevice::~GpuBuildDevice() {
  try {
    device.use();
    if (code)
      device.unload(*code);
  } catch (const Error &) { // after a failure of the device
  }
}

void GpuBuildDevice::load() {
  code = device.compile(rtslBuildKernelsBegin);
  for (const char *const name : {
#define RTSL_BUILD_STEP(name, call) "rtsl_build_" #name,
#include "runtime/device/trees/Steps.def"
       })
    kernels.push_back(device.kernel(name, *code));
}

BuildDevice::Address GpuBuildDevice::allocate(std::size_t bytes, const char *what) {
  return device.allocate(bytes, what);
}

void GpuBuildDevice::release(Address address) {
  try {
    device.use(); // the thread may be another one than that which has built the trees
    device.release(address);
  } catch (const Error &) { // likewise
  }
}

void GpuBuildDevice::upload(Address to, const void *from, std::size_t bytes) {
  device.upload(to, from, bytes);
}

void GpuBuildDevice::download(void *to, Address from, std::size_t bytes) {
  device.download(to, from, bytes);
}

void GpuBuildDevice::copy(Address to, Address from, std::size_t bytes) {
  device.copy(to, from, bytes);
}

void GpuBuildDevice::run(BuildStep step, Address build, std::uint32_t count, std::uint32_t a,
                         std::uint32_t b, std::uint32_t c) {
  constexpr unsigned threadsPerBlock = 128;
  if (count == 0)
    return;
  if (!code)
    load();
  void *arguments[] = {&build, &count, &a, &b, &c};
  device.launchLater(kernels[std::size_t(step)], (count - 1) / threadsPerBlock + 1, threadsPerBlock,
                     arguments);
}

void GpuBuildDevice::wait() {
  device.wait();
}

} // namespace rtsl::runtime
