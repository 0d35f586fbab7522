//===- Compiler.cpp - the compiler as a library ---------------------------===//
#include "codegen/driver/Compiler.h"

#include "codegen/emit/ConvertToLlvm.h"
#include "codegen/emit/Jit.h"
#include "codegen/emit/LlvmModule.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/link/Link.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/Split.h"
#include "runtime/DeviceBitcode.h"

#include "mlir/IR/MLIRContext.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/Target/TargetMachine.h"

#include <stdexcept>

namespace rtsl {

namespace {

/// What can only be a mistake of ours: the program was checked before. Main ends with its own exit status.
[[noreturn]] void fail(const std::string &what) { throw std::logic_error(what); }

template <typename T>
T take(llvm::Expected<T> expected) {
  if (!expected)
    fail(llvm::toString(expected.takeError()));
  return std::move(*expected);
}

std::unique_ptr<mlir::MLIRContext> makeContext() {
  mlir::DialectRegistry registry;
  registry.insert<ir::RtslDialect>();
  codegen::registerPassDependencies(registry);
  codegen::registerLlvmTranslation(registry);
  auto context = std::make_unique<mlir::MLIRContext>(registry, mlir::MLIRContext::Threading::DISABLED);
  context->loadAllAvailableDialects();
  return context;
}

mlir::OwningOpRef<mlir::ModuleOp> lowerModule(const typed::Module &module, const CompileOptions &options,
                                              std::set<std::string> classes, Diagnostics &diagnostics,
                                              mlir::MLIRContext &context) {
  LowerOptions lowering;
  lowering.diagnostics = &diagnostics;
  lowering.colorComponents = options.colorComponents;
  lowering.checkIndices = options.checkIndices;
  lowering.classes = std::move(classes);
  return lower(module, lowering, context);
}

/// Runs `work` on the module. Our own passes may fail only through a fault of ours.
template <typename Work>
void expectSuccess(mlir::ModuleOp ir, Work work) {
  std::string messages;
  mlir::ScopedDiagnosticHandler collect(ir.getContext(), [&](mlir::Diagnostic &diagnostic) {
    messages += diagnostic.str() + "\n";
    return mlir::success();
  });
  if (!work())
    fail(messages);
}

void run(mlir::ModuleOp ir, void (*build)(mlir::OpPassManager &)) {
  mlir::PassManager passes(ir.getContext());
#ifdef NDEBUG
  passes.enableVerifier(false);
#endif
  build(passes);
  expectSuccess(ir, [&] { return mlir::succeeded(passes.run(ir)); });
}

/// Level 1 to level 2, with `trace` as the options ask.
SplitReport runToSsa(mlir::ModuleOp ir, TraceMode trace, bool dispatch = true) {
  SplitReport report;
  if (trace == TraceMode::Split)
    keepTracingMethods(ir);
  run(ir, codegen::buildSsaPipeline);
  if (trace == TraceMode::Split) {
    SplitOptions split;
    split.dispatch = dispatch;
    expectSuccess(ir, [&] { return splitAtTrace(ir, split, report); });
  }
  return report;
}

std::string print(mlir::ModuleOp ir) {
  std::string text;
  llvm::raw_string_ostream stream(text);
  ir.print(stream);
  stream << "\n";
  return text;
}

codegen::MachineOptions machineOptions(const CompileOptions &options, bool hostCpu) {
  codegen::MachineOptions machine;
  machine.optimization = options.optimization;
  machine.hostCpu = hostCpu;
  return machine;
}

/// The device code's function for one sample.
std::string sampleSymbol(const CompileOptions &options) {
  return options.trace == TraceMode::Split ? "rtsl_sample_split" : "rtsl_sample";
}

/// The functions of a linked program that the runtime asks for.
std::vector<std::string> entries(const runtime::Program &program, const CompileOptions &options) {
  std::vector<std::string> names = {sampleSymbol(options)};
#define RTSL_SLOT(base, method) names.push_back("rtsl_" #base "_" #method);
#include "runtime/device/Slots.def"
  for (const runtime::ClassInfo &info : program.classes) {
    names.push_back(initializeSymbol(info.name));
    names.push_back(constructSymbol(info.name));
  }
  return names;
}

template <typename Function>
void find(const codegen::Jit &jit, const std::string &name, Function *&function) {
  function = reinterpret_cast<Function *>(jit.lookup(name));
}

/// Looks up the entries of a compiled program.
void fillEntries(runtime::Program &program, const codegen::Jit &jit, const CompileOptions &options) {
  find(jit, sampleSymbol(options), program.sample);
#define RTSL_SLOT(base, method) find(jit, "rtsl_" #base "_" #method, program.slots.base##_##method);
#include "runtime/device/Slots.def"
  for (runtime::ClassInfo &info : program.classes) {
    find(jit, initializeSymbol(info.name), info.initialize);
    find(jit, constructSymbol(info.name), info.construct);
  }
}

} // namespace

std::optional<std::string> emit(const typed::Module &module, Stage stage, const CompileOptions &options,
                                Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  const mlir::OwningOpRef<mlir::ModuleOp> ir = lowerModule(module, options, {}, diagnostics, *context);
  if (!ir)
    return std::nullopt;
  if (stage == Stage::Ir)
    return print(*ir);
  runToSsa(*ir, stage == Stage::Split ? TraceMode::Split : TraceMode::Recurse, /*dispatch=*/false);
  if (stage == Stage::Ssa || stage == Stage::Split)
    return print(*ir);

  declareSlots(*ir);
  run(*ir, codegen::buildLlvmPipeline);
  llvm::LLVMContext llvmContext;
  const codegen::MachineOptions machine = machineOptions(options, /*hostCpu=*/false);
  const auto target = take(codegen::createTargetMachine(machine));
  const auto llvmModule = take(codegen::translateToLlvm(*ir, llvmContext, *target));
  codegen::optimize(*llvmModule, *target, machine);
  return codegen::printLlvm(*llvmModule);
}

std::optional<std::string> explainStates(const typed::Module &module, const CompileOptions &options, bool json,
                                         Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  const mlir::OwningOpRef<mlir::ModuleOp> ir = lowerModule(module, options, {}, diagnostics, *context);
  if (!ir)
    return std::nullopt;
  const SplitReport report = runToSsa(*ir, TraceMode::Split);
  return json ? toJson(report) : toText(report);
}

std::shared_ptr<const runtime::Program> compileProgram(const typed::Module &module, const LinkRequest &request,
                                                       const CompileOptions &options, Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  const mlir::OwningOpRef<mlir::ModuleOp> ir = lowerModule(
      module, options, {request.classes.begin(), request.classes.end()}, diagnostics, *context);
  auto program = std::make_shared<runtime::Program>();
  if (!ir || !link(*ir, module, request, options.colorComponents, diagnostics, *program))
    return nullptr;
  runToSsa(*ir, options.trace);
  run(*ir, codegen::buildLlvmPipeline);

  auto llvmContext = std::make_unique<llvm::LLVMContext>();
  const codegen::MachineOptions machine = machineOptions(options, /*hostCpu=*/true);
  auto target = take(codegen::createTargetMachine(machine));
  auto llvmModule = take(codegen::translateToLlvm(*ir, *llvmContext, *target));
  if (llvm::Error error = codegen::linkDeviceCode(*llvmModule, runtime::deviceBitcode(), entries(*program, options)))
    fail(llvm::toString(std::move(error)));
  codegen::optimize(*llvmModule, *target, machine);
  std::shared_ptr<codegen::Jit> jit =
      take(codegen::Jit::create(std::move(llvmContext), std::move(llvmModule), std::move(target),
                                {{"rtsl_traverse", reinterpret_cast<void *>(&rtsl_traverse)},
                                 {"rtsl_machine_stack", reinterpret_cast<void *>(&rtsl_machine_stack)}}));
  fillEntries(*program, *jit, options);
  program->code = jit;
  return program;
}

} // namespace rtsl
