//===- Compilation.h - a program on its way through the stages ------------===//
#pragma once

#include "codegen/driver/Stages.h"
#include "codegen/driver/Steps.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/IR/OwningOpRef.h"

#include <memory>
#include <optional>
#include <string>

namespace rtsl::driver {

/// What a compilation begins with, how it goes on, and what has been made so far: each stage adds
/// to it, or changes the IR.
struct Compilation {
  Compilation(const CompileInput &input, const CompileOptions &options, Diagnostics &diagnostics)
      : input(input), options(options), diagnostics(diagnostics) {}

  const CompileInput &input;
  const CompileOptions &options;
  Diagnostics &diagnostics;

  /// The objects of the scene, if they have been made before: none are made.
  const runtime::SceneFacts *facts = nullptr;
  Findings *findings = nullptr; // gets what linking and binding leave out
  bool usesThreads = false;     // as many as CompileOptions::threads allows, if the scene is large
  bool explains = false;        // splitting notes what each of its steps saves

  std::unique_ptr<mlir::MLIRContext> context;
  mlir::OwningOpRef<mlir::ModuleOp> ir;
  std::shared_ptr<runtime::Program> program = std::make_shared<runtime::Program>(); // of a scene
  SplitReport report;
  std::optional<LlvmCode> llvm;
  std::string text;

  bool isBound() const { return input.makeObjects || facts; }
};

// Each of these takes a compilation to its stage, by way of those before it. They return false if
// something is wrong, which was reported; mistakes of ours throw std::logic_error.

/// `ir`: level 1, of a scene linked, and bound if it is to be. May be called again.
bool reachIr(Compilation &compilation);
/// `ssa`: level 2. `trace` is a call.
bool reachSsa(Compilation &compilation);
/// `split`: level 2, with `report`. The states of what traces have names.
bool reachStates(Compilation &compilation);
/// The same with numbers in place of names, and what the machine calls.
bool reachMachine(Compilation &compilation);
/// `llvm`: optimised, of a scene for Target::HostMegakernel.
bool reachLlvm(Compilation &compilation);

/// Level 1 of a bound program. A GPU has no stack for recursion, which such a program has only if
/// it is deep: false, with a message, if there is some.
bool requireNoRecursion(Compilation &compilation);

} // namespace rtsl::driver
