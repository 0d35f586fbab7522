// From IR as text to code that runs: what the optimiser and the machine make of it.
#include "codegen/emit/Jit.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/passes/Pipeline.h"
#include "math/Elementary.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/program/DeviceBitcode.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/Parser/Parser.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

using namespace rtsl;
using namespace rtsl::codegen;

namespace {

uint32_t bits(float x) {
  uint32_t result;
  std::memcpy(&result, &x, sizeof result);
  return result;
}

/// Compiles IR of level 1 or 2; the error, if there is one, is in `error`.
struct Program {
  explicit Program(const std::string &text, const std::vector<HostSymbol> &symbols = {},
                   const std::vector<std::string> &exports = {"f"}, bool withDevice = false,
                   unsigned optimization = 2) {
    mlir::DialectRegistry registry;
    registerPassDependencies(registry);
    registerLlvmTranslation(registry);
    mlir::MLIRContext context(registry, mlir::MLIRContext::Threading::DISABLED);
    context.loadAllAvailableDialects();
    auto ir = mlir::parseSourceString<mlir::ModuleOp>(text, &context);
    if (!ir) {
      error = "does not parse";
      return;
    }
    mlir::PassManager passes(&context);
    buildSsaPipeline(passes);
    buildLlvmPipeline(passes);
    if (mlir::failed(passes.run(*ir))) {
      error = "passes failed";
      return;
    }
    MachineOptions options;
    options.optimization = optimization;
    auto machine = llvm::cantFail(createTargetMachine(options));
    auto llvmContext = std::make_unique<llvm::LLVMContext>();
    auto module = llvm::cantFail(translateToLlvm(*ir, *llvmContext, *machine));
    if (withDevice)
      llvm::cantFail(linkDeviceCode(*module, runtime::deviceBitcode(), exports));
    optimize(*module, *machine, options);
    text_ = printLlvm(*module);
    auto made = Jit::create(std::move(llvmContext), std::move(module), std::move(machine), symbols);
    if (made)
      jit = std::move(*made);
    else
      error = llvm::toString(made.takeError());
  }
  template <typename F>
  F *get(const std::string &name = "f") const {
    EXPECT_EQ(error, "");
    return jit ? reinterpret_cast<F *>(jit->lookup(name)) : nullptr;
  }
  std::unique_ptr<Jit> jit;
  std::string error, text_;
};

constexpr int32_t smallest = std::numeric_limits<int32_t>::min();
constexpr int32_t largest = std::numeric_limits<int32_t>::max();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

std::string division(const std::string &op) {
  return "func.func @f(%a: i32, %b: i32) -> i32 attributes {rtsl.export} { %q = rtsl." + op +
         " %a, %b : i32\n return %q : i32 }";
}

// At every level: a division that traps in one of them would end the test.
TEST(Jit, DivisionIsDefinedForAllOperands) {
  using F = int32_t(RtslState *, int32_t, int32_t);
  RtslState state = {};
  for (unsigned level : {0u, 2u}) {
    Program sdiv(division("sdiv"), {}, {"f"}, false, level);
    Program srem(division("srem"), {}, {"f"}, false, level);
    Program udiv(division("udiv"), {}, {"f"}, false, level);
    Program urem(division("urem"), {}, {"f"}, false, level);
    F *q = sdiv.get<F>(), *r = srem.get<F>(), *uq = udiv.get<F>(), *ur = urem.get<F>();
    EXPECT_EQ(q(&state, -7, 2), -3);
    EXPECT_EQ(r(&state, -7, 2), -1);
    EXPECT_EQ(q(&state, smallest, -1), smallest);
    EXPECT_EQ(r(&state, smallest, -1), 0);
    EXPECT_EQ(uq(&state, -7, 2), 2147483644);
    EXPECT_EQ(ur(&state, -7, 10), 9);
    for (int32_t a : {0, 1, -1, smallest, largest}) {
      EXPECT_EQ(q(&state, a, 0), 0);
      EXPECT_EQ(r(&state, a, 0), 0);
      EXPECT_EQ(uq(&state, a, 0), 0);
      EXPECT_EQ(ur(&state, a, 0), 0);
    }
  }
}

TEST(Jit, FloatToIntegerSaturates) {
  RtslState state = {};
  Program sint("func.func @f(%x: f32) -> i32 attributes {rtsl.export} {"
               " %i = rtsl.to_sint %x : f32\n return %i : i32 }");
  Program uint("func.func @f(%x: f32) -> i32 attributes {rtsl.export} {"
               " %i = rtsl.to_uint %x : f32\n return %i : i32 }");
  auto *toSint = sint.get<int32_t(RtslState *, float)>();
  auto *toUint = uint.get<uint32_t(RtslState *, float)>();
  EXPECT_EQ(toSint(&state, -2.75f), -2);
  EXPECT_EQ(toSint(&state, 1e30f), largest);
  EXPECT_EQ(toSint(&state, -infinity), smallest);
  EXPECT_EQ(toSint(&state, nan), 0);
  EXPECT_EQ(toUint(&state, 3e9f), 3000000000u);
  EXPECT_EQ(toUint(&state, -1.f), 0u);
  EXPECT_EQ(toUint(&state, infinity), 0xffffffffu);
  EXPECT_EQ(toUint(&state, nan), 0u);
}

TEST(Jit, ArithmeticIsStrict) {
  // a * b + c in two roundings; fused, or reassociated, it would be another number.
  RtslState state = {};
  Program program("func.func @f(%a: f32, %b: f32, %c: f32) -> f32 attributes {rtsl.export} {"
                  " %m = arith.mulf %a, %b : f32\n %s = arith.addf %m, %c : f32\n"
                  " return %s : f32 }");
  auto *f = program.get<float(RtslState *, float, float, float)>();
  float a = 1.f + 0x1p-12f;
  EXPECT_EQ(f(&state, a, a, -(1.f + 0x1p-11f)), 0.f);
  EXPECT_NE(std::fma(a, a, -(1.f + 0x1p-11f)), 0.f);
}

TEST(Jit, RecordsHoldMembersAtTheOffsetsOfTheLayout) {
  Program program(R"(
    rtsl.class @A root "rt_Primitive" {
      rtsl.member_decl @flip : i1 access "public"
      rtsl.member_decl @center : vector<3xf32> access "public"
      rtsl.member_decl @table : !rtsl.buffer<vector<2xf32>, 2> access "public"
      rtsl.member_decl @sum : f32 access "private"
    }
    func.func @A.construct(%self: !rtsl.ref<"A">) attributes {rtsl.constructor, rtsl.export} {
      %one = arith.constant 1.0 : f32
      %sum = rtsl.member %self["sum"] : !rtsl.ref<"A"> -> !rtsl.ptr<f32>
      rtsl.store %one, %sum : !rtsl.ptr<f32>
      %s = func.call @A.total(%self) : (!rtsl.ref<"A">) -> f32
      rtsl.store %s, %sum : !rtsl.ptr<f32>
      rtsl.return
    }
    func.func private @A.total(%self: !rtsl.ref<"A">) -> f32 {
      %sum = rtsl.member %self["sum"] : !rtsl.ref<"A"> -> !rtsl.ptr<f32>
      %s = rtsl.load %sum : !rtsl.ptr<f32>
      %c = rtsl.member %self["center"] : !rtsl.ref<"A"> -> !rtsl.ptr<vector<3xf32>>
      %v = rtsl.load %c : !rtsl.ptr<vector<3xf32>>
      %z = vector.extract %v[2] : f32 from vector<3xf32>
      %t = arith.addf %s, %z : f32
      rtsl.return %t : f32
    }
    func.func @f(%self: !rtsl.ref<"A">, %i: i32, %j: i32) -> f32 attributes {rtsl.export} {
      %zero = arith.constant 0.0 : f32
      %b = rtsl.member %self["table"] : !rtsl.ref<"A"> -> !rtsl.ptr<!rtsl.buffer<vector<2xf32>, 2>>
      %p = rtsl.buffer_element %b[%i, %j] : !rtsl.ptr<!rtsl.buffer<vector<2xf32>, 2>> -> !rtsl.ptr<vector<2xf32>>
      %v = rtsl.load %p : !rtsl.ptr<vector<2xf32>>
      %y = vector.extract %v[1] : f32 from vector<2xf32>
      %fp = rtsl.member %self["flip"] : !rtsl.ref<"A"> -> !rtsl.ptr<i1>
      %flip = rtsl.load %fp : !rtsl.ptr<i1>
      rtsl.if %flip {
        %n = arith.negf %y : f32
        rtsl.return %n : f32
      }
      rtsl.return %y : f32
    })",
                  {}, {"f", "A.construct"});
  struct Record {
    uint32_t classId;
    uint32_t flip;
    float center[3];
    RtslBuffer table;
    float sum;
  };
  float elements[2][3][2] = {{{0, 1}, {2, 3}, {4, 5}}, {{6, 7}, {8, 9}, {10, 11}}};
  alignas(8) unsigned char memory[16 + sizeof(Record)] = {};
  Record record = {1, 0, {10, 20, 30}, {}, 0};
  auto address = reinterpret_cast<uint64_t>(elements);
  record.table = {uint32_t(address), uint32_t(address >> 32), {2, 3, 1}};
  std::memcpy(memory + 16, &record, sizeof record);
  RtslLaunch launch = {};
  launch.records = memory;
  RtslState state = {};
  state.launch = &launch;

