//===- FloatingPoint.h - strict: each operation rounds once ---------------===//
//
// By default both compilers fuse a*b + c if the target can, which changes results. This is switched
// off before any other code, including GLM's. `#pragma STDC FP_CONTRACT` would have the same
// effect, but g++ does not support it. g++ is also told that floating-point exceptions are not
// tested: then it may use a select instead of a branch, which does not change results.
//
// A file that defines RTSL_FAST (--fp=fast, docs/fast.md) permits fusing. One that defines
// RTSL_UNCHECKED (--unchecked) does not clamp indices (Types.h). RTSL_VARIANT is a namespace that
// separates the inline functions of these kinds of files within one program.
//
//===----------------------------------------------------------------------===//
#pragma once

#ifdef __FAST_MATH__
#error "shaders need IEEE arithmetic: compile them without -ffast-math"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0
#error "shaders need float arithmetic that rounds to float: compile for SSE2 or better"
#endif

#if defined(RTSL_FAST)
#if defined(__clang__)
#pragma clang fp contract(fast)
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=fast", "no-trapping-math")
#endif
#else
#if defined(__clang__)
#pragma clang fp contract(off)
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off", "no-trapping-math")
#endif
#endif

#if defined(RTSL_FAST) && defined(RTSL_UNCHECKED)
#define RTSL_VARIANT fastUnchecked
#elif defined(RTSL_FAST)
#define RTSL_VARIANT fast
#elif defined(RTSL_UNCHECKED)
#define RTSL_VARIANT strictUnchecked
#else
#define RTSL_VARIANT strict
#endif

#include <glm/glm.hpp>
