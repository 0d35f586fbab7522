//===- RtslDialect.h - the `rtsl` dialect itself --------------------------===//
#ifndef RTSL_CODEGEN_IR_RTSL_DIALECT_H // not `#pragma once`: see Precompiled.h
#define RTSL_CODEGEN_IR_RTSL_DIALECT_H

#include "mlir/IR/Dialect.h"

#include "codegen/ir/dialect/RtslDialect.h.inc"

#endif
