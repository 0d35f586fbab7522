#include "codegen/emit/rewrites/UnrollLoops.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/Analysis/LoopInfo.h"
#include "llvm/IR/Verifier.h"
#include "llvm/Passes/PassBuilder.h"
#include "llvm/Support/raw_ostream.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

using namespace rtsl::codegen;

namespace {

/// Whether a loop of `i` from 0 to `trips` is unrolled whose body computes %next from %i, %sum and
/// the arguments %n and %array.
bool isUnrolled(const std::string &body, const std::string &trips = "16") {
  std::string text = R"(
    @table = constant [16 x float] zeroinitializer
    declare float @sine(float) memory(none)
    declare float @draw(float)
    define float @f(float %x, i32 %n, ptr %array) {
      %local = alloca [16 x float]
      br label %head
    head:
      %i = phi i32 [ 0, %0 ], [ %following, %body ]
      %sum = phi float [ 0.0, %0 ], [ %next, %body ]
      %goesOn = icmp slt i32 %i, TRIPS
      br i1 %goesOn, label %body, label %end
    body:
      BODY
      %following = add i32 %i, 1
      br label %head
    end:
      ret float %sum
    })";
  text.replace(text.find("TRIPS"), 5, trips);
  text.replace(text.find("BODY"), 4, body);
  llvm::LLVMContext context;
  const auto module = parseLlvm(text, context);
  llvm::PassBuilder builder;
  llvm::LoopAnalysisManager loops;
  llvm::FunctionAnalysisManager functions;
  llvm::CGSCCAnalysisManager components;
  llvm::ModuleAnalysisManager modules;
  builder.registerModuleAnalyses(modules);
  builder.registerCGSCCAnalyses(components);
  builder.registerFunctionAnalyses(functions);
  builder.registerLoopAnalyses(loops);
  builder.crossRegisterProxies(loops, functions, components, modules);
  llvm::Function &function = *module->getFunction("f");
  functions.invalidate(function, UnrollLoopsPass().run(function, functions));
  EXPECT_FALSE(llvm::verifyFunction(function, &llvm::errs()));
  return functions.getResult<llvm::LoopAnalysis>(function).empty();
}

/// A body that calls a function with a value.
std::string calls(const std::string &function, const std::string &value) {
  return "%turn = sitofp i32 %i to float\n%angle = fmul float %turn, 0.5\n" + value +
         "%sine = call float @" + function + "(float %given)\n%next = fadd float %sum, %sine";
}

const std::string ofCounter = "%given = fadd float %angle, 1.0\n";

std::string adds(const std::string &array) {
  return "%place = getelementptr float, ptr " + array +
         ", i32 %i\n%element = load float, ptr %place\n%next = fadd float %sum, %element";
}

TEST(UnrollLoops, WhereFunctionsOfTheCounterAreCalled) {
  EXPECT_TRUE(isUnrolled(calls("sine", ofCounter)));
  EXPECT_TRUE(isUnrolled(calls("sine", ofCounter), "2"));
  EXPECT_TRUE(isUnrolled(calls("sine", ofCounter), "31"));
}

TEST(UnrollLoops, NotWhereTheValueIsNotKnown) {
  EXPECT_FALSE(isUnrolled(calls("sine", "%given = fadd float %angle, %x\n")));
  EXPECT_FALSE(isUnrolled(calls("sine", "%given = fadd float %angle, %sum\n")));
  EXPECT_FALSE(isUnrolled(calls("sine", "%given = fadd float 1.0, 1.0\n")));
  EXPECT_FALSE(isUnrolled(calls("draw", ofCounter)));
  EXPECT_FALSE(isUnrolled("%next = fadd float %sum, %x"));
}

TEST(UnrollLoops, NotIfItIsLongOrItsLengthIsNotKnown) {
  EXPECT_FALSE(isUnrolled(calls("sine", ofCounter), "100"));
  EXPECT_FALSE(isUnrolled(calls("sine", ofCounter), "%n"));
  std::string large = calls("sine", ofCounter);
  for (int i = 0; i < 300; ++i)
    large += "\n%more" + std::to_string(i) + " = fadd float %x, %sum";
  EXPECT_FALSE(isUnrolled(large));
  EXPECT_TRUE(isUnrolled(large, "4"));
}

TEST(UnrollLoops, WhereTheCounterIndexesALocalArray) {
  EXPECT_TRUE(isUnrolled(adds("%local")));
  EXPECT_FALSE(isUnrolled(adds("%array")));
  EXPECT_FALSE(isUnrolled(adds("@table")));
}

} // namespace
