// One kernel a function for nvptx64: the functions on many arguments. Compiled by clang without
// CUDA.
#include "math/Elementary.h"

namespace {

unsigned threadNumber() {
  return __nvvm_read_ptx_sreg_ctaid_x() * __nvvm_read_ptx_sreg_ntid_x() +
         __nvvm_read_ptx_sreg_tid_x();
}

} // namespace

#define KERNEL extern "C" __attribute__((nvptx_kernel)) void

/// results[i] = f(the float with the bits firstBits + i); the grid has as many threads as results.
#define UNARY(name)                                                                                \
  KERNEL evaluate_##name(unsigned firstBits, float *results) {                                     \
    unsigned i = threadNumber();                                                                   \
    results[i] = rtsl::device::name(rtsl::device::detail::floatOf(firstBits + i));                 \
  }

/// results[i] = f(arguments[2 i], arguments[2 i + 1]).
#define BINARY(name)                                                                               \
  KERNEL evaluate_##name(const float *arguments, float *results) {                                 \
    unsigned i = threadNumber();                                                                   \
    results[i] = rtsl::device::name(arguments[2 * i], arguments[2 * i + 1]);                       \
  }

UNARY(sin)
UNARY(cos)
UNARY(tan)
UNARY(sinpi)
UNARY(cospi)
UNARY(asin)
UNARY(acos)
UNARY(atan)
UNARY(sinh)
UNARY(cosh)
UNARY(tanh)
UNARY(asinh)
UNARY(acosh)
UNARY(atanh)
UNARY(exp)
UNARY(exp2)
UNARY(expm1)
UNARY(log)
UNARY(log2)
UNARY(log1p)
UNARY(inversesqrt)
UNARY(sqrt)
BINARY(pow)
BINARY(atan2)
