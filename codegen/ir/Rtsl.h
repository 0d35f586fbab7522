//===- Rtsl.h - the whole of the `rtsl` dialect ---------------------------===//
//
// For code that builds or reads IR. RtslTypes.h alone is enough for code that only examines types.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_CODEGEN_IR_RTSL_H // not `#pragma once`: see Precompiled.h
#define RTSL_CODEGEN_IR_RTSL_H

#include "codegen/ir/dialect/RtslDialect.h"
#include "codegen/ir/dialect/RtslOps.h"
#include "codegen/ir/dialect/RtslTypes.h"

#endif
