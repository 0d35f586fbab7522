#include "CudaDriver.h"

#include <dlfcn.h>

namespace rtsl::elementary {

template <typename Function>
Function CudaModule::symbol(const char *name) {
  void *address = dlsym(library, name);
  if (address == nullptr)
    throw NoDevice(std::string("the CUDA driver lacks ") + name);
  return reinterpret_cast<Function>(address);
}

void CudaModule::check(int status, const char *call) {
  if (status != 0)
    throw std::runtime_error(std::string(call) + " failed with status " + std::to_string(status));
}

CudaModule::CudaModule(const std::string &ptx) : library(dlopen("libcuda.so.1", RTLD_NOW)) {
  if (library == nullptr)
    throw NoDevice("there is no CUDA driver");
  int device = 0;
  void *context = nullptr;
  if (symbol<int (*)(unsigned)>("cuInit")(0) != 0 ||
      symbol<int (*)(int *, int)>("cuDeviceGet")(&device, 0) != 0)
    throw NoDevice("there is no CUDA device");
  check(symbol<int (*)(void **, unsigned, int)>("cuCtxCreate_v2")(&context, 0, device),
        "cuCtxCreate");
  check(symbol<int (*)(void **, const void *)>("cuModuleLoadData")(&module, ptx.c_str()),
        "cuModuleLoadData");
}

CudaModule::Address CudaModule::allocate(std::size_t bytes) {
  Address address = 0;
  check(symbol<int (*)(Address *, std::size_t)>("cuMemAlloc_v2")(&address, bytes), "cuMemAlloc");
  return address;
}

void CudaModule::upload(Address to, const void *from, std::size_t bytes) {
  check(symbol<int (*)(Address, const void *, std::size_t)>("cuMemcpyHtoD_v2")(to, from, bytes),
        "cuMemcpyHtoD");
}

void CudaModule::download(void *to, Address from, std::size_t bytes) {
  check(symbol<int (*)(void *, Address, std::size_t)>("cuMemcpyDtoH_v2")(to, from, bytes),
        "cuMemcpyDtoH");
}

void CudaModule::launch(const std::string &kernel, void *firstArgument, Address results,
                        unsigned blocks, unsigned threadsPerBlock) {
  void *function = nullptr;
  check(symbol<int (*)(void **, void *, const char *)>("cuModuleGetFunction")(&function, module,
                                                                              kernel.c_str()),
        "cuModuleGetFunction");
  void *arguments[] = {firstArgument, &results};
  using Launch = int (*)(void *, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned,
                         unsigned, void *, void **, void **);
  check(symbol<Launch>("cuLaunchKernel")(function, blocks, 1, 1, threadsPerBlock, 1, 1, 0, nullptr,
                                         arguments, nullptr),
        "cuLaunchKernel");
  check(symbol<int (*)()>("cuCtxSynchronize")(), "cuCtxSynchronize");
}

} // namespace rtsl::elementary
