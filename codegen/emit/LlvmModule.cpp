//===- LlvmModule.cpp - LLVM IR: translation, linking, optimisation -------===//
#include "codegen/emit/LlvmModule.h"

#include "codegen/emit/rewrites/FoldConstantFunctions.h"
#include "codegen/emit/rewrites/JoinCalls.h"
#include "codegen/emit/rewrites/LightsAlone.h"
#include "codegen/emit/rewrites/NarrowLoads.h"
#include "codegen/emit/rewrites/PackRecords.h"
#include "codegen/emit/rewrites/SelectByMask.h"
#include "codegen/emit/rewrites/UniteAddresses.h"
#include "codegen/emit/rewrites/UnrollLoops.h"
#include "codegen/emit/rewrites/arithmetic/FoldKnownCalls.h"
#include "codegen/emit/rewrites/arithmetic/ZeroProducts.h"
#include "codegen/emit/rewrites/gpu/Approximations.h"
#include "codegen/emit/rewrites/gpu/Conversions.h"
#include "codegen/emit/rewrites/gpu/DivideZeros.h"
#include "codegen/emit/rewrites/gpu/GlobalPointers.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/Target/LLVMIR/Dialect/Builtin/BuiltinToLLVMIRTranslation.h"
#include "mlir/Target/LLVMIR/Dialect/LLVMIR/LLVMToLLVMIRTranslation.h"
#include "mlir/Target/LLVMIR/Export.h"
#include "llvm/ADT/StringSet.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/Bitcode/BitcodeReader.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/DiagnosticPrinter.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/Module.h"
#include "llvm/Linker/Linker.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Passes/PassBuilder.h"
#include "llvm/Support/TargetSelect.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/Target/TargetMachine.h"
#include "llvm/TargetParser/Host.h"
#include "llvm/TargetParser/SubtargetFeature.h"
#include "llvm/Transforms/IPO/AlwaysInliner.h"
#include "llvm/Transforms/IPO/Internalize.h"
#include "llvm/Transforms/InstCombine/InstCombine.h"
#include "llvm/Transforms/Scalar/EarlyCSE.h"
#include "llvm/Transforms/Scalar/InstSimplifyPass.h"
#include "llvm/Transforms/Scalar/SROA.h"
#include "llvm/Transforms/Scalar/Scalarizer.h"
#include "llvm/Transforms/Scalar/SimplifyCFG.h"

#include <mutex>

