// Large programs in parts: what goes where, and that parts linked together compute the same.
#include "codegen/emit/Parts.h"
#include "codegen/emit/Jit.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/passes/Pipeline.h"
#include "runtime/device/ray/State.h"
#include "tests/unit/codegen/emit/MakeContext.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/Parser/Parser.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <string>

using namespace rtsl::codegen;

namespace {

/// `count` separate functions of so many additions, of which each calls the one before, and `f`,
/// which calls the last.
std::string chain(unsigned count, unsigned additions) {
  std::string text = "func.func private @helper(%x: i32) -> i32 { %y = arith.muli %x, %x : i32\n "
                     "return %y : i32 }\n";
  for (unsigned i = 0; i != count; ++i) {
    text += "func.func private @M" + std::to_string(i) +
            ".shade(%x: i32) -> i32 attributes {rtsl.separate} {\n";
    text += " %v0 = func.call @" +
            (i == 0 ? std::string("helper") : "M" + std::to_string(i - 1) + ".shade") +
            "(%x) : (i32) -> i32\n";
    for (unsigned k = 0; k != additions; ++k)
      text +=
          " %v" + std::to_string(k + 1) + " = arith.addi %v" + std::to_string(k) + ", %x : i32\n";
    text += " return %v" + std::to_string(additions) + " : i32 }\n";
  }
  return text + "func.func @f(%x: i32) -> i32 attributes {rtsl.export} { %y = func.call @M" +
         std::to_string(count - 1) + ".shade(%x) : (i32) -> i32\n return %y : i32 }\n";
}

ObjectCode compile(mlir::ModuleOp part) {
  mlir::PassManager passes(part.getContext());
  buildLlvmPipeline(passes);
  EXPECT_TRUE(mlir::succeeded(passes.run(part)));
  auto machine = llvm::cantFail(createTargetMachine(MachineOptions()));
  llvm::LLVMContext context;
  auto module = llvm::cantFail(translateToLlvm(part, context, *machine));
  optimize(*module, *machine, MachineOptions());
  return llvm::cantFail(makeObjectCode(*module, *machine));
}

std::size_t definitions(mlir::ModuleOp module) {
  std::size_t count = 0;
  for (auto function : module.getOps<mlir::func::FuncOp>())
    count += !function.isExternal();
  return count;
}

TEST(Parts, OfASmallProgramAreNone) {
  const auto context = makeContext();
  auto ir = mlir::parseSourceString<mlir::ModuleOp>(chain(50, 20), context.get());
  EXPECT_TRUE(takeParts(*ir).empty());
  EXPECT_EQ(definitions(*ir), 52u);
}

TEST(Parts, HaveAllSeparateFunctionsInAboutEqualShares) {
  const auto context = makeContext();
  auto ir = mlir::parseSourceString<mlir::ModuleOp>(
      chain(100, 398), context.get()); // 400 operations and the function itself
  const auto parts = takeParts(*ir);
  ASSERT_EQ(parts.size(), 4u);
  for (const auto &part : parts)
    EXPECT_EQ(definitions(*part), 25u);
  EXPECT_EQ(definitions(*ir), 2u); // `helper` and `f`
}

TEST(Parts, LinkedTogetherAreTheProgram) {
  const auto context = makeContext();
  auto ir = mlir::parseSourceString<mlir::ModuleOp>(chain(100, 398), context.get());
  const auto parts = takeParts(*ir);
  std::vector<ObjectCode> objects;
  objects.push_back(compile(*ir));
  for (const auto &part : parts)
    objects.push_back(compile(*part));
  const auto jit = llvm::cantFail(Jit::create(std::move(objects), {}));
  RtslState state = {};
  auto *f = reinterpret_cast<int32_t (*)(RtslState *, int32_t)>(jit->lookup("f"));
  EXPECT_EQ(f(&state, 3), 9 + 100 * 398 * 3);
  // The chain leads from part to part: 100 frames lie above one another.
  EXPECT_GT(jit->stackUse()->bytes(1, 0), 100u * 16);
}

} // namespace