  auto *f = program.get<float(RtslState *, RtslRef, int32_t, int32_t)>();
  EXPECT_EQ(f(&state, 16, 0, 2), 5.f);
  EXPECT_EQ(f(&state, 16, 1, 0), 7.f);
  memory[16 + offsetof(Record, flip)] = 1;
  EXPECT_EQ(f(&state, 16, 1, 2), -11.f);

  // A constructor sees what it wrote, also through what it calls.
  program.get<void(RtslState *, RtslRef)>("A.construct")(&state, 16);
  std::memcpy(&record, memory + 16, sizeof record);
  EXPECT_EQ(record.sum, 31.f);
}

TEST(Jit, ClassOfNothingNeedsNoRecords) {
  Program program("func.func @f(%r: !rtsl.ref<\"rt_Texture\">) -> i32 attributes {rtsl.export} {"
                  " %id = rtsl.class_id %r : !rtsl.ref<\"rt_Texture\">\n return %id : i32 }");
  auto *f = program.get<uint32_t(RtslState *, RtslRef)>();
  RtslLaunch launch = {};
  RtslState state = {};
  state.launch = &launch;
  EXPECT_EQ(f(&state, 0), 0u);
  uint32_t records[3] = {77, 5, 6};
  launch.records = reinterpret_cast<uint8_t *>(records);
  EXPECT_EQ(f(&state, 0), 0u);
  EXPECT_EQ(f(&state, 8), 6u);
}

