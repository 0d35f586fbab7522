//===- Shader.cpp - RTSL text that runs in a test -------------------------===//
#include "tests/unit/codegen/lower/Shader.h"

#include "codegen/emit/Jit.h"
#include "codegen/emit/LlvmModule.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/lower/Lower.h"
#include "codegen/passes/Pipeline.h"
#include "frontend/syntax/Parser.h"
#include "runtime/program/DeviceBitcode.h"
#include "sema/Sema.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/Verifier.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>

namespace rtsl::test {

//===----------------------------------------------------------------------===//
// Lowered
//===----------------------------------------------------------------------===//

static mlir::DialectRegistry dialects() {
  mlir::DialectRegistry registry;
  codegen::registerPassDependencies(registry);
  codegen::registerLlvmTranslation(registry);
  return registry;
}

struct Lowered::Parts {
  mlir::MLIRContext context{dialects(), mlir::MLIRContext::Threading::DISABLED};
  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  mlir::OwningOpRef<mlir::ModuleOp> ir;
};

Lowered::Lowered(const std::string &source, Options options, bool expectErrors)
    : parts(std::make_unique<Parts>()) {
  Parts &self = *parts;
  self.context.loadAllAvailableDialects();
  self.unit = parse(self.sources.add("test.rtsl", source), self.diagnostics);
  auto noImports = [](const ast::ImportDecl &, FileId) -> const ast::TranslationUnit * {
    return nullptr;
  };
  self.module = check({self.unit.get()}, noImports, self.diagnostics);
  EXPECT_FALSE(self.diagnostics.hasErrors()) << renderText(self.diagnostics, false);
  if (self.diagnostics.hasErrors())
    return;
  LowerOptions lowering;
  lowering.diagnostics = &self.diagnostics;
  lowering.colorComponents = options.colorComponents;
  lowering.checkIndices = options.checkIndices;
  lowering.classes = options.classes;
  self.ir = lower(*self.module, lowering, self.context);
  if (expectErrors) {
    EXPECT_FALSE(self.ir);
    return;
  }
  EXPECT_TRUE(self.ir) << renderText(self.diagnostics, false);
  if (!self.ir)
    return;
  std::string complaints;
  mlir::ScopedDiagnosticHandler collect(&self.context, [&](mlir::Diagnostic &diagnostic) {
    complaints += diagnostic.str() + "\n";
    return mlir::success();
  });
  EXPECT_TRUE(mlir::succeeded(mlir::verify(*self.ir))) << complaints << text();
}

Lowered::~Lowered() = default;

bool Lowered::succeeded() const {
  return static_cast<bool>(parts->ir);
}
const Diagnostics &Lowered::messages() const {
  return parts->diagnostics;
}

std::string Lowered::text(const std::string &function, bool withLocations) const {
  if (!succeeded())
    return "";
  std::string result;
  llvm::raw_string_ostream stream(result);
  mlir::OpPrintingFlags flags;
  flags.enableDebugInfo(withLocations);
  mlir::Operation *op = function.empty()
                            ? parts->ir->getOperation()
                            : mlir::SymbolTable::lookupSymbolIn(parts->ir.get(), function);
  if (op)
    op->print(stream, flags);
  return result;
}

bool Lowered::hasFunction(const std::string &function) const {
  return succeeded() && mlir::SymbolTable::lookupSymbolIn(parts->ir.get(), function);
}

std::size_t Lowered::count(const std::string &function, const std::string &part) const {
  std::string all = text(function);
  EXPECT_FALSE(all.empty()) << "no function " << function;
  std::size_t number = 0;
  for (std::size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + 1))
    ++number;
  return number;
}

//===----------------------------------------------------------------------===//
// Shader
//===----------------------------------------------------------------------===//

/// What linking derives from `intersect`, which these programs are made without.
static void deriveNothing(RtslState *, RtslRef) {}

struct Shader::Code {
  std::unique_ptr<codegen::Jit> jit;
};

