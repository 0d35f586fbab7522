//===- shader.h - the header of C++ code that rtslc generates -------------===//
//
// The one header of generated code: GLM's types, RTSL's built-in functions with their exactly
// defined results, the state of a ray, and the description of shaders for the runtime.
//
// Generated code includes it first, because it determines how floating point is compiled: each
// operation rounds once, and none are fused. So the results are bit-identical to those of the
// compiler's own machine code (docs/cpp-output.md).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/FloatingPoint.h" // must be first

#include "rtsl/shader/Calls.h"
#include "rtsl/shader/Common.h"
#include "rtsl/shader/Describe.h"
#include "rtsl/shader/Elementary.h"
#include "rtsl/shader/Geometry.h"
#include "rtsl/shader/Integers.h"
#include "rtsl/shader/Matrices.h"
#include "rtsl/shader/OutputBuffer.h"
#include "rtsl/shader/Packing.h"
#include "rtsl/shader/Payloads.h"
#include "rtsl/shader/Print.h"
#include "rtsl/shader/Rays.h"
#include "rtsl/shader/State.h"
#include "rtsl/shader/Types.h"