void recordTrace(RtslState *state, float ox, float oy, float oz, float dx, float dy, float dz,
                 float *color) {
  float *seen = state->BoundMin; // six floats: BoundMin and BoundMax
  static_assert(offsetof(RtslState, BoundMax) == offsetof(RtslState, BoundMin) + 12);
  float values[] = {ox, oy, oz, dx, dy, dz};
  std::memcpy(seen, values, sizeof values);
  color[0] = 1, color[1] = 2, color[2] = 3;
}
uint32_t lightEven(RtslState *state, uint32_t index, float px, float, float, float, float, float nz,
                   float cosAngle) {
  state->LightColor[0] = float(index) + px + nz + cosAngle;
  return index % 2 == 0;
}

TEST(Jit, RaysGoThroughTheRuntime) {
  Program program(R"(
    func.func @f(%o: vector<3xf32>, %d: vector<3xf32>) -> vector<3xf32> attributes {rtsl.export} {
      %c = rtsl.trace %o, %d : vector<3xf32>
      rtsl.return %c : vector<3xf32>
    }
    func.func @entry() attributes {rtsl.export} {
      %op = rtsl.state "RayOrigin" : !rtsl.ptr<vector<3xf32>>
      %o = rtsl.load %op : !rtsl.ptr<vector<3xf32>>
      %dp = rtsl.state "RayDirection" : !rtsl.ptr<vector<3xf32>>
      %d = rtsl.load %dp : !rtsl.ptr<vector<3xf32>>
      %c = func.call @f(%o, %d) : (vector<3xf32>, vector<3xf32>) -> vector<3xf32>
      %sp = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
      rtsl.store %c, %sp : !rtsl.ptr<vector<3xf32>>
      rtsl.return
    })",
                  {{"rtsl_trace", reinterpret_cast<void *>(&recordTrace)}}, {"f", "entry"});
  RtslState state = {};
  for (int i = 0; i < 3; ++i)
    state.RayOrigin[i] = 1.f + i, state.RayDirection[i] = 4.f + i;
  program.get<void(RtslState *)>("entry")(&state);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(state.BoundMin[i], 1.f + i);
    EXPECT_EQ(state.BoundMax[i], 4.f + i);
    EXPECT_EQ(state.SampleColor[i], 1.f + i);
  }
  EXPECT_EQ(state.SampleColor[3], 0.f) << "a color of three components is three floats";
}

