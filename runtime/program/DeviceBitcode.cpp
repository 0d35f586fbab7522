#include "runtime/program/DeviceBitcode.h"

#include <cstddef>

// Defined by the generated files that contain the bitcode.
#define RTSL_EMBEDDED(function, symbol)                                                            \
  extern "C" const char symbol##Begin[];                                                           \
  extern "C" const char symbol##End[];                                                             \
  std::string_view rtsl::runtime::function() {                                                     \
    return {symbol##Begin, std::size_t(symbol##End - symbol##Begin)};                              \
  }

RTSL_EMBEDDED(deviceBitcode, rtslDevice_host)
RTSL_EMBEDDED(gpuDeviceBitcode, rtslDevice_gpu)
RTSL_EMBEDDED(listTraversalBitcode, rtslListTraversal)
RTSL_EMBEDDED(megakernelBitcode, rtslMegakernel_host)
RTSL_EMBEDDED(gpuMegakernelBitcode, rtslMegakernel_gpu)
RTSL_EMBEDDED(wavefrontBitcode, rtslWavefront_host)
RTSL_EMBEDDED(gpuWavefrontBitcode, rtslWavefront_gpu)
RTSL_EMBEDDED(persistentBitcode, rtslPersistent_host)
RTSL_EMBEDDED(gpuPersistentBitcode, rtslPersistent_gpu)
RTSL_EMBEDDED(hostMemoryBitcode, rtslHostMemory)
