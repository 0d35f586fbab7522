// The approximations of Fast.h under C names, for compiled shaders to call.
#include "runtime/device/math/Fast.h"

#define RTSL_EXPORT_UNARY(name)                                                                    \
  float rtsl_fast_##name(float x) { return rtsl::device::fast::name(x); }
#define RTSL_EXPORT_BINARY(name)                                                                   \
  float rtsl_fast_##name(float x, float y) { return rtsl::device::fast::name(x, y); }

extern "C" {

RTSL_EXPORT_UNARY(sin)
RTSL_EXPORT_UNARY(cos)
RTSL_EXPORT_UNARY(tan)
RTSL_EXPORT_UNARY(asin)
RTSL_EXPORT_UNARY(acos)
RTSL_EXPORT_UNARY(atan)
RTSL_EXPORT_UNARY(exp)
RTSL_EXPORT_UNARY(exp2)
RTSL_EXPORT_UNARY(log)
RTSL_EXPORT_UNARY(log2)
RTSL_EXPORT_UNARY(inversesqrt)
RTSL_EXPORT_BINARY(pow)
RTSL_EXPORT_BINARY(atan2) // (y, x)

} // extern "C"