static void runPasses(mlir::ModuleOp ir, void (*build)(mlir::OpPassManager &)) {
  mlir::PassManager passes(ir.getContext());
  build(passes);
  ASSERT_TRUE(mlir::succeeded(passes.run(ir)));
}

template <typename T>
static T take(llvm::Expected<T> expected) {
  if (expected)
    return std::move(*expected);
  ADD_FAILURE() << llvm::toString(expected.takeError());
  return T();
}

// Shaders of these tests trace nothing.
extern "C" uint32_t testTraverse(RtslState *, uint32_t) {
  return 0;
}

Shader::Shader(const std::string &source, Options options) : code(std::make_unique<Code>()) {
  state.launch = &launch;
  Lowered lowered(source, options);
  if (!lowered.succeeded() || ::testing::Test::HasFailure())
    return;
  mlir::ModuleOp program = *lowered.parts->ir;
  std::vector<std::string> exports;
  for (auto function : program.getOps<mlir::func::FuncOp>())
    if (!function.isPrivate()) {
      ir::attr::exported.set(function);
      exports.push_back(function.getName().str());
    }
  // What linking does in a real program.
  std::map<std::string, std::uint32_t> offsets;
  std::uint32_t words = 0;
  program.walk([&](ir::AttributeOp op) {
    auto [place, isNew] = offsets.try_emplace(op.getName().str(), words);
    if (isNew)
      words += ir::sizeInBytes(llvm::cast<ir::PtrType>(op.getType()).getPointee()) / 4;
    op.setOffset(place->second);
  });
  runPasses(program, codegen::buildSsaPipeline);
  runPasses(program, codegen::buildLlvmPipeline);
  if (::testing::Test::HasFatalFailure())
    return;

  auto context = std::make_unique<llvm::LLVMContext>();
  codegen::MachineOptions machine;
  machine.optimization = 1;
  auto target = take(codegen::createTargetMachine(machine));
  auto module = take(codegen::translateToLlvm(program, *context, *target));
  if (!module)
    return;
  if (llvm::Error error = codegen::linkDeviceCode(*module, runtime::deviceBitcode(), exports)) {
    ADD_FAILURE() << llvm::toString(std::move(error));
    return;
  }
  codegen::optimize(*module, *target, machine);
  code->jit = take(codegen::Jit::create(
      std::move(context), std::move(module), std::move(target),
      {{"rtsl_traverse", reinterpret_cast<void *>(&testTraverse)},
       {"rtsl_rt_Primitive_rt_boundHitError", reinterpret_cast<void *>(&deriveNothing)},
       {"rtsl_rt_Primitive_rt_computeChanges", reinterpret_cast<void *>(&deriveNothing)}}));
}

Shader::~Shader() = default;

void *Shader::find(const std::string &name) {
  void *address = code->jit ? code->jit->lookup(name) : nullptr;
  EXPECT_NE(address, nullptr) << "no function `" << name << "`";
  return address;
}

//===----------------------------------------------------------------------===//
// Outcome and FloatFunction
//===----------------------------------------------------------------------===//

/// With RTSL_RECORD=FILE every program that these run is written to the file with what went in and
/// what came out, so that tests/cpp can ask the same of printed C++.
class Recorder {
public:
  static void source(const std::string &text) {
    if (std::FILE *file = output())
      std::fprintf(file, "source %zu\n%s\n", text.size(), text.c_str());
  }
  template <typename T>
  static void values(const char *when, const char *type, const std::array<T, 16> &all) {
    std::FILE *file = output();
    if (!file)
      return;
    std::fprintf(file, "%s %s", when, type);
    for (T value : all) {
      std::uint32_t bits;
      std::memcpy(&bits, &value, 4);
      std::fprintf(file, " %08x", bits);
    }
    std::fprintf(file, "\n");
  }

private:
  static std::FILE *output() {
    static const char *path = std::getenv("RTSL_RECORD");
    static std::FILE *file = path ? std::fopen(path, "a") : nullptr;
    return file;
  }
};

