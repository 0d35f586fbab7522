//===- Compiler.cpp - the compiler as a library ---------------------------===//
#include "codegen/driver/Compiler.h"

#include "codegen/emit/Jit.h"
#include "codegen/emit/LlvmModule.h"
#include "codegen/link/Link.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/Pipeline.h"
#include "runtime/DeviceBitcode.h"
#include "runtime/HostTraversal.h"
