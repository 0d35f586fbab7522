//===- HostCode.cpp - linked IR as a program in this process --------------===//
#include "codegen/driver/machine/HostCode.h"

#include "codegen/driver/Steps.h"
#include "codegen/driver/machine/CodeCache.h"
#include "codegen/driver/machine/LlvmSteps.h"
#include "codegen/driver/machine/MachineStages.h"
#include "codegen/emit/Jit.h"
#include "codegen/emit/Parts.h"
#include "codegen/emit/rewrites/arithmetic/DoublePrecision.h"
#include "codegen/link/Link.h"
#include "codegen/passes/Pipeline.h"
#include "runtime/program/DeviceBitcode.h"
#include "runtime/program/NumberCheck.h"

#include "mlir/IR/Threading.h"
#include "mlir/Transforms/Passes.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>

namespace rtsl {

namespace driver {

namespace {

//===----------------------------------------------------------------------===//
// Functions that the runtime calls
//===----------------------------------------------------------------------===//

/// The functions of a linked program that samples start with.
std::vector<std::string> sampleSymbols(const runtime::Program &program,
                                       const CompileOptions &options) {
  if (options.target == Target::HostMegakernel)
    return hostEntries(options.organisation);
  if (options.trace == TraceMode::Split)
    return {"rtsl_sample_split"};
  return {program.engine == runtime::Engine::Classic ? "rtsl_sample" : "rtsl_generate"};
}

/// The functions of a linked program that the runtime looks up.
std::vector<std::string> entries(const Compilation &compilation) {
  const runtime::Program &program = *compilation.program;
  std::vector<std::string> names;
#define RTSL_SAMPLING_SLOT(base, method) names.push_back("rtsl_" #base "_" #method);
#include "language/SamplingSlots.def"
  if (compilation.input.scene && compilation.input.scene->isOnlySampled)
    return names;
  for (const std::string &symbol : sampleSymbols(program, compilation.options))
    names.push_back(symbol);
  names.push_back("rtsl_rt_Material_anyHit_payload");
#define RTSL_SLOT(base, method) names.push_back("rtsl_" #base "_" #method);
#include "language/Slots.def"
  for (const runtime::ClassInfo &info : program.classes) {
    names.push_back(initializeSymbol(info.name));
    names.push_back(constructSymbol(info.name));
    names.push_back(intersectSymbol(info.name));
  }
  return names;
}

constexpr const char *emittedPowerSymbol = "rtsl_emitted_power";

/// Adds the function that looks for surfaces that shine. The program that makes the objects of a
/// scene has it; one that is bound to the scene renders, and does not look again.
void addEmittedPower(const runtime::Program &program, std::vector<std::string> &names) {
  if (program.needs & RTSL_NEEDS_EMITTERS)
    names.push_back(emittedPowerSymbol);
}

template <typename Function>
void find(const codegen::Jit &jit, const std::string &name, Function *&function) {
  function = reinterpret_cast<Function *>(jit.lookup(name));
}

/// Looks up the entries of a compiled program.
void fillEntries(runtime::Program &program, const codegen::Jit &jit,
                 const CompileOptions &options) {
  if (options.target == Target::HostMegakernel) {
    const std::vector<std::string> &names = hostEntries(options.organisation);
    find(jit, names[0], program.megakernel.laneBytes);
    find(jit, names[1], program.megakernel.runLane);
    program.megakernel.stackBytes =
        jit.stackUse()->bytes(/*rays=*/1, /*referenceChain=*/0); // it does not recurse
  } else {
    find(jit, sampleSymbols(program, options).front(), program.sample);
  }
  program.stackBytes = [use = jit.stackUse()](std::uint32_t maxDepth,
                                              std::uint32_t referenceChain) {
    // The camera's ray or `generate`, and rays of depth 0 to maxDepth.
    return use->bytes(std::uint64_t(maxDepth) + 2, referenceChain);
  };
  find(jit, "rtsl_rt_Material_anyHit_payload", program.slots.rt_Material_anyHit_payload);
#define RTSL_SLOT(base, method) find(jit, "rtsl_" #base "_" #method, program.slots.base##_##method);
#include "language/Slots.def"
#define RTSL_SAMPLING_SLOT(base, method)                                                           \
  find(jit, "rtsl_" #base "_" #method, program.slots.base##_##method);
#include "language/SamplingSlots.def"
  find(jit, emittedPowerSymbol, program.emittedPower);
  for (runtime::ClassInfo &info : program.classes) {
    find(jit, initializeSymbol(info.name), info.initialize);
    find(jit, constructSymbol(info.name), info.construct);
    find(jit, intersectSymbol(info.name), info.intersect);
  }
}

/// Loads machine code into this process, linked with `print` and `symbols`, and sets the entry
/// points of the program.
void load(std::vector<codegen::ObjectCode> parts, std::vector<codegen::HostSymbol> symbols,
          const CompileOptions &options, runtime::Program &program) {
  symbols.push_back({"rtsl_print", reinterpret_cast<void *>(&rtsl_print)});
  symbols.push_back({"rtsl_check_number", reinterpret_cast<void *>(&rtsl_check_number)});
  symbols.push_back(
      {"rtsl_check_stored_number", reinterpret_cast<void *>(&rtsl_check_stored_number)});
  if (options.floatingPoint == FloatingPoint::Double)
    for (const codegen::HostSymbol &function : codegen::doubleFunctions())
      symbols.push_back(function);
  std::shared_ptr<codegen::Jit> jit = take(codegen::Jit::create(std::move(parts), symbols));
  fillEntries(program, *jit, options);
  program.code = jit;
}

//===----------------------------------------------------------------------===//
// Machine code
//===----------------------------------------------------------------------===//

/// Calls `work(0)` ... `work(count - 1)`, on several threads if the context allows it. Rethrows an
/// exception of one of them.
template <typename Work>
void forEach(mlir::MLIRContext &context, std::size_t count, Work work) {
  std::exception_ptr thrown;
  std::mutex mutex;
  mlir::parallelFor(&context, 0, count, [&](std::size_t index) {
    try {
      work(index);
    } catch (...) { // which must not reach a thread of LLVM
      const std::lock_guard<std::mutex> lock(mutex);
      thrown = std::current_exception();
    }
  });
  if (thrown)
    std::rethrow_exception(thrown);
}

/// Compiles level 2 with its device code, in one or more parts.
class PartCompiler {
public:
  PartCompiler(mlir::ModuleOp ir, const CompileOptions &options,
               llvm::ArrayRef<std::string_view> bitcodes, std::vector<std::string> exports,
               runtime::Program &program)
      : ir(ir), options(options), bitcodes(bitcodes), exports(std::move(exports)),
        program(program) {}

  std::vector<codegen::ObjectCode> run();

private:
  LlvmCode rest();
  LlvmCode part(mlir::ModuleOp functions, std::vector<std::string> &missing);

  mlir::ModuleOp ir;
  const CompileOptions &options;
  llvm::ArrayRef<std::string_view> bitcodes;
  std::vector<std::string> exports;
  runtime::Program &program;
};

/// The code that is in no separate part: all of a small program.
LlvmCode PartCompiler::rest() {
  LlvmCode code = translate(ir, machineOptions(options, /*hostCpu=*/true),
                            options.checksNumbers ? &program.numberPlaces : nullptr);
  defineFacts(code, options, program);
  const bool isMegakernel = options.target == Target::HostMegakernel;
  code.organisation = options.organisation.value_or(Organisation::Megakernel);
  const bool keepsRecords = isMegakernel && code.organisation != Organisation::Megakernel;
  if (isMegakernel) {
    decideWhetherLanesTakePixels(code, options, program);
    decideListedTests(code, options, program);
    decideKnownLights(code, options, program);
  }
  if (keepsRecords)
    beginRecords(code, program);
  std::vector<std::string_view> linked = bitcodes;
  if (!isMegakernel && hasList(code))
    linked = {runtime::deviceBitcode(), runtime::listTraversalBitcode(), runtime::deviceBitcode()};
  linkDeviceCode(code, linked, exports);
  if (keepsRecords)
    endRecords(code, options, program);
  code.options.isMegakernel = isMegakernel;
  return code;
}

/// Each function of a part runs rarely, and has been simplified before: LLVM's level 2 would mostly
/// take more time.
LlvmCode PartCompiler::part(mlir::ModuleOp functions, std::vector<std::string> &missing) {
  codegen::MachineOptions machine = machineOptions(options, /*hostCpu=*/true);
  if (machine.optimization < 3)
    machine.optimization = std::min(machine.optimization, 1u);
  LlvmCode code = translate(functions, machine);
  const std::vector<std::string> own = codegen::visibleFunctions(*code.module);
  defineFacts(code, options, program);
  codegen::defineConstant(*code.module, "rtsl_features", program.slots.features);
  linkDeviceCode(code, bitcodes, own);
  missing = codegen::shareLargeFunctions(*code.module);
  return code;
}

std::vector<codegen::ObjectCode> PartCompiler::run() {
  const bool isWhole =
      options.checksNumbers ||
      options.floatingPoint == FloatingPoint::Double; // both process the whole program
  std::vector<mlir::OwningOpRef<mlir::ModuleOp>> parts;
  if (!isWhole)
    parts = codegen::takeParts(ir);
  std::vector<std::optional<LlvmCode>> codes(parts.size());
  std::vector<std::vector<std::string>> missing(parts.size());
  mlir::MLIRContext &context = *ir.getContext();
  forEach(context, parts.size(),
          [&](std::size_t index) { codes[index].emplace(part(*parts[index], missing[index])); });
  for (std::vector<std::string> &names : missing)
    exports.insert(exports.end(), names.begin(), names.end());

  std::vector<std::optional<codegen::ObjectCode>> objects(
      parts.size() + 1); // the rest takes longest, so it is started first
  forEach(context, objects.size(), [&](std::size_t index) {
    objects[index].emplace(toObject(index == 0 ? rest() : std::move(*codes[index - 1]), options));
  });
  std::vector<codegen::ObjectCode> made;
  for (std::optional<codegen::ObjectCode> &object : objects)
    made.push_back(std::move(*object));
  return made;
}

} // namespace

/// Constructors run once: with this many classes, optimising them takes longer than running them.
constexpr std::size_t manyClasses = 100;

void compileConstructors(mlir::ModuleOp ir, const CompileOptions &options,
                         runtime::Program &program) {
  std::vector<std::string> names = {"rtsl_rt_Primitive_computeBounds"};
  addEmittedPower(program, names);
  for (const runtime::ClassInfo &info : program.classes) {
    names.push_back(initializeSymbol(info.name));
    names.push_back(constructSymbol(info.name));
  }
  run(ir, [](mlir::OpPassManager &passes) {
    passes.addPass(mlir::createSymbolDCEPass()); // keeps only the code that renders
    codegen::buildSsaPipeline(passes);
  });
  codegen::MachineOptions machine = machineOptions(options, /*hostCpu=*/true);
  machine.optimization =
      program.classes.size() > manyClasses ? 0 : std::min(machine.optimization, 1u);
  LlvmCode code = translate(ir, machine);
  defineFacts(code, options, program);
  linkDeviceCode(code, runtime::deviceBitcode(), names);
  std::vector<codegen::ObjectCode> objects;
  objects.push_back(toObject(std::move(code), options));
  load(std::move(objects), {}, options, program);
}

void compileHostCode(Compilation &compilation) {
  const CompileOptions &options = compilation.options;
  runtime::Program &program = *compilation.program;
  const bool isMegakernel = options.target == Target::HostMegakernel;
  std::vector<codegen::HostSymbol> symbols;
  if (!isMegakernel) {
    for (const char *name : {"rtsl_traverse", "rtsl_traverse_tree"})
      symbols.push_back({name, reinterpret_cast<void *>(&rtsl_traverse)});
    symbols.push_back({"rtsl_machine_stack", reinterpret_cast<void *>(&rtsl_machine_stack)});
  }
  std::vector<std::string> exports = entries(compilation);
  if (!compilation.isBound())
    addEmittedPower(program, exports);
  const std::vector<std::string_view> whole = {runtime::deviceBitcode()};
  PartCompiler compiler(*compilation.ir, options,
                        isMegakernel ? megakernelCode(/*forGpu=*/false) : whole, std::move(exports),
                        program);
  load(compiler.run(), std::move(symbols), options, program);
}

} // namespace driver

std::shared_ptr<const runtime::Program> compileProgram(const typed::Module &module,
                                                       const LinkRequest &request,
                                                       const CompileOptions &options,
                                                       Diagnostics &diagnostics,
                                                       const MakeObjects &makeObjects) {
  if (options.codeCache)
    options.codeCache->beginProgram();
  CompileInput input;
  input.module = &module;
  input.scene = &request;
  input.makeObjects = makeObjects;
  input.machineCode = &driver::machineCode();
  driver::Compilation compilation(input, options, diagnostics);
  compilation.usesThreads = true;
  return driver::reachProgram(compilation) ? compilation.program : nullptr;
}

} // namespace rtsl
