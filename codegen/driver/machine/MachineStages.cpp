//===- MachineStages.cpp - the stages that need code generators -----------===//
#include "codegen/driver/machine/MachineStages.h"

#include "codegen/driver/machine/HostCode.h"
#include "codegen/driver/machine/LlvmSteps.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/ir/Attributes.h"
#include "codegen/link/BindScene.h"
#include "codegen/link/Link.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/restructure/Restructure.h"
#include "support/WorkerThreads.h"

#include "mlir/IR/Verifier.h"
#include "llvm/IR/Module.h"

#include <fmt/format.h>

namespace rtsl::driver {

static void prepare(mlir::MLIRContext &context) {
  mlir::DialectRegistry registry;
  codegen::registerLlvmDialects(registry);
  codegen::registerLlvmTranslation(registry);
  context.appendDialectRegistry(registry);
}

/// Makes the objects of a scene, with a program that contains only what this needs.
static runtime::SceneFacts makeObjects(const Compilation &compilation) {
  const mlir::OwningOpRef<mlir::ModuleOp> copy = mlir::ModuleOp(*compilation.ir).clone();
  keepConstructors(*copy, compilation.program->needs & RTSL_NEEDS_EMITTERS);
  auto constructors = std::make_shared<runtime::Program>(*compilation.program);
  compileConstructors(*copy, compilation.options, *constructors);
  // Constructors and bounds may have large local variables.
  runtime::SceneFacts facts;
  runOnThreads(1, constructors->stackBytes(0, 0),
               [&](unsigned) { facts = compilation.input.makeObjects(constructors); });
  return facts;
}

static std::string printLlvm(const Compilation &compilation) {
  return codegen::printLlvm(*compilation.llvm->module);
}

static bool reachLlvm(Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  if (compilation.input.scene) {
    if (!reachMachine(compilation))
      return false;
    compilation.llvm = std::make_shared<LlvmCode>(
        megakernel(*compilation.ir, options, *compilation.program, /*forGpu=*/false));
  } else {
    if (!reachSsa(compilation))
      return false;
    declareSlots(*compilation.ir);
    compilation.llvm = std::make_shared<LlvmCode>(
        translate(*compilation.ir, machineOptions(options, /*hostCpu=*/false)));
  }
  optimize(*compilation.llvm);
  return true;
}

/// Level 2 to level 1 and down again.
static void restructureAndBack(mlir::ModuleOp ir) {
  expectSuccess(
      ir, [&] { return mlir::succeeded(restructure(ir)) && mlir::succeeded(mlir::verify(ir)); });
  run(ir, codegen::buildSsaPipeline);
}

/// The PTX of a module without a scene: one function for each method, or for each state if it
/// traces. Slots and functions of runtime/device are only declared.
static std::string modulePtx(mlir::ModuleOp ir, const CompileOptions &options) {
  declareSlots(ir);
  std::vector<std::string> facts;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (ir::attr::factOfScene.isOn(function))
      facts.push_back(function.getSymName().str());
  LlvmCode code = translate(ir, gpuOptions(options));
  for (const std::string &fact : facts)
    code.module->getFunction(fact)->setLinkage(llvm::Function::InternalLinkage);
  for (llvm::Function &function : *code.module)
    if (!function.hasLocalLinkage())
      function.addFnAttr(llvm::Attribute::NoInline); // the switch over states calls them
  return toPtx(std::move(code), options);
}

/// The PTX of a scene. Its last line is for those who assemble it themselves: a package states the
/// number beside the PTX.
static std::string scenePtx(Compilation &compilation) {
  LlvmCode code = gpuKernel(compilation);
  const std::uint32_t registers = code.registers;
  return toPtx(std::move(code), compilation.options) +
         fmt::format("// rtslc: a thread may have {} registers (ptxas -maxrregcount={})\n",
                     registers, registers);
}

/// PTX. For a scene it is one kernel, `rtsl_render`, that takes an RtslJob
/// (runtime/device/organisations/Job.h).
static bool reachPtx(Compilation &compilation) {
  if (!reachGpuMachine(compilation))
    return false;
  compilation.text = compilation.input.scene ? scenePtx(compilation)
                                             : modulePtx(*compilation.ir, compilation.options);
  return true;
}

bool reachProgram(Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  const bool isSplit =
      options.target == Target::HostMegakernel || options.trace == TraceMode::Split;
  if (!(isSplit ? reachMachine(compilation) : reachSsa(compilation)))
    return false;
  if (options.restructure)
    restructureAndBack(*compilation.ir);
  compileHostCode(compilation);
  return true;
}

const MachineCode &machineCode() {
  static constexpr MachineCode stages = {prepare, makeObjects, reachLlvm, printLlvm, reachPtx};
  return stages;
}

} // namespace rtsl::driver
