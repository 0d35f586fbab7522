//===- Compiler.cpp - the compiler as a library ---------------------------===//
#include "codegen/driver/Compiler.h"

#include "codegen/cpp/EmitCpp.h"
#include "codegen/cpp/HitErrors.h"
#include "codegen/cpp/states/States.h"
#include "codegen/driver/HostCode.h"
#include "codegen/driver/Stages.h"
#include "codegen/emit/NativeImage.h"
#include "codegen/emit/Ptx.h"
#include "codegen/explain/Graphviz.h"
#include "codegen/explain/ReportJson.h"
#include "codegen/explain/ReportText.h"
#include "codegen/explain/StateGraph.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/link/BindScene.h"
#include "codegen/link/Link.h"
#include "codegen/link/LinkModule.h"
#include "codegen/link/UnrollRecursion.h"
#include "codegen/lower/KnownConditions.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/states/Dispatch.h"
#include "codegen/passes/errors/DeriveHitErrors.h"
#include "codegen/passes/restructure/Restructure.h"
#include "frontend/source/Expansion.h"
#include "runtime/program/DeviceBitcode.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Walk.h"
#include "support/WorkerThreads.h"

#include "mlir/Dialect/LLVMIR/LLVMDialect.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/StructuralHash.h"

#include <algorithm>
#include <stdexcept>

namespace rtsl {

using namespace driver;

namespace {

/// Stages that show states by name, before they are numbered.
bool isLookedAtSplit(Stage stage) {
  return stage == Stage::Split || stage == Stage::Structured;
}

/// The PTX of a module without a scene: a function a method, or a state where it traces. What
/// others supply is declared: slots, and the functions of runtime/device.
std::string modulePtx(mlir::ModuleOp ir, const CompileOptions &options) {
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (function->hasAttr(continuation::factOfScene))
      function->setAttr("llvm.linkage", mlir::LLVM::LinkageAttr::get(
                                            ir.getContext(), mlir::LLVM::Linkage::Internal));
  LlvmCode code = translate(ir, gpuOptions(options));
  for (llvm::Function &function : *code.module)
    if (!function.hasLocalLinkage())
      function.addFnAttr(llvm::Attribute::NoInline); // the switch over states calls them
  return toPtx(std::move(code));
}

/// Where `word` stands, which begins at a place in the IR.
SourceRange rangeAt(const ir::SourcePlace &place, std::string_view word,
                    const Diagnostics &diagnostics) {
  const FileId file = diagnostics.sources().find(place.file);
  if (!file)
    return {};
  const std::uint32_t begin = diagnostics.sources().offset(file, {place.line, place.column});
  return {file, begin, begin + static_cast<std::uint32_t>(word.size())};
}

/// A GPU has no stack for recursion, which a bound program has only if it is deep. False, with a
/// message, if there is some.
bool requireNoRecursion(mlir::ModuleOp ir, Diagnostics &diagnostics) {
  mlir::func::FuncOp function = recursiveFunction(ir);
  if (!function)
    return true;
  const std::string method = function.getSymName().rsplit('.').second.str();
  diagnostics
      .report(Code::recursionTooDeep, rangeAt(ir::placeOf(function->getLoc()), method, diagnostics),
              method, mostRecursionLevels)
      .note("on the CPU, `--target=host` renders it");
  return false;
}

/// Warns of a trace over which much is alive: values that are saved, and variables that lie in the
/// frame all the time.
void warnOfLiveState(const TraceReport &trace, const continuation::FrameLayout &frame,
                     std::uint32_t largeLiveState, Diagnostics &diagnostics) {
  struct Part {
    std::string name;
    std::uint32_t bytes;
  };
  std::vector<Part> parts;
  std::uint32_t bytes = trace.savedBytes;
  for (std::size_t i = 0; i != trace.saved.size(); ++i)
    parts.push_back({trace.savedShown[i], trace.savedSizes[i]});
  for (const continuation::FrameSlot &slot : frame.slots)
    if (slot.isObject) {
      parts.push_back({"`" + slot.name + "`", slot.size});
      bytes += slot.size;
    }
  if (bytes <= largeLiveState)
    return;
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part &a, const Part &b) { return a.bytes > b.bytes; });