TEST(Jit, IlluminanceRunsForTheLightsThatArrive) {
  // Sums LightColor over lights; leaves at the first that is greater than 100.
  Program program(R"(
    func.func @f() -> f32 attributes {rtsl.export} {
      %hundred = arith.constant 100.0 : f32
      %half = arith.constant 0.5 : f32
      %pp = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
      %p = rtsl.load %pp : !rtsl.ptr<vector<3xf32>>
      %np = rtsl.state "ShadingNormal" : !rtsl.ptr<vector<3xf32>>
      %n = rtsl.load %np : !rtsl.ptr<vector<3xf32>>
      %sum = rtsl.var "sum" : !rtsl.ptr<f32>
      rtsl.illuminance %p normal %n cos %half {
        %lp = rtsl.state "LightColor" : !rtsl.ptr<vector<1xf32>>
        %l = rtsl.load %lp : !rtsl.ptr<vector<1xf32>>
        %x = vector.extract %l[0] : f32 from vector<1xf32>
        %large = arith.cmpf ogt, %x, %hundred : f32
        rtsl.if %large {
          rtsl.break
        }
        %s = rtsl.load %sum : !rtsl.ptr<f32>
        %t = arith.addf %s, %x : f32
        rtsl.store %t, %sum : !rtsl.ptr<f32>
        rtsl.yield
      }
      %s = rtsl.load %sum : !rtsl.ptr<f32>
      rtsl.return %s : f32
    })",
                  {{"rtsl_illuminance", reinterpret_cast<void *>(&lightEven)}});
  RtslLaunch launch = {};
  RtslState state = {};
  state.launch = &launch;
  state.HitPoint[0] = 10;
  state.ShadingNormal[2] = 1;
  auto *f = program.get<float(RtslState *)>();
  EXPECT_EQ(f(&state), 0.f);
  launch.lightCount = 5;
  EXPECT_EQ(f(&state), (0 + 2 + 4) + 3 * (10 + 1 + 0.5f));
  launch.lightCount = 1000; // 90 is the first light beyond 100
  float expected = 0;
  for (int i = 0; i < 90; i += 2)
    if (float x = float(i) + 11.5f; x <= 100)
      expected += x;
  EXPECT_EQ(f(&state), expected);
}

TEST(Jit, VariablesAreZeroEachTimeTheyAreReached) {
  Program program(R"(
    func.func @f(%n: i32, %at: i32) -> i32 attributes {rtsl.export} {
      %one = arith.constant 1 : i32
      %i = rtsl.var "i" : !rtsl.ptr<i32>
      %last = rtsl.var "last" : !rtsl.ptr<i32>
      rtsl.loop cond {
        %v = rtsl.load %i : !rtsl.ptr<i32>
        %c = arith.cmpi slt, %v, %n : i32
        rtsl.condition %c
      } do {
        %a = rtsl.var "a" : !rtsl.ptr<!rtsl.array<4 x i32>>
        %e = rtsl.element %a[%at] : !rtsl.ptr<!rtsl.array<4 x i32>> -> !rtsl.ptr<i32>
        %v = rtsl.load %e : !rtsl.ptr<i32>
        %w = arith.addi %v, %one : i32
        rtsl.store %w, %e : !rtsl.ptr<i32>
        rtsl.store %w, %last : !rtsl.ptr<i32>
        rtsl.yield
      } step {
        %v = rtsl.load %i : !rtsl.ptr<i32>
        %w = arith.addi %v, %one : i32
        rtsl.store %w, %i : !rtsl.ptr<i32>
        rtsl.yield
      }
      %r = rtsl.load %last : !rtsl.ptr<i32>
      rtsl.return %r : i32
    })");
  RtslState state = {};
  auto *f = program.get<int32_t(RtslState *, int32_t, int32_t)>();
  EXPECT_EQ(f(&state, 5, 2), 1);
  EXPECT_EQ(f(&state, 0, 2), 0);
}

TEST(Jit, MissingSymbolsAreNamed) {
  Program program("func.func @f() -> f32 attributes {rtsl.export} {"
                  " %r = rtsl.rand\n return %r : f32 }");
  EXPECT_FALSE(program.jit);
  EXPECT_NE(program.error.find("rtsl_rand"), std::string::npos) << program.error;
}

TEST(Jit, LookupOfWhatIsNotThereGivesNull) {
  Program program("func.func @f() attributes {rtsl.export} { return }");
  ASSERT_TRUE(program.jit) << program.error;
  EXPECT_NE(program.jit->lookup("f"), nullptr);
  EXPECT_EQ(program.jit->lookup("g"), nullptr);
}

TEST(Jit, DeviceCodeIsLinkedAndHidden) {
  Program program("func.func @f(%x: f32, %y: f32) -> f32 attributes {rtsl.export} {"
                  " %s = rtsl.elementary <sin> %x : f32\n"
                  " %p = rtsl.elementary <pow> %s, %y : f32\n return %p : f32 }",
                  {}, {"f"}, /*withDevice=*/true);
  auto *f = program.get<float(RtslState *, float, float)>();
  RtslState state = {};
  for (float x : {0.5f, 1.f, 2.f, 3e4f})
    EXPECT_EQ(bits(f(&state, x, 1.5f)), bits(device::pow(device::sin(x), 1.5f))) << x;
  EXPECT_EQ(program.jit->lookup("rtsl_sin"), nullptr) << "only exports stay visible";
  EXPECT_EQ(program.text_.find("rtsl_cos("), std::string::npos) << "unused functions are left out";
}

} // namespace
