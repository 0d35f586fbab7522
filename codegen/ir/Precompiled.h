//===- Precompiled.h - the headers that every part of codegen reads -------===//
//
// MLIR's headers take longer to read than most of our files take to compile, so they are read once.
// A file still includes what it uses; nothing may rely on this one.
//
// The headers of ours below have include guards: GCC compares what `#pragma once` marks by its time
// of change, and a precompiled header out of ccache may be older than the files of this folder.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/Pass/Pass.h"
