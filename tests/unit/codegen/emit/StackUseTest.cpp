// How much stack code takes, as it is said before and as it is seen when the code runs.
#include "codegen/emit/Jit.h"

#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/IRReader/IRReader.h"
#include "llvm/Support/SourceMgr.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

using namespace rtsl::codegen;

namespace {

std::uintptr_t lowest, highest;

/// Called with the address of each frame.
void use(char *frame) {
  const auto address = reinterpret_cast<std::uintptr_t>(frame);
  lowest = std::min(lowest, address);
  highest = std::max(highest, address);
}

/// A function with a frame of so many bytes that calls others with its argument less `step`, while
/// that is above 0. What follows the calls keeps them from being the last.
std::string function(const std::string &name, unsigned bytes, const std::string &calls, int step) {
  return "define void @\"" + name + "\"(i32 %n) {\n  %frame = alloca [" + std::to_string(bytes) +
         " x i8]\n  call void @use(ptr %frame)\n  %less = sub i32 %n, " + std::to_string(step) +
         "\n  %more = icmp sgt i32 %less, 0\n  br i1 %more, label %next, label %end\nnext:\n" +
         calls + "  br label %end\nend:\n  call void @use(ptr %frame)\n  ret void\n}\n";
}

std::string call(const std::string &name) {
  return "  call void @\"" + name + "\"(i32 %less)\n";
}

std::unique_ptr<Jit> compile(const std::string &functions) {
  const std::string text = "declare void @use(ptr)\n" + functions;
  auto context = std::make_unique<llvm::LLVMContext>();
  llvm::SMDiagnostic problem;
  auto module = llvm::parseIR(llvm::MemoryBufferRef(text, "test"), problem, *context);
  EXPECT_TRUE(module) << problem.getMessage().str();
  auto machine = llvm::cantFail(createTargetMachine(MachineOptions()));
  module->setDataLayout(machine->createDataLayout());
  module->setTargetTriple(machine->getTargetTriple());
  return llvm::cantFail(Jit::create(std::move(context), std::move(module), std::move(machine),
                                    {{"use", reinterpret_cast<void *>(&use)}}));
}

/// Bytes between the frames that lie farthest apart.
std::uint64_t seen(const Jit &jit, const std::string &name, int argument) {
  lowest = ~std::uintptr_t(0);
  highest = 0;
  reinterpret_cast<void (*)(int)>(jit.lookup(name))(argument);
  return highest - lowest;
}

/// A ray goes from trace through the slot to one of two materials, which send the next one.
std::string rays() {
  return function("rtsl_trace", 1000, call("rtsl_rt_Material_shade"), 1) +
         function("rtsl_rt_Material_shade", 100, call("Small.shade") + call("Large.shade"), 0) +
         function("Small.shade", 20000, call("rtsl_trace"), 0) +
         function("Large.shade", 50000, call("function.helper") + call("rtsl_trace"), 0) +
         function("function.helper", 30000, "", 0);
}

TEST(StackUse, OfRaysIsThatOfTheLargestMaterialForEach) {
  const auto jit = compile(rays());
  constexpr unsigned count = 6;
  const std::uint64_t said = jit->stackUse()->bytes(count, 3);
  const std::uint64_t measured = seen(*jit, "rtsl_trace", count);
  EXPECT_GE(said, measured);
  // One frame of each kind for a ray, and the helper of the last once more for what is called back.
  EXPECT_GE(measured, (count - 2) * 51100u);
  EXPECT_LE(said, count * (51100u + 400) + 2 * (30000u + 400));
  EXPECT_GT(jit->stackUse()->bytes(2 * count, 3), said + (count - 1) * 51100u);
}

TEST(StackUse, OfCallsIsThatOfTheLongestWayDown) {
  const auto jit = compile(
      function("function.a", 1000, call("function.b") + call("function.c"), 0) +
      function("function.b", 40000, "", 0) + function("function.c", 10000, call("function.d"), 0) +
      function("function.d", 35000, "", 0));
  const std::uint64_t said = jit->stackUse()->bytes(9, 9);
  EXPECT_GE(said, 46000u);
  EXPECT_LE(said, 46000u + 500);
}

TEST(StackUse, OfMethodsThatFollowReferencesGrowsWithTheirChain) {
  const auto jit =
      compile(function("rtsl_trace", 1000, call("Layer.shade"), 1) +
              function("Layer.shade", 100, call("Layer.follow"), 0) +
              function("Layer.follow", 20000, call("Layer.follow") + call("rtsl_trace"), 1));
  const auto said = [&](unsigned rays, unsigned chain) {
    return jit->stackUse()->bytes(rays, chain);
  };
  EXPECT_GE(said(2, 3), 2 * (1100u + 4 * 20000u));
  EXPECT_LE(said(2, 3), 2 * (1100u + 4 * 20000u + 1000));
  EXPECT_GE(said(2, 7) - said(2, 3), 2 * 4 * 20000u);
}

} // namespace
