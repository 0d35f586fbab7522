#include "codegen/emit/rewrites/PackRecords.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/Passes/PassBuilder.h"

#include <gtest/gtest.h>

using namespace rtsl::codegen;

namespace {

/// Steps that access records, after the pass.
class Packed {
public:
  explicit Packed(const std::string &steps) {
    module = parseLlvm("declare i32 @rtsl_record_load(ptr, i32, i32, i32)\n"
                       "declare void @rtsl_record_store(ptr, i32, i32, i32, i32)\n"
                       "declare i32 @rtsl_record_groups()\n" +
                           steps,
                       context);
    llvm::LoopAnalysisManager loops;
    llvm::FunctionAnalysisManager functions;
    llvm::CGSCCAnalysisManager components;
    llvm::ModuleAnalysisManager modules;
    llvm::PassBuilder builder;
    builder.registerModuleAnalyses(modules);
    builder.registerCGSCCAnalyses(components);
    builder.registerFunctionAnalyses(functions);
    builder.registerLoopAnalyses(loops);
    builder.crossRegisterProxies(loops, functions, components, modules);
    declareRecords(*module);
    PackRecordsPass().run(*module, modules);
  }

  template <typename Instruction>
  std::size_t count(const char *function) const {
    std::size_t count = 0;
    for (const llvm::Instruction &one : llvm::instructions(module->getFunction(function)))
      count += llvm::isa<Instruction>(one);
    return count;
  }
  std::size_t loads(const char *function) const { return count<llvm::LoadInst>(function); }
  std::size_t stores(const char *function) const { return count<llvm::StoreInst>(function); }

  /// What a function without branches returns; null: no constant.
  const llvm::ConstantInt *result(const char *function) const {
    const auto *end = llvm::cast<llvm::ReturnInst>(
        module->getFunction(function)->getEntryBlock().getTerminator());
    return llvm::dyn_cast<llvm::ConstantInt>(end->getReturnValue());
  }
  std::uint64_t groups() const { return result("rtsl_record_groups")->getZExtValue(); }

private:
  llvm::LLVMContext context;
  std::unique_ptr<llvm::Module> module;
};

/// A call that stores `value` as word `number`, and one that loads it.
std::string store(unsigned number, const std::string &value) {
  return "call void @rtsl_record_store(ptr %r, i32 %n, i32 %s, i32 " + std::to_string(number) +
         ", i32 " + value + ")\n";
}
std::string load(const std::string &name, unsigned number) {
  return name + " = call i32 @rtsl_record_load(ptr %r, i32 %n, i32 %s, i32 " +
         std::to_string(number) + ")\n";
}
std::string step(const std::string &name, const std::string &body, const std::string &result) {
  return "define i32 @" + name + "(ptr %r, i32 %n, i32 %s, i32 %x) {\n" + body + "ret i32 " +
         result + "\n}\n";
}

} // namespace

TEST(PackRecords, WordsThatNoStepLoadsAreNotStored) {
  const Packed packed(step("a", store(7, "%x") + store(9, "%x"), "0") +
                      step("b", load("%v", 9), "%v"));
  EXPECT_EQ(packed.stores("a"), 1u);
  EXPECT_EQ(packed.loads("b"), 1u);
  EXPECT_EQ(packed.groups(), 1u);
}

TEST(PackRecords, AStepDoesNotStoreWhatItHasLoaded) {
  const Packed packed(step("a", store(3, "%x"), "0") +
                      step("b", load("%v", 3) + store(3, "%v"), "%v"));
  EXPECT_EQ(packed.stores("a"), 1u);
  EXPECT_EQ(packed.stores("b"), 0u);
  EXPECT_EQ(packed.loads("b"), 1u);
}

TEST(PackRecords, AWordWithOneValueIsNotInTheRecord) {
  const Packed packed(step("a", store(3, "5"), "0") + step("b", store(3, "5"), "0") +
                      step("c", load("%v", 3), "%v"));
  EXPECT_EQ(packed.stores("a") + packed.stores("b") + packed.loads("c"), 0u);
  ASSERT_TRUE(packed.result("c"));
  EXPECT_EQ(packed.result("c")->getZExtValue(), 5u);
  EXPECT_EQ(packed.groups(), 0u);
}

TEST(PackRecords, AWordWithTwoValuesStays) {
  const Packed packed(step("a", store(3, "5"), "0") + step("b", store(3, "6"), "0") +
                      step("c", load("%v", 3), "%v"));
  EXPECT_EQ(packed.stores("a") + packed.stores("b"), 2u);
  EXPECT_EQ(packed.loads("c"), 1u);
}

TEST(PackRecords, WhatOnlyServesAWordThatGoesGoesToo) {
  // Word 1 serves only the computation of word 2, which nobody loads.
  const Packed packed(step("a", store(1, "%x"), "0") +
                      step("b", load("%v", 1) + "%w = add i32 %v, 1\n" + store(2, "%w"), "0"));
  EXPECT_EQ(packed.stores("a") + packed.stores("b") + packed.loads("b"), 0u);
}

TEST(PackRecords, UndefinedWordsAreNotStored) {
  const Packed packed(step("a", store(3, "undef") + store(4, "%x"), "0") +
                      step("b", store(3, "%x"), "0") +
                      step("c", load("%v", 3) + load("%w", 4) + "%y = add i32 %v, %w\n", "%y"));
  EXPECT_EQ(packed.stores("a"), 1u);
  EXPECT_EQ(packed.stores("b"), 1u);
}

TEST(PackRecords, WordsAreInGroupsOfFour) {
  std::string stores, loads = "%y0 = add i32 0, 0\n";
  for (unsigned i = 0; i < 5; ++i) {
    const std::string n = std::to_string(i), next = std::to_string(i + 1);
    stores += store(10 * i, "%x");
    loads += load("%v" + n, 10 * i) + "%y" + next + " = add i32 %y" + n + ", %v" + n + "\n";
  }
  const Packed packed(step("a", stores, "0") + step("b", loads, "%y5"));
  EXPECT_EQ(packed.groups(), 2u);
  EXPECT_EQ(packed.loads("b"), 5u);
}