  Diagnostic &diagnostic =
      diagnostics.report(Code::liveState, rangeAt(trace.place, "trace", diagnostics), bytes,
                         largeLiveState, parts.front().name, parts.front().bytes);
  std::string others;
  for (std::size_t i = 1; i < parts.size(); ++i)
    others += fmt::format("{}{} {}", i == 1 ? "" : ", ", parts[i].name, parts[i].bytes);
  if (!others.empty())
    diagnostic.note("and then: " + others);
}

} // namespace

std::optional<std::string> emit(const typed::Module &module, Stage stage,
                                const CompileOptions &options, Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  const mlir::OwningOpRef<mlir::ModuleOp> ir =
      lowerModule(module, options, {}, diagnostics, *context);
  if (!ir)
    return std::nullopt;
  if (stage == Stage::Ir)
    return print(*ir);
  const bool isSplit = stage == Stage::Split || stage == Stage::Structured || stage == Stage::Ptx;
  runToSsa(*ir, options, isSplit ? TraceMode::Split : TraceMode::Recurse,
           /*dispatch=*/stage == Stage::Ptx);
  if (stage == Stage::Structured)
    expectSuccess(*ir, [&] { return mlir::succeeded(restructure(*ir)); });
  if (stage == Stage::Ssa || isLookedAtSplit(stage))
    return print(*ir);

  declareSlots(*ir);
  if (stage == Stage::Ptx)
    return modulePtx(*ir, options);
  const LlvmCode code = translate(*ir, machineOptions(options, /*hostCpu=*/false));
  codegen::optimize(*code.module, *code.machine, code.options);
  return codegen::printLlvm(*code.module);
}

namespace {

/// C++ with the states of what traces.
std::optional<std::string> printSplitCpp(const typed::Module &module, const ModuleFacts &facts,
                                         const cpp::Options &printing,
                                         const CompileOptions &options, mlir::MLIRContext &context,
                                         Diagnostics &diagnostics) {
  SourceTable source = cpp::makeSourceTable(module);
  LowerOptions lowering;
  lowering.diagnostics = &diagnostics;
  lowering.colorComponents = options.colorComponents;
  lowering.checkIndices = false; // C++ looks at an index where it takes it
  lowering.prints = printing.prints;
  lowering.source = &source;
  const mlir::OwningOpRef<mlir::ModuleOp> ir = lower(module, lowering, context);
  if (!ir)
    return std::nullopt;
  continuation::callThroughFrames(*ir);
  SplitOptions split = splitOptions(options);
  split.dispatch = false;
  split.isKnown = [&source](mlir::Value condition) { return knownCondition(condition, source); };
  runToStates(*ir, split);
  mlir::ModuleOp program = *ir;
  for (auto function : program.getOps<mlir::func::FuncOp>())
    if (function->hasAttr("rtsl.state"))
      expectSuccess(*ir, [&] { return mlir::succeeded(restructure(function)); });
  const cpp::StateProgram states = {program, source};
  return cpp::print(module, facts, printing, diagnostics, &states);
}

/// Leaves the bounds of t of a linked module's primitives, as C++ shows them.
void keepHitErrors(mlir::ModuleOp ir) {
  for (auto function : llvm::make_early_inc_range(ir.getOps<mlir::func::FuncOp>()))
    if (!function->hasAttr(hitErrorAttribute))
      function.erase();
    else
      expectSuccess(ir, [&] { return mlir::succeeded(restructure(function)); });
}

bool mayTrace(const typed::Module &module) {
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      if (function->sends.traced)
        return true;
  return false;
}

} // namespace