namespace rtsl::codegen {

void registerLlvmTranslation(mlir::DialectRegistry &registry) {
  mlir::registerBuiltinDialectTranslation(registry);
  mlir::registerLLVMDialectTranslation(registry);
}

//===----------------------------------------------------------------------===//
// The target
//===----------------------------------------------------------------------===//

static llvm::CodeGenOptLevel codeGenLevel(unsigned optimization) {
  switch (optimization) {
  case 0:
    return llvm::CodeGenOptLevel::None;
  case 1:
    return llvm::CodeGenOptLevel::Less;
  case 2:
    return llvm::CodeGenOptLevel::Default;
  default:
    return llvm::CodeGenOptLevel::Aggressive;
  }
}

/// "+avx2,-avx512f,..." for the host processor.
static std::string hostFeatures() {
  llvm::SubtargetFeatures features;
  for (const auto &feature : llvm::sys::getHostCPUFeatures())
    features.AddFeature(feature.getKey(), feature.getValue());
  return features.getString();
}

static llvm::Expected<std::unique_ptr<llvm::TargetMachine>>
createTargetMachine(const llvm::Triple &triple, const std::string &cpu, const std::string &features,
                    unsigned optimization) {
  std::string error;
  const llvm::Target *target = llvm::TargetRegistry::lookupTarget(triple, error);
  if (!target)
    return llvm::createStringError("no code generator for `%s`: %s", triple.str().c_str(),
                                   error.c_str());
  llvm::TargetOptions targetOptions;
  targetOptions.AllowFPOpFusion = llvm::FPOpFusion::Strict;
  targetOptions.MCOptions.AsmVerbose = true;
  std::unique_ptr<llvm::TargetMachine> machine(target->createTargetMachine(
      triple, cpu, features, targetOptions, llvm::Reloc::PIC_, llvm::CodeModel::Small,
      codeGenLevel(optimization), /*JIT=*/true));
  if (!machine)
    return llvm::createStringError("no target machine for `%s`", triple.str().c_str());
  return machine;
}

llvm::Expected<std::unique_ptr<llvm::TargetMachine>>
createTargetMachine(const MachineOptions &options) {
  if (!options.gpu.empty()) {
    static std::once_flag once;
    std::call_once(once, [] {
      LLVMInitializeNVPTXTargetInfo();
      LLVMInitializeNVPTXTarget();
      LLVMInitializeNVPTXTargetMC();
      LLVMInitializeNVPTXAsmPrinter();
    });
    return createTargetMachine(llvm::Triple("nvptx64-nvidia-cuda"), options.gpu, "",
                               options.optimization);
  }
  static std::once_flag once;
  std::call_once(once, [] {
    LLVMInitializeX86TargetInfo();
    LLVMInitializeX86Target();
    LLVMInitializeX86TargetMC();
    LLVMInitializeX86AsmPrinter();
  });

  return createTargetMachine(llvm::Triple(llvm::sys::getProcessTriple()),
                             options.hostCpu ? llvm::sys::getHostCPUName().str() : "x86-64-v3",
                             options.hostCpu ? hostFeatures() : "", options.optimization);
}

/// Functions are inlined only if their features allow it, so all of them get the same; likewise the
/// attribute, as in the device code, that there is no C library whose functions could be
/// recognised. Estimates of reciprocals would make a NaN of 1 / 0, with FloatingPoint::Fast too.
static void setProcessor(llvm::Module &module, llvm::StringRef cpu, llvm::StringRef features) {
  for (llvm::Function &function : module) {
    if (function.isDeclaration())
      continue;
    function.addFnAttr("target-cpu", cpu);
    if (features.empty())
      function.removeFnAttr("target-features");
    else
      function.addFnAttr("target-features", features);
    function.removeFnAttr("tune-cpu");
    function.addFnAttr("no-builtins");
    function.addFnAttr("reciprocal-estimates", "none");
  }
}

//===----------------------------------------------------------------------===//
// The module
//===----------------------------------------------------------------------===//

llvm::Expected<std::unique_ptr<llvm::Module>> translateToLlvm(mlir::ModuleOp module,
                                                              llvm::LLVMContext &context,
                                                              const llvm::TargetMachine &machine) {
  std::unique_ptr<llvm::Module> result =
      mlir::translateModuleToLLVMIR(module, context, module.getName().value_or("shaders"));
  if (!result)
    return llvm::createStringError("the module cannot be translated to LLVM IR");
  result->setDataLayout(machine.createDataLayout());
  result->setTargetTriple(machine.getTargetTriple());
  setProcessor(*result, machine.getTargetCPU(), machine.getTargetFeatureString());
  return result;
}

namespace {

/// Collects the messages of the linker, which reports through the context and returns only a bool.
struct CollectMessages : llvm::DiagnosticHandler {
  explicit CollectMessages(std::string &messages) : messages(messages) {}
  bool handleDiagnostics(const llvm::DiagnosticInfo &info) override {
    if (info.getSeverity() == llvm::DS_Error) {
      llvm::raw_string_ostream stream(messages);
      llvm::DiagnosticPrinterRawOStream printer(stream);
      info.print(printer);
    }
    return true;
  }
  std::string &messages;
};

} // namespace

void defineConstant(llvm::Module &module, const std::string &name, uint32_t value) {
  llvm::LLVMContext &context = module.getContext();
  llvm::Type *i32 = llvm::Type::getInt32Ty(context);
  auto *type = llvm::FunctionType::get(i32, {llvm::PointerType::getUnqual(context)}, false);
  auto *function = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, module);
  llvm::IRBuilder<> builder(llvm::BasicBlock::Create(context, "", function));
  builder.CreateRet(builder.getInt32(value));
}

void defineForward(llvm::Module &module, const std::string &name, const std::string &target) {
  llvm::LLVMContext &context = module.getContext();
  llvm::Type *i32 = llvm::Type::getInt32Ty(context);
  auto *type = llvm::FunctionType::get(i32, {llvm::PointerType::getUnqual(context), i32}, false);
  auto *function = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, module);
  llvm::IRBuilder<> builder(llvm::BasicBlock::Create(context, "", function));
  builder.CreateRet(builder.CreateCall(module.getOrInsertFunction(target, type),
                                       {function->getArg(0), function->getArg(1)}));
}

