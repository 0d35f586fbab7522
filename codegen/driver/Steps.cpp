//===- Steps.cpp - the steps that stages consist of -----------------------===//
#include "codegen/driver/Steps.h"

#include "codegen/ir/Rtsl.h"
#include "codegen/link/Link.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/Pipeline.h"

#include "llvm/Support/raw_ostream.h"

#include <stdexcept>

namespace rtsl::driver {

std::unique_ptr<mlir::MLIRContext> makeContext(const MachineCode *machineCode) {
  mlir::DialectRegistry registry;
  registry.insert<ir::RtslDialect>();
  codegen::registerPassDependencies(registry);
  auto context =
      std::make_unique<mlir::MLIRContext>(registry, mlir::MLIRContext::Threading::DISABLED);
  if (machineCode)
    machineCode->prepare(*context);
  context->loadAllAvailableDialects();
  return context;
}

void loadDialects(mlir::MLIRContext &context, void (*build)(mlir::OpPassManager &)) {
  mlir::PassManager passes(&context);
  build(passes);
  mlir::DialectRegistry dialects;
  passes.getDependentDialects(dialects);
  context.appendDialectRegistry(dialects);
  context.loadAllAvailableDialects();
}

/// With fewer functions, starting threads takes longer than they save.
constexpr std::ptrdiff_t fewestFunctionsForThreads = 100;

void allowThreads(mlir::ModuleOp ir, const CompileOptions &options) {
  const auto functions = ir.getOps<mlir::func::FuncOp>();
  if (options.threads == 1 ||
      std::distance(functions.begin(), functions.end()) < fewestFunctionsForThreads)
    return;
  mlir::MLIRContext &context = *ir.getContext();
  // Pipelines load their dialects when they run, which must not happen in parallel.
  loadDialects(context, codegen::buildSsaPipeline);
  context.enableMultithreading();
}

mlir::OwningOpRef<mlir::ModuleOp>
lowerModule(const typed::Module &module, const CompileOptions &options, const LinkRequest &request,
            SourceTable *source, Diagnostics &diagnostics, mlir::MLIRContext &context) {
  LowerOptions lowering;
  lowering.diagnostics = &diagnostics;
  lowering.colorComponents = options.colorComponents;
  lowering.checkIndices = options.checkIndices;
  lowering.raisesExceptions = request.features & RTSL_FEATURE_EXCEPTIONS;
  lowering.prints = request.features & RTSL_FEATURE_PRINT;
  lowering.source = source;
  lowering.isWidenedLater = options.floatingPoint == FloatingPoint::Double;
  lowering.hidesConstants = lowering.isWidenedLater || options.checksNumbers;
  if (!request.keep.has(Item::Classes))
    lowering.classes = {request.classes.begin(), request.classes.end()};
  return lower(module, lowering, context);
}

void expectSuccess(mlir::ModuleOp ir, llvm::function_ref<bool()> work) {
  std::string messages;
  mlir::ScopedDiagnosticHandler collect(ir.getContext(), [&](mlir::Diagnostic &diagnostic) {
    messages += diagnostic.str() + "\n";
    return mlir::success();
  });
  if (!work())
    throw std::logic_error(messages);
}

void run(mlir::ModuleOp ir, void (*build)(mlir::OpPassManager &)) {
  mlir::PassManager passes(ir.getContext());
#ifdef NDEBUG
  passes.enableVerifier(false);
#endif
  build(passes);
  expectSuccess(ir, [&] { return mlir::succeeded(passes.run(ir)); });
}

SplitOptions splitOptions(const CompileOptions &options) {
  SplitOptions split;
  split.rematerialise = split.trim = split.cleanUp = !options.savesAllThatIsLive;
  return split;
}

SplitReport runToStates(mlir::ModuleOp ir, const SplitOptions &options) {
  SplitReport report;
  keepTracingMethods(ir);
  run(ir, codegen::buildSsaPipeline);
  expectSuccess(ir, [&] { return splitAtTrace(ir, options, report); });
  return report;
}

std::string print(mlir::ModuleOp ir) {
  std::string text;
  llvm::raw_string_ostream stream(text);
  ir.print(stream);
  stream << "\n";
  return text;
}

} // namespace rtsl::driver
