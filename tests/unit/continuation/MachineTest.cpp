// Shaders that call trace() against the same shaders split there: the colors have to be the same,
// bit for bit.
#include "RandomShader.h"

#include "codegen/emit/ConvertToLlvm.h"
#include "codegen/emit/Jit.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/Split.h"
#include "runtime/DeviceBitcode.h"
#include "runtime/device/Abi.h"

#include "mlir/IR/MLIRContext.h"
#include "mlir/Parser/Parser.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

using namespace rtsl;

namespace {

unsigned raysTraced = 0;

/// A scene in which what a ray meets depends on its bits alone.
uint32_t traverse(RtslState *state, uint32_t) {
  ++raysTraced;
  uint32_t hash = 2166136261u;
  auto mix = [&](const float *values, int count) {
    for (int i = 0; i < count; ++i) {
      if (!std::isfinite(values[i]))
        return false;
      uint32_t bits;
      std::memcpy(&bits, &values[i], sizeof bits);
      hash = (hash ^ bits ^ bits >> 16) * 16777619u;
    }
    return true;
  };
  if (!mix(state->RayOrigin, 3) || !mix(state->RayDirection, 3))
    return RTSL_BAD_RAY;
  hash ^= hash >> 15;
  if (hash % 5 == 0)
    return RTSL_MISS;
  state->instance = hash % 2;
  state->primitive = 0;
  state->HitDistance = float(hash >> 8 & 255) / 64.0f;
  return RTSL_HIT;
}

void *machineStack(uint64_t bytes) {
  // As large as was asked for and not a byte more.
  static void *memory = nullptr;
  std::free(memory);
  return memory = std::aligned_alloc(16, (bytes + 15) / 16 * 16);
}

/// A module of level 1 that runs, recursively or split.
class Program {
public:
  Program(const std::string &text, const SplitOptions *split, bool keepMethods = true) {
    mlir::DialectRegistry registry;
    codegen::registerPassDependencies(registry);
    codegen::registerLlvmTranslation(registry);
    mlir::MLIRContext context(registry, mlir::MLIRContext::Threading::DISABLED);
    context.loadAllAvailableDialects();
    auto ir = mlir::parseSourceString<mlir::ModuleOp>(text, &context);
    if (!ir)
      return;
    if (split && keepMethods)
      keepTracingMethods(*ir);
    mlir::PassManager toSsa(&context), toLlvm(&context);
    codegen::buildSsaPipeline(toSsa);
    codegen::buildLlvmPipeline(toLlvm);
    if (mlir::failed(toSsa.run(*ir)))
      return;
    if (split && !splitAtTrace(*ir, *split, report))
      return;
    if (mlir::failed(toLlvm.run(*ir)))
      return;
    codegen::MachineOptions options;
    options.optimization = 1;
    auto machine = llvm::cantFail(codegen::createTargetMachine(options));
    auto llvmContext = std::make_unique<llvm::LLVMContext>();
    auto module = llvm::cantFail(codegen::translateToLlvm(*ir, *llvmContext, *machine));
    std::string entry = split ? "rtsl_sample_split" : "rtsl_sample";
    llvm::cantFail(codegen::linkDeviceCode(*module, runtime::deviceBitcode(), {entry}));
    codegen::optimize(*module, *machine, options);
    auto made =
        codegen::Jit::create(std::move(llvmContext), std::move(module), std::move(machine),
                             {{"rtsl_traverse", reinterpret_cast<void *>(&traverse)},
                              {"rtsl_machine_stack", reinterpret_cast<void *>(&machineStack)}});
    if (!made) {
      ADD_FAILURE() << llvm::toString(made.takeError());
      return;
    }
    jit = std::move(*made);
    sample = reinterpret_cast<Sample *>(jit->lookup(entry));
  }