std::optional<uint32_t> knownConstant(const llvm::Module &module, const std::string &name) {
  const llvm::Function *function = module.getFunction(name);
  if (!function || function->isDeclaration())
    return std::nullopt;
  const auto *end = llvm::dyn_cast<llvm::ReturnInst>(function->getEntryBlock().getTerminator());
  const auto *value = end ? llvm::dyn_cast<llvm::ConstantInt>(end->getReturnValue()) : nullptr;
  return value ? std::optional(uint32_t(value->getZExtValue())) : std::nullopt;
}

std::optional<uint32_t> takeConstant(llvm::Module &module, const std::string &name) {
  llvm::Function *function = module.getFunction(name);
  const std::optional<uint32_t> result = knownConstant(module, name);
  if (function->use_empty())
    function->eraseFromParent();
  else
    function->setLinkage(llvm::GlobalValue::InternalLinkage);
  return result;
}

/// Loaded lazily: functions that are never called are never parsed.
static llvm::Error linkBitcode(llvm::Module &module, std::string_view bitcode,
                               llvm::ArrayRef<std::string> exports) {
  llvm::LLVMContext &context = module.getContext();
  llvm::Expected<std::unique_ptr<llvm::Module>> device = llvm::getLazyBitcodeModule(
      llvm::MemoryBufferRef(llvm::StringRef(bitcode.data(), bitcode.size()), "device"), context);
  if (!device)
    return device.takeError();
  (*device)->setDataLayout(module.getDataLayout());
  (*device)->setTargetTriple(module.getTargetTriple());

  std::string messages;
  std::unique_ptr<llvm::DiagnosticHandler> previous = context.getDiagnosticHandler();
  context.setDiagnosticHandler(std::make_unique<CollectMessages>(messages));
  // Exported functions of the device code are needed even if the module does not call them.
  for (const std::string &name : exports)
    if (llvm::Function *function = (*device)->getFunction(name);
        function && !function->isDeclaration() && !module.getFunction(name))
      llvm::Function::Create(function->getFunctionType(), llvm::Function::ExternalLinkage, name,
                             module);
  bool failed = llvm::Linker::linkModules(module, std::move(*device), llvm::Linker::LinkOnlyNeeded);
  context.setDiagnosticHandler(std::move(previous));
  if (failed)
    return llvm::createStringError("device code cannot be linked: %s", messages.c_str());
  return llvm::Error::success();
}

llvm::Error linkDeviceCode(llvm::Module &module, llvm::ArrayRef<std::string_view> bitcodes,
                           llvm::ArrayRef<std::string> exports) {
  std::string cpu, features;
  for (const llvm::Function &function : module)
    if (!function.isDeclaration()) {
      cpu = function.getFnAttribute("target-cpu").getValueAsString();
      features = function.getFnAttribute("target-features").getValueAsString();
      break;
    }
  for (std::string_view bitcode : bitcodes)
    if (llvm::Error error = linkBitcode(module, bitcode, exports))
      return error;
  if (!cpu.empty())
    setProcessor(module, cpu, features);
  llvm::StringSet<> kept;
  for (const std::string &name : exports)
    kept.insert(name);
  llvm::internalizeModule(
      module, [&](const llvm::GlobalValue &value) { return kept.contains(value.getName()); });
  return llvm::Error::success();
}

namespace {

/// Splits vectors, also in memory. A vec3 in a register of four lanes would compute on a lane with
/// whatever follows it in memory, and if that is a denormal number each product costs over a
/// hundred cycles; its load would be 16 bytes wide and wait for the three stores of 4 that wrote
/// it. LLVM's SLP pass combines scalars that fill a register.
struct SplitVectors : llvm::PassInfoMixin<SplitVectors> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses) {
    if (function.getName() == "rtsl_entered_boxes") // its vectors fill registers
      return llvm::PreservedAnalyses::all();
    llvm::ScalarizerPassOptions options;
    options.ScalarizeLoadStore = true;
    return llvm::ScalarizerPass(options).run(function, analyses);
  }
};

} // namespace

static void addScalarization(llvm::PassBuilder &builder) {
  builder.registerPipelineStartEPCallback(
      [](llvm::ModulePassManager &passes, llvm::OptimizationLevel level) {
        if (level != llvm::OptimizationLevel::O0)
          passes.addPass(llvm::createModuleToFunctionPassAdaptor(SplitVectors()));
      });
}

