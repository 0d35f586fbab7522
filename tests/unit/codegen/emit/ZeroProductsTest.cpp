#include "codegen/emit/rewrites/arithmetic/ZeroProducts.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/PassManager.h"

#include <gtest/gtest.h>

using namespace rtsl::codegen;

namespace {

/// Is the product that a function of %a returns 0 after the pass?
bool isZero(const std::string &product, const std::string &type = "float") {
  llvm::LLVMContext context;
  const auto module = parseLlvm("define " + type + " @f(" + type + " %a) {\n%p = " + product +
                                    "\nret " + type + " %p\n}\n",
                                context);
  llvm::Function &function = *module->getFunction("f");
  llvm::FunctionAnalysisManager analyses;
  ZeroProductsPass().run(function, analyses);
  const auto *end = llvm::cast<llvm::ReturnInst>(function.getEntryBlock().getTerminator());
  const auto *constant = llvm::dyn_cast<llvm::Constant>(end->getReturnValue());
  return constant && constant->isZeroValue();
}

} // namespace

TEST(ZeroProducts, AreZeroInShaders) {
  EXPECT_TRUE(isZero("fmul reassoc nsz float %a, 0.0"));
  EXPECT_TRUE(isZero("fmul reassoc nsz float -0.0, %a"));
  EXPECT_TRUE(isZero("fmul reassoc nsz <3 x float> %a, zeroinitializer", "<3 x float>"));
}

TEST(ZeroProducts, OtherProductsStay) {
  EXPECT_FALSE(isZero("fmul float %a, 0.0")) << "strict";
  EXPECT_FALSE(isZero("fmul nsz float %a, 0.0"));
  EXPECT_FALSE(isZero("fmul reassoc nsz float %a, 1.0"));
  EXPECT_FALSE(isZero("fmul reassoc nsz <2 x float> %a, <float 0.0, float 1.0>", "<2 x float>"));
  EXPECT_FALSE(isZero("fdiv reassoc nsz float %a, 0.0"));
}
