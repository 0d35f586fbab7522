//===- shader.h - what C++ that rtslc wrote stands on ---------------------===//
//
// The one header of generated code: GLM's types, RTSL's built-in functions with their definite
// results, the state of a ray, and how shaders are described to the runtime.
//
// Generated code includes it before anything else, for it decides how floating point is compiled:
// each operation rounds once, and none are fused. With that, the same bits come out as from the
// compiler's own machine code (docs/cpp-output.md).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/FloatingPoint.h" // first

#include "rtsl/shader/Calls.h"
#include "rtsl/shader/Common.h"
#include "rtsl/shader/Describe.h"
#include "rtsl/shader/Elementary.h"
#include "rtsl/shader/Geometry.h"
#include "rtsl/shader/Integers.h"
#include "rtsl/shader/Matrices.h"
#include "rtsl/shader/Packing.h"
#include "rtsl/shader/Payloads.h"
#include "rtsl/shader/Print.h"
#include "rtsl/shader/Rays.h"
#include "rtsl/shader/State.h"
#include "rtsl/shader/Types.h"
