#include "codegen/emit/rewrites/NarrowLoads.h"
#include "runtime/program/DeviceBitcode.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/Bitcode/BitcodeReader.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::codegen;

namespace {

std::unique_ptr<llvm::Module> parse(std::string_view bitcode, llvm::LLVMContext &context) {
  auto module = llvm::parseBitcodeFile(
      llvm::MemoryBufferRef(llvm::StringRef(bitcode.data(), bitcode.size()), "device"), context);
  EXPECT_TRUE(bool(module)) << llvm::toString(module.takeError());
  return std::move(*module);
}

bool calls(const llvm::Function &function, llvm::StringRef name) {
  for (const llvm::Instruction &instruction : llvm::instructions(function))
    if (auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction))
      if (call->getCalledFunction() && call->getCalledFunction()->getName() == name)
        return true;
  return false;
}

/// The functions are known by their names, so it must be these that test primitives.
void expectTestsAreMarked(std::string_view bitcode) {
  llvm::LLVMContext context;
  const auto module = parse(bitcode, context);
  markNarrowLoads(*module);
  EXPECT_TRUE(hasNarrowLoads(*module->getFunction("rtsl_traverse")));
  unsigned tests = 0;
  bool findsHits = false;
  for (const llvm::Function &function : *module) {
    const std::string name = function.getName().str();
    if (calls(function, "rtsl_rt_Primitive_intersect")) {
      EXPECT_TRUE(hasNarrowLoads(function)) << name;
      ++tests;
    }
    findsHits |= function.getName().contains("findHit") && hasNarrowLoads(function);
  }
  EXPECT_GT(tests, 0u);
  EXPECT_TRUE(findsHits);
  unmarkNarrowLoads(*module);
  for (const llvm::Function &function : *module)
    EXPECT_FALSE(hasNarrowLoads(function));
}

TEST(NarrowLoads, AreInTestsOfPrimitives) {
  expectTestsAreMarked(runtime::megakernelBitcode());
  expectTestsAreMarked(runtime::listTraversalBitcode());
}

TEST(NarrowLoads, AreInAllOfAProgramWithPayloads) {
  llvm::LLVMContext context;
  const auto module = parse(runtime::deviceBitcode(), context);
  markNarrowLoads(*module);
  for (const llvm::Function &function : *module)
    EXPECT_EQ(hasNarrowLoads(function), !function.isDeclaration()) << function.getName().str();
}

TEST(NarrowLoads, AreInMethodsOfPrimitivesAlone) {
  llvm::LLVMContext context;
  const auto module = parseLlvm(R"(
    define void @Sphere.intersect() {
      ret void
    }
    define void @Glass.shade() {
      ret void
    })",
                                context);
  ASSERT_TRUE(module);
  markNarrowLoads(*module);
  EXPECT_TRUE(hasNarrowLoads(*module->getFunction("Sphere.intersect")));
  EXPECT_FALSE(hasNarrowLoads(*module->getFunction("Glass.shade")));
}

} // namespace
