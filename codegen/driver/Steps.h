//===- Steps.h - the steps that stages consist of -------------------------===//
//
// From a checked module to IR, states, LLVM IR and PTX; Stages.cpp calls these steps in order. A
// step that fails is an internal error, because the program was checked before: it throws
// std::logic_error, for which `rtslc` has its own exit status.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "codegen/emit/LlvmModule.h"
#include "codegen/lower/SourceTable.h"
#include "codegen/passes/continuation/Split.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/IR/OwningOpRef.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/Error.h"
#include "llvm/Target/TargetMachine.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::driver {

/// Throws std::logic_error, or std::bad_alloc if the message reports a lack of memory.
[[noreturn]] void fail(const std::string &message);

template <typename T>
T take(llvm::Expected<T> expected) {
  if (!expected)
    fail(llvm::toString(expected.takeError()));
  return std::move(*expected);
}

std::unique_ptr<mlir::MLIRContext> makeContext();

/// From now on, passes and other work on functions may use several threads, if the module is large.
void allowThreads(mlir::ModuleOp ir, const CompileOptions &options);

/// Null if something is not supported, which is reported. `source`: LowerOptions::source.
mlir::OwningOpRef<mlir::ModuleOp> lowerModule(const typed::Module &module,
                                              const CompileOptions &options,
                                              const LinkRequest &request, SourceTable *source,
                                              Diagnostics &diagnostics, mlir::MLIRContext &context);

/// Runs `work` on the module.
void expectSuccess(mlir::ModuleOp ir, llvm::function_ref<bool()> work);

void run(mlir::ModuleOp ir, void (*build)(mlir::OpPassManager &));

SplitOptions splitOptions(const CompileOptions &options);

/// Level 1 to level 2, to states.
SplitReport runToStates(mlir::ModuleOp ir, const SplitOptions &options);

std::string print(mlir::ModuleOp ir);

/// LLVM IR before code generation.
struct LlvmCode {
  LlvmCode() = default;
  LlvmCode(LlvmCode &&) = default;
  std::unique_ptr<llvm::LLVMContext> context = std::make_unique<llvm::LLVMContext>();
  std::unique_ptr<llvm::TargetMachine> machine;
  std::unique_ptr<llvm::Module> module;
  codegen::MachineOptions options;
  std::vector<std::string> kept; // functions that are kept although nothing calls them
  Organisation organisation = Organisation::Megakernel; // of a self-contained program
};

/// Level 2 as LLVM IR, not linked with device code yet. With `numberPlaces`, numbers are checked,
/// and their source locations are added there (CheckNumbers.h).
LlvmCode translate(mlir::ModuleOp ir, const codegen::MachineOptions &options,
                   std::vector<Place> *numberPlaces = nullptr);

/// Is the program bound to a scene whose few primitives are tested one after the other?
bool hasList(const LlvmCode &code);

/// Defines constants with which the device code omits unused parts.
void defineFacts(LlvmCode &code, const CompileOptions &options, const runtime::Program &program);

/// The bitcode of runtime/device for a GPU's program, on a GPU or on the CPU.
const std::vector<std::string_view> &megakernelCode(bool forGpu);

/// The states of a linked program as a self-contained program
/// (runtime/device/engines/Megakernel.h), before optimisation: for a GPU, or for the CPU.
LlvmCode megakernel(mlir::ModuleOp ir, const CompileOptions &options,
                    const runtime::Program &program, bool forGpu);

/// The functions that such a program exports on the CPU: the size of a lane, and what runs it.
const std::vector<std::string> &
hostEntries(std::optional<Organisation> organisation = std::nullopt);

/// Before linking with the device code of a wavefront, and after it.
void beginWavefront(LlvmCode &code, const runtime::Program &program);
void endWavefront(LlvmCode &code, const runtime::Program &program);

void linkDeviceCode(LlvmCode &code, llvm::ArrayRef<std::string_view> bitcodes,
                    std::vector<std::string> exports);

codegen::MachineOptions machineOptions(const CompileOptions &options, bool hostCpu);
codegen::MachineOptions gpuOptions(const CompileOptions &options);

void optimize(LlvmCode &code);

/// Optimises and prints. Sets the facts of a wavefront, if it is one.
std::string toPtx(LlvmCode code, runtime::WaveFacts *facts = nullptr);

} // namespace rtsl::driver
