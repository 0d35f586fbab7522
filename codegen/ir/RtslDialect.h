//===- RtslDialect.h - the `rtsl` dialect itself --------------------------===//
#pragma once

#include "mlir/IR/Dialect.h"

#include "codegen/ir/RtslDialect.h.inc"
