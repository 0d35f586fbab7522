//===- Rtsl.h - the whole of the `rtsl` dialect ---------------------------===//
//
// For code that builds or reads IR. RtslTypes.h alone is enough for code that looks at types.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/RtslDialect.h"
#include "codegen/ir/RtslOps.h"
#include "codegen/ir/RtslTypes.h"