std::optional<std::string> emitCpp(const typed::Module &module, const std::string &name,
                                   bool lineDirectives, std::optional<TraceMode> trace,
                                   std::uint32_t features, const CompileOptions &options,
                                   Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  LinkRequest request;
  request.features = features;
  const mlir::OwningOpRef<mlir::ModuleOp> ir =
      lowerModule(module, options, request, diagnostics, *context);
  if (!ir)
    return std::nullopt;
  const std::optional<ModuleFacts> facts =
      linkModule(*ir, module, diagnostics, options.floatingPoint);
  if (!facts)
    return std::nullopt;
  keepHitErrors(*ir);
  const cpp::HitErrorFunctions hitErrors = {*ir};

  cpp::Options printing;
  printing.prints = features & RTSL_FEATURE_PRINT;
  printing.exceptions = features & RTSL_FEATURE_EXCEPTIONS;
  printing.undefined = options.undefined;
  printing.checkIndices = options.checkIndices;
  printing.fast = options.floatingPoint == FloatingPoint::Fast;
  printing.name = name;
  printing.colorComponents = options.colorComponents;
  printing.lineDirectives = lineDirectives;
  printing.hitErrors = &hitErrors;
  if (trace == TraceMode::Recurse || !mayTrace(module))
    return cpp::print(module, *facts, printing, diagnostics);
  const auto printStates = [&](Diagnostics &refusals) {
    return printSplitCpp(module, *facts, printing, options, *context, refusals);
  };
  if (trace == TraceMode::Split)
    return printStates(diagnostics);
  Diagnostics refusals(diagnostics.sources());
  if (std::optional<std::string> text = printStates(refusals))
    return text;
  if (!refusals.all().empty()) {
    const std::string &message = refusals.all().front().message;
    printing.whyCalls = message.substr(0, message.find(" (")); // without the advice in parentheses
  }
  return cpp::print(module, *facts, printing, diagnostics);
}

static std::string write(const SplitReport &report, ReportFormat format) {
  switch (format) {
  case ReportFormat::Json:
    return toJson(report);
  case ReportFormat::Dot:
    return toDot(report);
  case ReportFormat::Svg:
    return drawGraph(toDot(report), "states of functions that trace");
  case ReportFormat::Text:
    break;
  }
  return toText(report);
}

std::optional<std::string> explainStates(const typed::Module &module, const CompileOptions &options,
                                         ReportFormat format, Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  const mlir::OwningOpRef<mlir::ModuleOp> ir =
      lowerModule(module, options, {}, diagnostics, *context);
  if (!ir)
    return std::nullopt;
  return write(runToExplainedStates(*ir, options), format);
}

void checkLiveState(const typed::Module &module, const CompileOptions &options,
                    Diagnostics &diagnostics) {
  if (!diagnostics.warnings.isOn(Code::liveState))
    return;
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  Diagnostics refusals(diagnostics.sources()); // whoever asks for more than a warning hears them
  const mlir::OwningOpRef<mlir::ModuleOp> ir = lowerModule(module, options, {}, refusals, *context);
  if (!ir || refusals.hasErrors())
    return;
  for (const FunctionReport &function : runToStates(*ir, splitOptions(options)).functions)
    for (const TraceReport &trace : function.traces)
      if (!trace.isJoin)
        warnOfLiveState(trace, function.frame, options.largeLiveState, diagnostics);
}

namespace {

/// A linked scene on level 1; null if there were errors.
mlir::OwningOpRef<mlir::ModuleOp> linkScene(const typed::Module &module, const LinkRequest &request,
                                            const CompileOptions &options, Diagnostics &diagnostics,
                                            mlir::MLIRContext &context, runtime::Program &program,
                                            Findings *findings = nullptr) {
  mlir::OwningOpRef<mlir::ModuleOp> ir =
      lowerModule(module, options, request, diagnostics, context);
  LinkRequest asked = request;
  asked.features |= options.undefined;
  if (!ir || !link(*ir, module, asked, options.colorComponents, diagnostics, program, findings,
                   options.floatingPoint))
    return nullptr;
  return ir;
}

/// With arithmetic in double what a scene sets stays a variable, for a bound index would change
/// what lies in memory, and so where a number is rounded.
LinkRequest whenBound(LinkRequest request, const CompileOptions &options) {
  if (options.floatingPoint == FloatingPoint::Double) {
    request.keep.add(Item::Parameters);
    request.keep.add(Item::Lights);
  }
  return request;
}

/// Makes the objects of a scene, and leaves in `ir` what renders that scene.
void bindToScene(mlir::ModuleOp ir, const LinkRequest &request, const CompileOptions &options,
                 const MakeObjects &makeObjects, const runtime::Program &program,
                 Findings *findings = nullptr) {
  const mlir::OwningOpRef<mlir::ModuleOp> copy = ir.clone();
  keepConstructors(*copy);
  auto constructors = std::make_shared<runtime::Program>(program);
  compileConstructors(*copy, options, *constructors);
  // Constructors and bounds may have large local variables.
  runtime::SceneFacts facts;
  runOnThreads(1, constructors->stackBytes(0, 0),
               [&](unsigned) { facts = makeObjects(constructors); });
  bindScene(ir, facts, whenBound(request, options), findings);
}

} // namespace

