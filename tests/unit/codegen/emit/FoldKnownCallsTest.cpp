#include "codegen/emit/rewrites/arithmetic/FoldKnownCalls.h"
#include "math/Elementary.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/Constants.h"
#include "llvm/IR/Instructions.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

using namespace rtsl::codegen;

namespace {

/// What a function returns after the pass that returns the result of this call, if it is known.
std::optional<float> resultOf(const std::string &call) {
  const std::string text = R"(
    declare float @rtsl_cospi(float)
    declare float @rtsl_pow(float, float)
    declare float @rtsl_rand(ptr)
    declare float @rtsl_fast_cospi(float)
    declare double @rtsl_double_cospi(double)
    define float @f(float %x) {
      %result = call float )" +
                           call + R"(
      ret float %result
    })";
  llvm::LLVMContext context;
  const auto module = parseLlvm(text, context);
  llvm::FunctionAnalysisManager analyses;
  llvm::Function &function = *module->getFunction("f");
  FoldKnownCallsPass().run(function, analyses);
  const auto *end = llvm::cast<llvm::ReturnInst>(function.getEntryBlock().getTerminator());
  const auto *constant = llvm::dyn_cast<llvm::ConstantFP>(end->getReturnValue());
  return constant ? std::optional(constant->getValueAPF().convertToFloat()) : std::nullopt;
}

TEST(FoldKnownCalls, EvaluatesThemWithConstants) {
  EXPECT_EQ(resultOf("@rtsl_cospi(float 0.625)"), rtsl::device::cospi(0.625f));
  EXPECT_EQ(resultOf("@rtsl_pow(float 3.0, float 0.125)"), rtsl::device::pow(3.0f, 0.125f));
  EXPECT_EQ(resultOf("@rtsl_fast_cospi(float 0.625)"), rtsl::device::cospi(0.625f));
}

TEST(FoldKnownCalls, LeavesWhatIsNotKnown) {
  EXPECT_FALSE(resultOf("@rtsl_cospi(float %x)"));
  EXPECT_FALSE(resultOf("@rtsl_pow(float 3.0, float %x)"));
  EXPECT_FALSE(resultOf("@rtsl_rand(ptr null)"));
}

} // namespace
