// Correctly rounded elementary functions in binary32, one source for the host and for nvptx64.
//
// Every function of one argument returns the float nearest to the exact result: tested for all 2^32
// arguments against MPFR. pow and atan2 have an error bound that decides whether their rounding is
// certain; otherwise they fall back to double-double. docs/elementary-functions.md has the method,
// the bounds and the figures.
//
// NaN results are always 0x7fc00000. Signed zeros and infinities are as in C99; domain errors give
// NaN. There is no global state: no errno, no rounding mode but round-to-nearest, no flush to zero.
//
// The files, their functions, and what these use of kernels/:
//
//     Trigonometric.h         sin cos tan            ArgumentReduction.h
//     TrigonometricOfPi.h     sinpi cospi            Trigonometric.h
//     InverseTrigonometric.h  asin acos atan         ArcTangentKernel.h
//     ArcTangent2.h           atan2                  ArcTangentKernel.h, DoubleDoubleFunctions.h
//     Exponential.h           exp exp2 expm1         ExponentialKernel.h
//     Hyperbolic.h            sinh cosh tanh         ExponentialKernel.h
//     Logarithm.h             log log2 log1p         LogarithmKernel.h
//     InverseHyperbolic.h     asinh acosh atanh      LogarithmKernel.h
//     Power.h                 pow                    both kernels, DoubleDoubleFunctions.h
//     PowerLanes.h            pow of four lanes      Power.h, DoubleLanes.h (host only, apart)
//     InverseSquareRoot.h     inversesqrt sqrt
//
// Fast.h has approximations for --fp=fast.
#pragma once

#include "math/ArcTangent2.h"
#include "math/Exponential.h"
#include "math/Hyperbolic.h"
#include "math/InverseHyperbolic.h"
#include "math/InverseSquareRoot.h"
#include "math/InverseTrigonometric.h"
#include "math/Logarithm.h"
#include "math/Power.h"
#include "math/Trigonometric.h"
#include "math/TrigonometricOfPi.h"
