//===- MachineCode.h - what a compilation needs code generators for -------===//
//
// LLVM's code generators make a program large and slow to start, and the stages up to C++ output do
// not need them. So the compiler is two libraries: rtslCompiler, which does without them, and
// rtslMachineCode, in the folder `machine`, which implements this interface. `rtslc` is linked
// without the second.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"

#include <string>

namespace mlir {
class MLIRContext;
} // namespace mlir

namespace rtsl::driver {

struct Compilation;

struct MachineCode {
  /// Adds to a context, before it has IR, what translating to LLVM IR needs.
  void (*prepare)(mlir::MLIRContext &context);

  /// Makes the objects of a linked scene: compiles their constructors and runs them.
  runtime::SceneFacts (*makeObjects)(const Compilation &);

  // Stages.
  bool (*reachLlvm)(Compilation &);
  std::string (*printLlvm)(const Compilation &);
  bool (*reachPtx)(Compilation &);
};

/// The implementation by LLVM, defined in rtslMachineCode.
const MachineCode &machineCode();

} // namespace rtsl::driver
