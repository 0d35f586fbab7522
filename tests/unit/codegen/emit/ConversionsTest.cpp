#include "codegen/emit/rewrites/gpu/Conversions.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/IntrinsicsNVPTX.h"
#include "llvm/IR/PassManager.h"

#include <gtest/gtest.h>

using namespace rtsl::codegen;

namespace {

/// The intrinsic that converts after the pass.
llvm::Intrinsic::ID converted(const std::string &to, const std::string &function,
                              const std::string &from) {
  llvm::LLVMContext context;
  const auto module = parseLlvm("declare " + to + " @llvm." + function + "(" + from + ")\ndefine " +
                                    to + " @f(" + from + " %x) {\n%i = call " + to + " @llvm." +
                                    function + "(" + from + " %x)\nret " + to + " %i\n}\n",
                                context);
  llvm::Function &f = *module->getFunction("f");
  llvm::FunctionAnalysisManager analyses;
  ConversionsPass().run(f, analyses);
  return llvm::cast<llvm::IntrinsicInst>(*llvm::instructions(f).begin()).getIntrinsicID();
}

} // namespace

TEST(Conversions, SaturatingOnesOfAWordAreAnInstruction) {
  EXPECT_EQ(converted("i32", "fptosi.sat.i32.f32", "float"), llvm::Intrinsic::nvvm_f2i_rz);
  EXPECT_EQ(converted("i32", "fptoui.sat.i32.f32", "float"), llvm::Intrinsic::nvvm_f2ui_rz);
}

/// Of a double, PTX converts a NaN to another number.
TEST(Conversions, OthersStay) {
  EXPECT_EQ(converted("i32", "fptosi.sat.i32.f64", "double"), llvm::Intrinsic::fptosi_sat);
  EXPECT_EQ(converted("i64", "fptosi.sat.i64.f32", "float"), llvm::Intrinsic::fptosi_sat);
}
