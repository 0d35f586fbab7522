//===- LlvmSteps.h - the steps to LLVM IR, PTX and machine code -----------===//
//
// They follow those of driver/Steps.h, and fail like them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "codegen/emit/LlvmModule.h"
#include "codegen/emit/ObjectCode.h"
#include "support/Error.h"

#include "mlir/IR/BuiltinOps.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/Error.h"
#include "llvm/Target/TargetMachine.h"

#include <functional>
#include <memory>
#include <optional>
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

struct Compilation;

/// LLVM IR before code generation.
struct LlvmCode {
  LlvmCode() = default;
  LlvmCode(LlvmCode &&) = default;
  std::unique_ptr<llvm::LLVMContext> context = std::make_unique<llvm::LLVMContext>();
  std::unique_ptr<llvm::TargetMachine> machine;
  std::unique_ptr<llvm::Module> module;
  codegen::MachineOptions options;
  std::vector<std::string> kept; // functions that are kept although nothing calls them
  // Of a self-contained program:
  Organisation organisation = Organisation::Megakernel;
  bool isWhole = false;           // it has no states
  bool hasThreadOfSample = false; // a GPU has a thread for each sample, if not for each pixel
  bool takesPixels = false;       // lanes render whole pixels where a job allows it
  bool testsAllListed = false;    // rays test all primitives of a list
  bool knowsLights = false;       // states of a wavefront may look for lights first (KnownLights.h)
  std::uint32_t registers = 0;    // that a thread of a kernel may have, on a GPU
};

/// Level 2 as LLVM IR, not linked with device code yet. With `numberPlaces`, numbers are checked,
/// and their source locations are added there (CheckNumbers.h).
LlvmCode translate(mlir::ModuleOp ir, const codegen::MachineOptions &options,
                   std::vector<Place> *numberPlaces = nullptr);

/// Decides rtsl_knows_lights.
void decideKnownLights(LlvmCode &code, const CompileOptions &options,
                       const runtime::Program &program);

/// Is the program bound to a scene whose few primitives are tested one after the other?
bool hasList(const LlvmCode &code);

/// Defines constants with which the device code omits unused parts.
void defineFacts(LlvmCode &code, const CompileOptions &options, const runtime::Program &program);

/// Of a self-contained program whose organisation is known.
void decideWhetherLanesTakePixels(LlvmCode &code, const CompileOptions &options,
                                  const runtime::Program &program);

/// Adds the constants rtsl_is_intersect_cheap and rtsl_tests_all_listed: how rays of a megakernel
/// test the primitives of a list.
void decideListedTests(LlvmCode &code, const CompileOptions &options,
                       const runtime::Program &program);

/// The bitcode of runtime/device for a GPU's program, on a GPU or on the CPU.
const std::vector<std::string_view> &megakernelCode(bool forGpu);

/// The states of a linked program as a self-contained program
/// (runtime/device/organisations/Megakernel.h), before optimisation: for a GPU, or for the CPU.
LlvmCode megakernel(mlir::ModuleOp ir, const CompileOptions &options,
                    const runtime::Program &program, bool forGpu);

/// The same for the GPU of a compilation that has reached it: without states if it needs none.
/// Consumes `whole`.
LlvmCode gpuKernel(Compilation &compilation);

/// The functions that such a program exports on the CPU: the size of a lane, and what runs it.
const std::vector<std::string> &
hostEntries(std::optional<Organisation> organisation = std::nullopt);

/// To be called before linking with the device code of an organisation that keeps samples in
/// records, and after it.
void beginRecords(LlvmCode &code, const runtime::Program &program);
void endRecords(LlvmCode &code, const CompileOptions &options, const runtime::Program &program);

void linkDeviceCode(LlvmCode &code, llvm::ArrayRef<std::string_view> bitcodes,
                    std::vector<std::string> exports);

codegen::MachineOptions machineOptions(const CompileOptions &options, bool hostCpu);
codegen::MachineOptions gpuOptions(const CompileOptions &options);

void optimize(LlvmCode &code);

/// What `make` makes of code that is not optimised yet, and of nothing else: as
/// CompileOptions::codeCache has it, if `kind` has been made of the same code before.
std::string madeOf(const LlvmCode &code, const char *kind, const CompileOptions &options,
                   const std::function<std::string()> &make);

/// Optimises and compiles for the host.
codegen::ObjectCode toObject(LlvmCode code, const CompileOptions &options);

/// Optimises and prints. Sets the facts of a wavefront, if it is one.
std::string toPtx(LlvmCode code, const CompileOptions &options,
                  runtime::WaveFacts *facts = nullptr);

} // namespace rtsl::driver
