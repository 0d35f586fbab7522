//===- FloatingPoint.h - strict: each operation rounds once ---------------===//
//
// Both compilers fuse a*b + c by themselves where the target can, which changes results. They are
// told not to before any other code is seen, GLM's included. `#pragma STDC FP_CONTRACT` would say
// the same, but g++ does not know it. g++ also learns that nobody asks for floating-point exceptions:
// then it may choose between two results instead of jumping, which changes none.
//
// A file that defines RTSL_FAST (--fp=fast, docs/fast.md) lets them. RTSL_ARITHMETIC is a namespace
// that keeps the inline functions of both kinds of file apart where one program has both.
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
#define RTSL_ARITHMETIC fast
#if defined(__clang__)
#pragma clang fp contract(fast)
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=fast", "no-trapping-math")
#endif
#else
#define RTSL_ARITHMETIC strict
#if defined(__clang__)
#pragma clang fp contract(off)
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off", "no-trapping-math")
#endif
#endif

#include <glm/glm.hpp>
