#include "codegen/emit/rewrites/gpu/Approximations.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/PassManager.h"

#include <gtest/gtest.h>

using namespace rtsl::codegen;

namespace {

/// The instructions of a function of %a and %b after the pass: opcodes, or what is called.
std::string rewritten(const std::string &body) {
  llvm::LLVMContext context;
  const auto module = parseLlvm(
      "declare float @llvm.sqrt.f32(float)\ndefine float @f(float %a, float %b) {\n" + body + "}\n",
      context);
  llvm::Function &function = *module->getFunction("f");
  llvm::FunctionAnalysisManager analyses;
  ApproximationsPass().run(function, analyses);
  std::string text;
  for (const llvm::Instruction &instruction : llvm::instructions(function)) {
    const auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction);
    text += (call ? call->getCalledFunction()->getName() : instruction.getOpcodeName()).str() + " ";
  }
  return text;
}

} // namespace

TEST(Approximations, TakeThePlaceOfWhatFastModeMarks) {
  EXPECT_EQ(rewritten("%q = fdiv reassoc arcp float %a, %b\nret float %q\n"),
            "llvm.nvvm.rcp.approx.ftz.f fmul ret ");
  EXPECT_EQ(rewritten("%r = call reassoc arcp float @llvm.sqrt.f32(float %a)\nret float %r\n"),
            "llvm.nvvm.sqrt.approx.f ret ");
}

TEST(Approximations, QuotientsByARootAreProducts) {
  const std::string root = "%r = call arcp float @llvm.sqrt.f32(float %b)\n";
  // The root is still there, for it may have other uses; LLVM removes it.
  EXPECT_EQ(rewritten(root + "br label %next\nnext:\n%q = fdiv arcp float %a, %r\nret float %q\n"),
            "llvm.nvvm.sqrt.approx.f br llvm.nvvm.rsqrt.approx.f fmul ret ");
  EXPECT_EQ(rewritten(root + "%q = fdiv arcp float %r, %a\nret float %q\n"),
            "llvm.nvvm.sqrt.approx.f llvm.nvvm.rcp.approx.ftz.f fmul ret ");
}

TEST(Approximations, StrictCodeStays) {
  EXPECT_EQ(rewritten("%q = fdiv contract float %a, %b\nret float %q\n"), "fdiv ret ");
  EXPECT_EQ(rewritten("%r = call float @llvm.sqrt.f32(float %a)\nret float %r\n"),
            "llvm.sqrt.f32 ret ");
  EXPECT_EQ(rewritten("%r = call float @llvm.sqrt.f32(float %b)\n"
                      "%q = fdiv arcp float %a, %r\nret float %q\n"),
            "llvm.sqrt.f32 llvm.nvvm.rcp.approx.ftz.f fmul ret ");
}
