//===- Steps.h - steps of splitting without options and results -----------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

namespace rtsl::continuation {

#define RTSL_PLAIN_STEP(function, pass, Meaning) void function(FuncOp);
#include "codegen/passes/continuation/common/Steps.def"

} // namespace rtsl::continuation