/// Disables LLVM's SLP pass in functions that are to load fields one by one, and everywhere the
/// pass that widens a load to 16 bytes if that many are known to be valid, to use one or two lanes
/// of them: that load, too, waits for the narrow stores that wrote them, and may load denormals.
static void keepLoadsNarrow(llvm::PassInstrumentationCallbacks &callbacks) {
  callbacks.registerShouldRunOptionalPassCallback([](llvm::StringRef pass, llvm::Any unit) {
    const auto *function = llvm::any_cast<const llvm::Function *>(&unit);
    return pass != "VectorCombinePass" &&
           (pass != "SLPVectorizerPass" || !function || !hasNarrowLoads(**function));
  });
}

/// Leaves the states of the megakernel in the loop that runs them (runStates in
/// runtime/device/organisations/Megakernel.h), which is marked. To LLVM most of what a state
/// computes is the same in each turn of that loop, and it would compute it before the loop, for
/// lanes, too, that run no such state.
static void keepStatesInLoop(llvm::PassInstrumentationCallbacks &callbacks) {
  callbacks.registerShouldRunOptionalPassCallback([](llvm::StringRef pass, llvm::Any unit) {
    const auto *loop = llvm::any_cast<const llvm::Loop *>(&unit);
    return !loop || (pass != "LICMPass" && pass != "SimpleLoopUnswitchPass") ||
           !llvm::findOptionMDForLoop(*loop, "llvm.loop.pipeline.disable");
  });
}

/// Inlines calls that take addresses, and promotes the variables whose addresses they took. Twice,
/// because functions that are passed to others are called directly once these are inlined, and
/// addresses are in variables themselves.
static void addJoining(llvm::PassBuilder &builder) {
  builder.registerPipelineStartEPCallback(
      [](llvm::ModulePassManager &passes, llvm::OptimizationLevel) {
        for (int round = 0; round < 2; ++round) {
          passes.addPass(llvm::AlwaysInlinerPass(/*InsertLifetime=*/false));
          llvm::FunctionPassManager functions;
          functions.addPass(llvm::SROAPass(llvm::SROAOptions::ModifyCFG));
          functions.addPass(llvm::EarlyCSEPass());
          functions.addPass(llvm::InstCombinePass());
          functions.addPass(llvm::SimplifyCFGPass());
          functions.addPass(UniteAddressesPass());
          functions.addPass(llvm::SROAPass(llvm::SROAOptions::ModifyCFG));
          passes.addPass(llvm::createModuleToFunctionPassAdaptor(std::move(functions)));
        }
      });
}

/// Packs records after the calls are joined, when it is known which words a step needs.
static void addRecordPacking(llvm::PassBuilder &builder) {
  builder.registerPipelineStartEPCallback(
      [](llvm::ModulePassManager &passes, llvm::OptimizationLevel) {
        passes.addPass(PackRecordsPass());
      });
}

/// Unrolls loops whose values are known, and folds their calls: before functions are inlined, and
/// calls are gone.
static void addUnrolling(llvm::PassBuilder &builder) {
  builder.registerPipelineStartEPCallback(
      [](llvm::ModulePassManager &passes, llvm::OptimizationLevel level) {
        if (level == llvm::OptimizationLevel::O0)
          return;
        llvm::FunctionPassManager functions;
        functions.addPass(llvm::SROAPass(llvm::SROAOptions::ModifyCFG));
        functions.addPass(UnrollLoopsPass());
        functions.addPass(llvm::InstSimplifyPass());
        functions.addPass(FoldKnownCallsPass());
        passes.addPass(llvm::createModuleToFunctionPassAdaptor(std::move(functions)));
      });
}

/// Folds products with zeros whenever LLVM has combined instructions.
static void addZeroProducts(llvm::PassBuilder &builder) {
  builder.registerPeepholeEPCallback(
      [](llvm::FunctionPassManager &passes, llvm::OptimizationLevel) {
        passes.addPass(ZeroProductsPass());
        passes.addPass(llvm::InstSimplifyPass());
      });
}