std::optional<std::string> emitScene(const typed::Module &module, const LinkRequest &request,
                                     Stage stage, const CompileOptions &options,
                                     Diagnostics &diagnostics, const MakeObjects &makeObjects) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  runtime::Program program;
  const bool isSplit = stage != Stage::Ir && stage != Stage::Ssa;
  const auto ir = linkScene(module, request, options, diagnostics, *context, program);
  if (!ir)
    return std::nullopt;
  if (makeObjects)
    bindToScene(*ir, request, options, makeObjects, program);
  if (makeObjects && stage == Stage::Ptx && !requireNoRecursion(*ir, diagnostics))
    return std::nullopt;
  if (stage == Stage::Ir)
    return print(*ir);
  runToSsa(*ir, options, isSplit ? TraceMode::Split : TraceMode::Recurse,
           /*dispatch=*/!isLookedAtSplit(stage));
  if (stage == Stage::Structured)
    expectSuccess(*ir, [&] { return mlir::succeeded(restructure(*ir)); });
  if (stage == Stage::Ssa || isLookedAtSplit(stage))
    return print(*ir);

  if (stage == Stage::Ptx) {
    LlvmCode code = translate(*ir, gpuOptions(options));
    defineFacts(code, program);
    linkMegakernel(code, /*forGpu=*/true, {"rtsl_render"});
    return toPtx(std::move(code));
  }
  LlvmCode code = translate(*ir, machineOptions(options, /*hostCpu=*/false));
  defineFacts(code, program);
  linkMegakernel(code, /*forGpu=*/false, {"rtsl_lane_bytes", "rtsl_run_lane"});
  codegen::optimize(*code.module, *code.machine, code.options);
  return codegen::printLlvm(*code.module);
}

