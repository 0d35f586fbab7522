// Shaders that call trace() against the same shaders split there: the colors have to be the same,
// bit for bit.
#include "RandomShader.h"

#include "codegen/emit/Jit.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/Split.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Divisor.h"
#include "runtime/program/DeviceBitcode.h"

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

/// What linking derives from `intersect`, which these programs are made without.
void deriveNothing(RtslState *, RtslRef) {}

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

/// The stack of rays, of the requested size, and how far it was written.
struct Stack {
  static constexpr uint8_t untouched = 0xa5;
  uint8_t *memory = nullptr; // AddressSanitizer watches its end
  uint64_t bytes = 0;
  uint64_t written = 0; // bytes, the most of all samples

  void look() {
    for (uint64_t i = bytes; i-- > written;)
      if (memory[i] != untouched)
        written = i + 1;
  }
} stack;

void *machineStack(uint64_t bytes) {
  stack.look();
  std::free(stack.memory);
  stack.bytes = (bytes + 15) / 16 * 16;
  stack.memory = static_cast<uint8_t *>(std::aligned_alloc(16, stack.bytes));
  std::memset(stack.memory, Stack::untouched, stack.bytes);
  return stack.memory;
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
    auto made = codegen::Jit::create(
        std::move(llvmContext), std::move(module), std::move(machine),
        {{"rtsl_traverse", reinterpret_cast<void *>(&traverse)},
         {"rtsl_rt_Primitive_rt_boundHitError", reinterpret_cast<void *>(&deriveNothing)},
         {"rtsl_rt_Primitive_rt_computeChanges", reinterpret_cast<void *>(&deriveNothing)},
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
      instances[i].needs = RTSL_NEEDS_NORMALS; // rays leave from hits
    }
    RtslLaunch launch = {};
    launch.records = reinterpret_cast<uint8_t *>(&memory);
    launch.instances = instances;
    launch.instanceCount = 2;
    launch.background = 32;
    launch.needs = RTSL_NEEDS_NORMALS;
    launch.colorComponents = 3;
    launch.maxDepth = maxDepth;
    rtsl::device::setLaunchSize(launch, 4, 4, 1);
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

/// A module with this `shade` and `closestHit`; a miss leaves what it finds.
std::string mirrors(const std::string &shade, const std::string &closestHit) {
  std::string text = R"(
rtsl.class @A root "rt_Material" { rtsl.member_decl @m : f32 access "public" }
func.func private @A.shade(%self: !rtsl.ref<"A">) attributes {rtsl.class = "A", rtsl.method = "shade"} {
  %place = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %p = rtsl.load %place : !rtsl.ptr<vector<3xf32>>
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %near = arith.constant 0.0 : f32
  %far = arith.constant 9.0 : f32
)" + shade + R"(
  rtsl.return
}
func.func private @A.closestHit.P(%self: !rtsl.ref<"A">) attributes {rtsl.class = "A", rtsl.method = "closestHit.P"} {
  %place = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %p = rtsl.load %place : !rtsl.ptr<vector<3xf32>>
  %near = arith.constant 0.0 : f32
  %far = arith.constant 9.0 : f32
  %own = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
)" + closestHit + R"(
  rtsl.return
}
func.func @rtsl_rt_Material_shade(%o: !rtsl.ref<"rt_Material">) attributes {rtsl.export, rtsl.slot = "rt_Material.shade"} {
  %a = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"A">
  func.call @A.shade(%a) : (!rtsl.ref<"A">) -> ()
  rtsl.return
}
func.func @rtsl_rt_Material_closestHit_payload(%o: !rtsl.ref<"rt_Material">) attributes {rtsl.export, rtsl.slot = "rt_Material.closestHit.payload"} {
  %a = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"A">
  func.call @A.closestHit.P(%a) : (!rtsl.ref<"A">) -> ()
  rtsl.return
}
func.func @rtsl_rt_Camera_generateRay(%o: !rtsl.ref<"object">) attributes {rtsl.export} {
  %direction = rtsl.state "RayDirection" : !rtsl.ptr<vector<3xf32>>
  %screen = rtsl.state "ScreenCoord" : !rtsl.ptr<vector<2xf32>>
  %at = rtsl.load %screen : !rtsl.ptr<vector<2xf32>>
  %one = arith.constant dense<1.0> : vector<2xf32>
  %d = vector.shuffle %at, %one [0, 1, 2] : vector<2xf32>, vector<2xf32>
  rtsl.store %d, %direction : !rtsl.ptr<vector<3xf32>>
  rtsl.return
}
)";
  // As linking makes them where no class has the method: they do nothing.
  for (const char *slot : {"rt_Exception_exception", "rt_Miss_miss", "rt_Miss_miss_payload",
                           "rt_RayGeneration_generate", "rt_Primitive_computeNormal",
                           "rt_Primitive_computeTextureCoordinates",
                           "rt_Primitive_computeDerivatives", "rt_Light_illumination"})
    text += std::string("func.func @rtsl_") + slot +
            "(%o: !rtsl.ref<\"object\">) attributes {rtsl.export} {\n  rtsl.return\n}\n";
  return text;
}

const std::string waiting = R"(
  %c = rtsl.trace %p, %p : vector<3xf32>
  %d = arith.mulf %c, %c : vector<3xf32>
  rtsl.store %d, %color : !rtsl.ptr<vector<3xf32>>
)";
const std::string last = R"(
  %c = rtsl.trace %p, %p : vector<3xf32>
  rtsl.store %c, %color : !rtsl.ptr<vector<3xf32>>
)";
const std::string sendsPayload = R"(
  %q = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %x = rtsl.field %q["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %far, %x : !rtsl.ptr<f32>
  rtsl.trace_payload %p, %p from %near to %far carries %q {ray_type = 1 : i32, how = 0 : i32} : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %y = rtsl.load %x : !rtsl.ptr<f32>
  %c = vector.broadcast %y : f32 to vector<3xf32>
  rtsl.store %c, %color : !rtsl.ptr<vector<3xf32>>
)";
const std::string passesPayload = R"(
  %q = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.copy %own to %q : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.trace_payload %p, %p from %near to %far carries %q {ray_type = 1 : i32, how = 0 : i32} : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.copy %q to %own : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
)";
const std::string waitsForPayload = R"(
  %q = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.copy %own to %q : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.trace_payload %p, %p from %near to %far carries %q {ray_type = 1 : i32, how = 0 : i32} : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %x = rtsl.field %q["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  %y = rtsl.load %x : !rtsl.ptr<f32>
  %z = arith.addf %y, %far : f32
  %w = rtsl.field %own["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %z, %w : !rtsl.ptr<f32>
)";

/// A number from the environment: more programs than every run has time for.
unsigned asked(const char *name, unsigned otherwise) {
  const char *text = std::getenv(name);
  return text ? unsigned(std::atoi(text)) : otherwise;
}

TEST(Machine, RandomShadersGiveTheSameBitsSplitAndRecursively) {
  unsigned saved = 0, traces = 0;
  raysTraced = 0;
  const unsigned first = asked("RTSL_FIRST_RANDOM_PROGRAM", 0);
  const unsigned count = asked("RTSL_RANDOM_PROGRAMS", 5);
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

/// The stack has exactly the levels that samples use: each ray that waits has one, and the ray
/// whose turn it is has room for its frame. So the last level but one is written, and nothing
/// behind the stack (as AddressSanitizer would see).
TEST(Machine, TheStackIsAsLargeAsSamplesNeed) {
  struct Case {
    const char *name;
    std::string shade, closestHit;
    uint32_t (*levels)(uint32_t depth);
  } cases[] = {
      {"waits", waiting, "", [](uint32_t depth) { return depth + 1; }},
      {"last", last, "", [](uint32_t) { return 1u; }},
      {"a payload that is passed on", sendsPayload, passesPayload,
       [](uint32_t depth) { return depth == 0 ? 1u : 2u; }},
      {"a payload that is waited for", sendsPayload, waitsForPayload,
       [](uint32_t depth) { return depth + 1; }},
      {"a payload, and no more", sendsPayload, "",
       [](uint32_t depth) { return depth == 0 ? 1u : 2u; }},
  };
  for (const Case &one : cases) {
    SCOPED_TRACE(one.name);
    const SplitOptions options;
    const std::string text = mirrors(one.shade, one.closestHit);
    Program recursive(text, nullptr), split(text, &options);
    ASSERT_TRUE(recursive && split);
    for (uint32_t depth : {0u, 1u, 2u, 5u}) {
      const std::vector<uint32_t> expected = recursive.render(depth);
      stack.bytes = stack.written = 0;
      ASSERT_EQ(expected, split.render(depth)) << depth;
      stack.look();
      const uint64_t level = split.report.levelBytes();
      EXPECT_EQ(stack.bytes, one.levels(depth) * level) << depth;
      EXPECT_EQ(split.report.rays.levels(depth), one.levels(depth)) << depth;
      if (one.levels(depth) > 1) {
        EXPECT_GT(stack.written, (one.levels(depth) - 2) * level) << depth;
      }
    }
  }
}

} // namespace