/// Adds passes of functions after LLVM's own, unless nothing is optimised.
template <typename... Passes>
static void addLast(llvm::PassBuilder &builder) {
  builder.registerOptimizerLastEPCallback(
      [](llvm::ModulePassManager &passes, llvm::OptimizationLevel level, llvm::ThinOrFullLTOPhase) {
        if (level != llvm::OptimizationLevel::O0)
          (passes.addPass(llvm::createModuleToFunctionPassAdaptor(Passes())), ...);
      });
}

/// Up to how large functions are inlined on a CPU, in LLVM's units; its own default is 225. Methods
/// that a ray runs take some hundred, and their results pass through memory where they are called:
/// with 1000 instead of 225 pictures take 0.9 to 1 of the time, and compiling 1.1.
static constexpr int inlinerThreshold = 1000;

/// Leaves nothing but rays to lights in the kernels that look for them: early, so that less is left
/// to optimise, and once more when LLVM has found that more variables are not read.
static void addLightsAlone(llvm::PassBuilder &builder) {
  builder.registerScalarOptimizerLateEPCallback(
      [](llvm::FunctionPassManager &functions, llvm::OptimizationLevel) {
        functions.addPass(LightsAlonePass());
      });
  addLast<LightsAlonePass>(builder);
}

void optimize(llvm::Module &module, llvm::TargetMachine &machine, const MachineOptions &options) {
  llvm::PipelineTuningOptions tuning;
  if (options.optimization > 1 && !options.isMegakernel && !machine.getTargetTriple().isNVPTX())
    tuning.InlinerThreshold = inlinerThreshold;
  tuning.LoopVectorization = options.optimization > 1;
  tuning.SLPVectorization = options.optimization > 1;
  tuning.LoopInterleaving = tuning.LoopUnrolling = options.optimization > 0;

  llvm::LoopAnalysisManager loops;
  llvm::FunctionAnalysisManager functions;
  llvm::CGSCCAnalysisManager components;
  llvm::ModuleAnalysisManager modules;
  llvm::PassInstrumentationCallbacks callbacks;
  if (!machine.getTargetTriple().isNVPTX()) {
    markNarrowLoads(module);
    keepLoadsNarrow(callbacks);
  }
  llvm::PassBuilder builder(&machine, tuning, std::nullopt, &callbacks);
  builder.registerModuleAnalyses(modules);
  builder.registerCGSCCAnalyses(components);
  builder.registerFunctionAnalyses(functions);
  builder.registerLoopAnalyses(loops);
  builder.crossRegisterProxies(loops, functions, components, modules);

  addScalarization(builder);
  if (machine.getTargetTriple().isNVPTX()) {
    // What a GPU computes in another way than LLVM expects, which would move a division after its
    // select, and knows nothing of instructions of PTX.
    addLast<DivideZerosPass, ConversionsPass, ApproximationsPass>(builder);
    if (options.floatingPoint == FloatingPoint::Fast)
      addLast<llvm::EarlyCSEPass>(builder); // quotients by the same divisor have one reciprocal now
    addLast<GlobalPointersPass>(builder);
    keepStatesInLoop(callbacks);
  } else if (machine.getMCSubtargetInfo()->checkFeatures("+avx512vl")) { // masks for 128 bits
    addLast<SelectByMaskPass>(builder);
  }
  if (options.optimization > 0)
    foldConstantFunctions(module, functions);
  if (options.isMegakernel && options.optimization > 0 && joinCalls(module))
    addJoining(builder);

  if (module.getFunction("rtsl_record_store"))
    addRecordPacking(builder);
  if (module.getFunction("rtsl_knows_lights"))
    addLightsAlone(builder);
  addUnrolling(builder);
  if (options.floatingPoint == FloatingPoint::Fast)
    addZeroProducts(builder);

  static constexpr const llvm::OptimizationLevel *levels[] = {
      &llvm::OptimizationLevel::O0, &llvm::OptimizationLevel::O1, &llvm::OptimizationLevel::O2,
      &llvm::OptimizationLevel::O3};
  llvm::OptimizationLevel level = *levels[std::min(options.optimization, 3u)];
  llvm::ModulePassManager passes = options.optimization == 0
                                       ? builder.buildO0DefaultPipeline(level)
                                       : builder.buildPerModuleDefaultPipeline(level);
  passes.run(module, modules);
  unmarkNarrowLoads(module);
}

std::string printLlvm(const llvm::Module &module) {
  std::string text;
  llvm::raw_string_ostream stream(text);
  module.print(stream, nullptr);
  return text;
}

} // namespace rtsl::codegen
