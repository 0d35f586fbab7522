//===- Precompiled.h - the headers that all of codegen includes -----------===//
//
// Parsing MLIR's headers takes longer than compiling most of our files, so they are parsed once.
// Every file still includes what it uses; none may rely on this header.
//
// Our own headers below have include guards: GCC identifies files with `#pragma once` by their
// modification time, and a precompiled header from ccache may be older than the files of this
// folder.
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