Outcome::Outcome(const std::string &body, std::initializer_list<float> floats,
                 std::initializer_list<std::int64_t> integers, Options options)
    : Outcome(with("", body, floats, integers, std::move(options))) {}

Outcome Outcome::with(const std::string &declarations, const std::string &body,
                      std::initializer_list<float> floats,
                      std::initializer_list<std::int64_t> integers, Options options) {
  Outcome run;
  std::copy(floats.begin(), floats.end(), run.x.begin());
  std::size_t i = 0;
  for (std::int64_t integer : integers) {
    run.n[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(integer));
    run.u[i++] = static_cast<std::uint32_t>(integer);
  }
  const std::string source =
      declarations + "\nvoid run(inout float x[16], inout int n[16], inout uint u[16]) {\n" + body +
      "\n}\n";
  if (options.checkIndices && options.colorComponents == 3)
    Recorder::source(source);
  auto record = [&](const char *when) {
    if (!options.checkIndices || options.colorComponents != 3)
      return;
    Recorder::values(when, "float", run.x);
    Recorder::values(when, "int", run.n);
    Recorder::values(when, "uint", run.u);
  };
  record("before");
  Shader shader(source, options);
  shader.call("run", run.x.data(), run.n.data(), run.u.data());
  record("after");
  return run;
}

FloatFunction::FloatFunction(const std::string &body, Options options)
    : source("void run(inout float x[16]) {\n" + body + "\n}\n"),
      shader(source, std::move(options)) {}

std::array<float, 16> FloatFunction::operator()(std::initializer_list<float> inputs) {
  return (*this)(std::vector<float>(inputs));
}

std::array<float, 16> FloatFunction::operator()(const std::vector<float> &inputs) {
  std::array<float, 16> x{};
  std::copy(inputs.begin(), inputs.end(), x.begin());
  const bool isRecorded = ++calls <= 40; // enough of each
  if (isRecorded) {
    Recorder::source(source);
    Recorder::values("before", "float", x);
  }
  shader.call("run", x.data());
  if (isRecorded)
    Recorder::values("after", "float", x);
  return x;
}

//===----------------------------------------------------------------------===//
// Numbers
//===----------------------------------------------------------------------===//

double ulps(float value, double expected) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (std::isnan(expected) || std::isnan(value))
    return std::isnan(expected) && std::isnan(value) ? 0 : infinity;
  if (std::isinf(value) || std::isinf(expected))
    return static_cast<double>(value) == expected ||
                   (std::isinf(value) && std::abs(expected) > FLT_MAX &&
                    std::signbit(value) == std::signbit(expected))
               ? 0
               : infinity;
  int exponent = -126;
  if (std::abs(expected) >= 0x1p-126)
    exponent = std::ilogb(expected);
  return std::abs(static_cast<double>(value) - expected) / std::ldexp(1.0, exponent - 23);
}

std::vector<float> interestingFloats() {
  std::vector<float> positive = {0.0F,
                                 1e-45F,
                                 1.1e-44F,
                                 1e-40F,
                                 1.17549421e-38F,
                                 FLT_MIN,
                                 1e-30F,
                                 1e-10F,
                                 0.1F,
                                 0.25F,
                                 0.49999997F,
                                 0.5F,
                                 0.75F,
                                 0.99999994F,
                                 1.0F,
                                 1.0000001F,
                                 1.5F,
                                 2.0F,
                                 2.5F,
                                 2.9999998F,
                                 3.0F,
                                 10.3F,
                                 127.5F,
                                 1000.75F,
                                 65536.5F,
                                 4194303.5F,
                                 4194304.5F,
                                 8388607.5F,
                                 8388608.0F,
                                 8388609.0F,
                                 16777217.0F,
                                 1e10F,
                                 2147483648.0F,
                                 4294967296.0F,
                                 1e20F,
                                 1e30F,
                                 FLT_MAX,
                                 std::numeric_limits<float>::infinity(),
                                 std::numeric_limits<float>::quiet_NaN()};
  std::vector<float> all = positive;
  for (float value : positive)
    all.push_back(-value);
  return all;
}

} // namespace rtsl::test