  /// The colors of a few pixels, NaNs made one.
  std::vector<uint32_t> render(uint32_t maxDepth) const {
    struct Record {
      uint32_t classId;
      float m;
    };
    alignas(16) struct {
      uint32_t none[4] = {0, 0, 0, 0};
      Record records[4] = {{1, 0.5f}, {2, -1.25f}, {3, 2.0f}, {9, 0}};
    } memory;
    RtslInstance instances[2] = {};
    for (uint32_t i = 0; i < 2; ++i) {
      instances[i].primitive = 40;
      instances[i].material = 16 + 8 * i;
      instances[i].firstPrimitive = i;
    }
    RtslLaunch launch = {};
    launch.records = reinterpret_cast<uint8_t *>(&memory);
    launch.instances = instances;
    launch.instanceCount = 2;
    launch.background = 32;
    launch.colorComponents = 3;
    launch.maxDepth = maxDepth;
    launch.width = launch.height = 4;
    launch.seed = 7;
    std::vector<uint32_t> bits;
    for (uint32_t pixel = 0; pixel < 16; ++pixel) {
      float color[RTSL_MAX_COLOR] = {};
      sample(&launch, pixel % 4, pixel / 4, 0, color);
      for (int i = 0; i < 3; ++i) {
        uint32_t word;
        std::memcpy(&word, &color[i], sizeof word);
        bits.push_back(std::isnan(color[i]) ? 0x7fc00000u : word);
      }
    }
    return bits;
  }

  explicit operator bool() const { return sample; }
  SplitReport report;

private:
  using Sample = void(const RtslLaunch *, uint32_t, uint32_t, uint32_t, float *);
  std::unique_ptr<codegen::Jit> jit;
  Sample *sample = nullptr;
};

struct Configuration {
  const char *name;
  SplitOptions options;
  bool keepMethods;
};

std::vector<Configuration> configurations() {
  SplitOptions all, plain, noCleanUp;
  plain.rematerialise = plain.trim = plain.cleanUp = false;
  noCleanUp.cleanUp = false;
  return {{"all", all, true},
          {"plain", plain, true},
          {"entries", all, false},
          {"no clean-up", noCleanUp, false}};
}

/// A number from the environment: more programs than every run has time for.
unsigned asked(const char *name, unsigned otherwise) {
  const char *text = std::getenv(name);
  return text ? unsigned(std::atoi(text)) : otherwise;
}

TEST(Machine, RandomShadersGiveTheSameBitsSplitAndRecursively) {
  unsigned saved = 0, traces = 0;
  raysTraced = 0;
  const unsigned first = asked("RTSL_FIRST_RANDOM_PROGRAM", 0);
  const unsigned count = asked("RTSL_RANDOM_PROGRAMS", 12);
  std::vector<Configuration> ways = configurations();
  for (uint32_t seed = first; seed < first + count; ++seed) {
    std::string text = test::randomModule(seed);
    Program recursive(text, nullptr);
    ASSERT_TRUE(recursive) << "seed " << seed << "\n" << text;
    // Each program in all ways would take long; each way gets its share.
    for (size_t way : {size_t(0), 1 + seed % (ways.size() - 1)}) {
      Program split(text, &ways[way].options, ways[way].keepMethods);
      ASSERT_TRUE(split) << "seed " << seed << ", " << ways[way].name << "\n" << text;
      for (uint32_t depth : {0u, 1u, 3u}) {
        ASSERT_EQ(recursive.render(depth), split.render(depth))
            << "seed " << seed << ", depth " << depth << ", " << ways[way].name << "\n"
            << text;
      }
      for (const FunctionReport &function : split.report.functions)
        for (const TraceReport &trace : function.traces) {
          ++traces;
          saved += trace.savedBytes;
          EXPECT_LE(trace.savedBytes, function.frame.size);
        }
    }
  }
  // The shaders do trace, and something survives.
  EXPECT_GT(raysTraced, 100 * count);
  EXPECT_GT(traces, 2 * count);
  EXPECT_GT(saved, 0u);
}

} // namespace
