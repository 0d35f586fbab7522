//===- FloatingPoint.h - strict: each operation rounds once ---------------===//
//
// Both compilers fuse a*b + c by themselves where the target can, which changes results. They are
// told not to before any other code is seen, GLM's included. `#pragma STDC FP_CONTRACT` would say
// the same, but g++ does not know it. g++ also learns that nobody asks for floating-point
// exceptions: then it may choose between two results instead of jumping, which changes none.
//
// A file that defines RTSL_FAST (--fp=fast, docs/fast.md) lets them. One that defines
// RTSL_UNCHECKED (--unchecked) trusts its indices (Types.h). RTSL_VARIANT is a namespace that keeps
// the inline functions of these kinds of file apart where one program has several.
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