namespace {

/// The first `print` of the classes that the scene uses.
SourceRange firstPrint(const typed::Module &module, const LinkRequest &request) {
  SourceRange range;
  for (const auto &one : module.classes)
    for (const auto &function : one->functions)
      if (function->body && std::count(request.classes.begin(), request.classes.end(), one->name))
        forEachExpr(*function->body, [&](const typed::Expr &expr) {
          const auto *call = dynCast<typed::BuiltinExpr>(&expr);
          if (call && call->builtin == typed::Builtin::Print && !range.isValid())
            range = call->range;
        });
  return range;
}

/// `hasChecks`: whether an index of the program is kept in range that could be out of it.
void describeEvents(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, bool hasChecks, const runtime::Program &program,
                    const SourceManager &sources, Findings &findings) {
  const bool hasExceptions =
      (request.features & RTSL_FEATURE_EXCEPTIONS) && !(request.features & RTSL_FEATURE_UNHEEDED);
  Finding exceptions = {Item::Events, "exceptions", hasExceptions, {}, {}};
  exceptions.reason = hasExceptions ? "asked for, by the scene's `exception` or --exceptions"
                                    : "the scene has no `exception`, and --exceptions is not given";
  findings.push_back(std::move(exceptions));

  const bool prints = !program.prints.empty();
  const SourceRange print = firstPrint(module, request);
  Finding printing = {
      Item::Events, "print", prints, prints ? "--print" : "no shader that runs prints", {}};
  if (print.isValid()) {
    const ShownPlace place = shownBegin(sources, print);
    printing.place = {std::string(place.file), place.at.line, place.at.column};
    if (!(request.features & RTSL_FEATURE_PRINT))
      printing.reason = "--print is not given";
  }
  findings.push_back(std::move(printing));

  findings.push_back({Item::Events,
                      "index checks",
                      hasChecks,
                      !options.checkIndices ? "--unchecked"
                      : hasChecks           ? "an index is kept in range that is not known to be"
                                            : "every index is known to be in range",
                      {}});
}

/// What tells two programs apart: the structure of what a GPU runs, or of what this machine does in
/// double. `ir` is used up.
llvm::stable_hash fingerprint(mlir::ModuleOp ir, const CompileOptions &options,
                              const runtime::Program &program) {
  const bool forGpu = options.floatingPoint != FloatingPoint::Double;
  runToSsa(ir, options, TraceMode::Split);
  LlvmCode code =
      translate(ir, forGpu ? gpuOptions(options) : machineOptions(options, /*hostCpu=*/false));
  defineFacts(code, program);
  linkMegakernel(code, forGpu,
                 forGpu ? std::vector<std::string>{"rtsl_render"}
                        : std::vector<std::string>{"rtsl_lane_bytes", "rtsl_run_lane"});
  codegen::optimize(*code.module, *code.machine, code.options);
  return llvm::StructuralHash(*code.module, /*DetailedHash=*/true);
}

/// Whether checks of indices change the program.
bool hasIndexChecks(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, const SourceManager &sources,
                    const runtime::SceneFacts &facts) {
  if (!options.checkIndices)
    return false;
  const auto compiled = [&](bool checks) {
    CompileOptions checking = options;
    checking.checkIndices = checks;
    Diagnostics unheard(sources);
    const std::unique_ptr<mlir::MLIRContext> context = makeContext();
    runtime::Program program;
    const auto ir = linkScene(module, request, checking, unheard, *context, program);
    bindScene(*ir, facts, whenBound(request, checking));
    return fingerprint(*ir, checking, program);
  };
  return compiled(true) != compiled(false);
}

/// What a bound program takes on a GPU. `ir` is used up.
ProgramSize measure(mlir::ModuleOp ir, const CompileOptions &options,
                    const runtime::Program &program) {
  ProgramSize size;
  const SplitReport report = runToStates(ir, splitOptions(options));
  size.frameBytes = report.frameSize();
  for (const FunctionReport &function : report.functions)
    size.states += static_cast<std::uint32_t>(function.states.size());
  LlvmCode code = translate(ir, machineOptions(options, /*hostCpu=*/false));
  defineFacts(code, program);
  linkMegakernel(code, /*forGpu=*/false, {"rtsl_lane_bytes", "rtsl_run_lane"});
  codegen::optimize(*code.module, *code.machine, code.options);
  for (const llvm::Function &function : *code.module)
    size.instructions += function.getInstructionCount();
  for (const llvm::GlobalVariable &global : code.module->globals())
    if (global.isConstant() && global.hasInitializer())
      size.constantBytes += code.module->getDataLayout().getTypeAllocSize(global.getValueType());
  return size;
}

} // namespace

std::optional<SceneExplanation>
explainScene(const typed::Module &module, const LinkRequest &request, const CompileOptions &options,
             Diagnostics &diagnostics, const MakeObjects &makeObjects) {
  SceneExplanation explanation;
  runtime::SceneFacts facts; // made once: what a program leaves out changes no object
  {
    const std::unique_ptr<mlir::MLIRContext> context = makeContext();
    auto program = std::make_shared<runtime::Program>();
    const auto ir =
        linkScene(module, request, options, diagnostics, *context, *program, &explanation.findings);
    if (!ir)
      return std::nullopt;
    bindToScene(
        *ir, request, options,
        [&](const auto &constructors) { return facts = makeObjects(constructors); }, *program,
        &explanation.findings);
    describeEvents(module, request, options,
                   hasIndexChecks(module, request, options, diagnostics.sources(), facts), *program,
                   diagnostics.sources(), explanation.findings);
    explanation.size = measure(*ir, options, *program);
    explanation.program = program;
  }
  for (Item item : allItems) {
    if (request.keep.has(item))
      continue;
    const bool leavesOut = std::any_of(
        explanation.findings.begin(), explanation.findings.end(),
        [&](const Finding &finding) { return finding.item == item && !finding.isNeeded; });
    if (!leavesOut || item == Item::Meshes) { // nothing changes in the program
      explanation.sizeKeeping[item] = explanation.size;
      continue;
    }
    LinkRequest keeping = request;
    CompileOptions keepingOptions = options;
    keep(ItemSet::only(item), keeping, keepingOptions);
    Diagnostics unheard(diagnostics.sources());
    const std::unique_ptr<mlir::MLIRContext> context = makeContext();
    runtime::Program program;
    const auto ir = linkScene(module, keeping, keepingOptions, unheard, *context, program);
    if (!ir)
      continue; // the item cannot be kept: a class that the scene does not use may be incomplete
    bindScene(*ir, facts, whenBound(keeping, keepingOptions));
    explanation.sizeKeeping[item] = measure(*ir, keepingOptions, program);
  }
  return explanation;
}

