//===- LlvmModule.h - LLVM IR: translation, linking, optimisation ---------===//
//
// The steps from the LLVM dialect to optimised LLVM IR, each a function:
//
//   auto machine = createTargetMachine(options);
//   auto module = translateToLlvm(ir, context, *machine);
//   linkDeviceCode(*module, runtime::deviceBitcode(), exports);
//   optimize(*module, *machine, options);
//
// Afterwards printLlvm prints it, Jit.h runs it, and Ptx.h prints it as PTX.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/FloatingPoint.h"

#include "llvm/ADT/ArrayRef.h"
#include "llvm/Support/Error.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace llvm {
class LLVMContext;
class Module;
class TargetMachine;
} // namespace llvm
namespace mlir {
class DialectRegistry;
class ModuleOp;
} // namespace mlir

namespace rtsl::codegen {

struct MachineOptions {
  unsigned optimization = 2; // 0 to 3, as clang's -O
  /// Code for the host processor, rather than for every x86-64-v3. Results are the same.
  bool hostCpu = false;
  /// Code for an NVIDIA GPU, rather than for the host: "sm_75" and the like. Empty: the host.
  std::string gpu;
  /// A megakernel: the rays of a lane are local variables, so calls that take their addresses are
  /// inlined (JoinCalls.h).
  bool isMegakernel = false;
  /// The mode of shader code. Device code is always strict.
  FloatingPoint floatingPoint = FloatingPoint::Strict;
};

/// Registers the translation from MLIR; call before the context is made, or append the registry to
/// it.
void registerLlvmTranslation(mlir::DialectRegistry &registry);

/// No operations are fused unless the program fuses them, or allows it.
llvm::Expected<std::unique_ptr<llvm::TargetMachine>>
createTargetMachine(const MachineOptions &options);

/// Translates a module of the LLVM dialect; every function gets the attributes of the target
/// processor.
llvm::Expected<std::unique_ptr<llvm::Module>> translateToLlvm(mlir::ModuleOp module,
                                                              llvm::LLVMContext &context,
                                                              const llvm::TargetMachine &machine);

/// Defines `uint32_t name(const RtslLaunch *)`, which always returns `value`. If called before
/// linkDeviceCode, it replaces a weak definition there.
void defineConstant(llvm::Module &module, const std::string &name, uint32_t value);

/// Defines `uint32_t name(const RtslLaunch *, uint32_t)`, which returns the result of `target`.
void defineForward(llvm::Module &module, const std::string &name, const std::string &target);

/// The result of a function that always returns the same; nothing if it is unknown here.
std::optional<uint32_t> knownConstant(const llvm::Module &module, const std::string &name);

/// The result of a function without arguments, if it is a constant once it is optimised; afterwards
/// it is internal, or removed if nothing calls it.
std::optional<uint32_t> takeConstant(llvm::Module &module, const std::string &name);

/// Links the functions of `bitcodes`, one after the other, that the module calls. Afterwards all
/// functions except `exports` are internal. A name in `exports` may be undefined.
llvm::Error linkDeviceCode(llvm::Module &module, llvm::ArrayRef<std::string_view> bitcodes,
                           llvm::ArrayRef<std::string> exports);

/// LLVM's default pipeline at the options' level, with clang's settings.
void optimize(llvm::Module &module, llvm::TargetMachine &machine, const MachineOptions &options);

std::string printLlvm(const llvm::Module &module);

} // namespace rtsl::codegen
