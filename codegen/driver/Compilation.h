//===- Compilation.h - a compilation in progress --------------------------===//
#pragma once

#include "codegen/driver/Stages.h"
#include "codegen/driver/Steps.h"
#include "codegen/link/ModuleFacts.h"
#include "codegen/lower/SourceTable.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/IR/OwningOpRef.h"

#include <memory>
#include <optional>
#include <string>

namespace rtsl::driver {

struct LlvmCode; // machine/LlvmSteps.h

/// The input of a compilation, its options, and its results so far: each stage adds to it, or
/// changes the IR.
struct Compilation {
  Compilation(const CompileInput &input, const CompileOptions &options, Diagnostics &diagnostics)
      : input(input), options(options), diagnostics(diagnostics) {}

  const CompileInput &input;
  const CompileOptions &options;
  Diagnostics &diagnostics;

  /// The objects of the scene, if they have been made before.
  const runtime::SceneFacts *facts = nullptr;
  Findings *findings = nullptr; // receives the items that linking and binding omit
  bool usesThreads = false;     // as many as CompileOptions::threads allows, if the scene is large
  bool explains = false;        // splitting reports the savings of each step

  /// Expressions stay the author's, for C++; receives them.
  SourceTable *source = nullptr;

  std::shared_ptr<mlir::MLIRContext> context;
  mlir::OwningOpRef<mlir::ModuleOp> ir;
  /// For a GPU: level 2 without states, if the program needs none.
  mlir::OwningOpRef<mlir::ModuleOp> whole;
  std::shared_ptr<runtime::Program> program = std::make_shared<runtime::Program>(); // of a scene
  std::optional<ModuleFacts> moduleFacts; // of a module without a scene
  SplitReport report;
  std::shared_ptr<LlvmCode> llvm;
  std::string text;

  /// Throws std::logic_error if the program was linked without it.
  const MachineCode &machineCode() const;

  bool isBound() const { return input.makeObjects || facts; }
};

// The pipeline in order, from a checked module. Each of these takes a compilation to its stage,
// through the previous ones (Stages.cpp). They return false if an error was reported; internal
// errors throw std::logic_error.

/// `ir`: level 1; for a scene it is linked, and bound if requested. May be called again.
bool reachIr(Compilation &compilation);
/// Level 1, linked without a scene, with `moduleFacts`.
bool reachModuleFacts(Compilation &compilation);
/// `ssa`: level 2. `trace` is a call.
bool reachSsa(Compilation &compilation);
/// `split`: level 2, with `report`. The states of functions that trace have names.
bool reachStates(Compilation &compilation);
/// `structured`: the same on level 1; for C++, only the states.
bool reachStructured(Compilation &compilation);
/// Level 2, like `split`, with numbers in place of names, and the functions that the machine calls.
bool reachMachine(Compilation &compilation);
/// The same for a GPU, which has no stack for recursion; and `whole`. In a bound program recursion
/// remains only if it is deep: that is an error.
bool reachGpuMachine(Compilation &compilation);

} // namespace rtsl::driver
