// The approximations of Fast.h under C names, for compiled shaders to call.
#include "runtime/device/math/Fast.h"

extern "C" {

#define RTSL_FAST_UNARY(name)                                                                      \
  float rtsl_fast_##name(float x) {                                                                \
    return rtsl::device::fast::name(x);                                                            \
  }
#define RTSL_FAST_BINARY(name)                                                                     \
  float rtsl_fast_##name(float x, float y) {                                                       \
    return rtsl::device::fast::name(x, y);                                                         \
  }
#include "runtime/device/math/FastFunctions.def"

} // extern "C"