void keep(ItemSet items, LinkRequest &request, CompileOptions &options) {
  request.keep.add(items);
  if (!items.has(Item::Events))
    return;
  options.checkIndices = true;
  if (!(request.features & RTSL_FEATURE_EXCEPTIONS))
    request.features |= RTSL_FEATURE_EXCEPTIONS | RTSL_FEATURE_UNHEEDED;
}

std::optional<std::string> explainSceneStates(const typed::Module &module,
                                              const LinkRequest &request, std::uint32_t maxDepth,
                                              const CompileOptions &options, ReportFormat format,
                                              Diagnostics &diagnostics) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  runtime::Program program;
  const auto ir = linkScene(module, request, options, diagnostics, *context, program);
  if (!ir)
    return std::nullopt;
  SplitReport report = runToExplainedStates(*ir, options);
  report.maxDepth = maxDepth;
  return write(report, format);
}

std::shared_ptr<const runtime::Program> compileProgram(const typed::Module &module,
                                                       const LinkRequest &request,
                                                       const CompileOptions &options,
                                                       Diagnostics &diagnostics,
                                                       const MakeObjects &makeObjects) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  auto program = std::make_shared<runtime::Program>();
  const auto ir = linkScene(module, request, options, diagnostics, *context, *program);
  if (!ir)
    return nullptr;
  allowThreads(*ir, options);
  if (makeObjects)
    bindToScene(*ir, request, options, makeObjects, *program);
  compileLinked(*ir, options, *program);
  return program;
}

bool compilePackage(const typed::Module &module, const LinkRequest &request,
                    const CompileOptions &options, Diagnostics &diagnostics,
                    const MakeObjects &makeObjects, runtime::Package &package) {
  const std::unique_ptr<mlir::MLIRContext> context = makeContext();
  runtime::Program program;
  auto ir = linkScene(module, request, options, diagnostics, *context, program);
  if (!ir)
    return false;
  bindToScene(*ir, request, options, makeObjects, program);
  if (!requireNoRecursion(*ir, diagnostics))
    return false;
  const SplitReport report = runToStates(*ir, splitOptions(options));
  package.frameBytes = report.frameSize();
  package.stateCount = 0;
  for (const FunctionReport &function : report.functions)
    package.stateCount += static_cast<std::uint32_t>(function.states.size());

  const mlir::OwningOpRef<mlir::ModuleOp> forGpu = ir->clone();
  LlvmCode gpu = translate(*forGpu, gpuOptions(options));
  defineFacts(gpu, program);
  linkMegakernel(gpu, /*forGpu=*/true, {"rtsl_render"});
  package.ptx = toPtx(std::move(gpu));

  LlvmCode host = translate(*ir, machineOptions(options, /*hostCpu=*/false));
  defineFacts(host, program);
  const std::vector<std::string> entries = {"rtsl_lane_bytes", "rtsl_run_lane"};
  std::vector<std::string> kept = {"memcpy", "memmove", "memset"};
  kept.insert(kept.end(), entries.begin(), entries.end());
  std::vector<std::string_view> bitcodes = megakernelCode(/*forGpu=*/false);
  bitcodes.push_back(runtime::hostMemoryBitcode());
  linkDeviceCode(host, bitcodes, kept);
  host.options.isMegakernel = true;
  codegen::optimize(*host.module, *host.machine, host.options);
  codegen::NativeImage image = take(codegen::makeNativeImage(*host.module, *host.machine, entries));
  package.host = {std::move(image.bytes), image.entries[0], image.entries[1],
                  static_cast<std::uint32_t>(image.stackBytes)};
  return true;
}

} // namespace rtsl
