// The approximations of Fast.h under C names, for compiled shaders to call.
#include "math/Fast.h"

extern "C" {

#define RTSL_FAST_UNARY(name)                                                                      \
  [[gnu::const]] float rtsl_fast_##name(float x) {                                                 \
    return rtsl::device::fast::name(x);                                                            \
  }
#define RTSL_FAST_BINARY(name)                                                                     \
  [[gnu::const]] float rtsl_fast_##name(float x, float y) {                                        \
    return rtsl::device::fast::name(x, y);                                                         \
  }
#include "math/FastFunctions.def"

} // extern "C"
