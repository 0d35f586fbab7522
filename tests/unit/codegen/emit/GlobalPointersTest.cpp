#include "codegen/emit/rewrites/gpu/GlobalPointers.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Verifier.h"
#include "llvm/Support/raw_ostream.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

using namespace rtsl::codegen;

namespace {

/// The names of pointers of `f(ptr %any, i64 %number)` that are known after the pass to lead to
/// global memory, of a body that may read the launch.
std::set<std::string> known(const std::string &body) {
  llvm::LLVMContext context;
  const auto module = parseLlvm("@rtsl_launch = external addrspace(4) global [432 x i8]\n"
                                "define void @f(ptr %any, i64 %number, i1 %is) {\n" +
                                    body + "\nret void\n}\n",
                                context);
  llvm::Function &function = *module->getFunction("f");
  llvm::FunctionAnalysisManager analyses;
  GlobalPointersPass().run(function, analyses);
  EXPECT_FALSE(llvm::verifyFunction(function, &llvm::errs()));
  std::set<std::string> names;
  for (const llvm::Instruction &instruction : llvm::instructions(function))
    if (const auto *cast = llvm::dyn_cast<llvm::AddrSpaceCastInst>(&instruction);
        cast && cast->getDestAddressSpace() == 1) {
      names.insert(cast->getOperand(0)->getName().str());
      EXPECT_TRUE(cast->getOperand(0)->hasOneUse());
    }
  return names;
}

const std::string launch = "addrspacecast (ptr addrspace(4) @rtsl_launch to ptr)",
                  meshes = "%meshes = load ptr, ptr " + launch + "\n";
using Names = std::set<std::string>;

} // namespace

TEST(GlobalPointers, WhatTheLaunchRefersToIsGlobal) {
  EXPECT_EQ(known(meshes), Names({"meshes"}));
  EXPECT_EQ(known("%at = getelementptr i8, ptr " + launch + ", i64 16\n%p = load ptr, ptr %at"),
            Names({"p"}));
}

TEST(GlobalPointers, AndWhatThatRefersTo) {
  EXPECT_EQ(known(meshes + "%at = getelementptr i8, ptr %meshes, i64 %number\n"
                           "%positions = load ptr, ptr %at\n%x = load float, ptr %positions"),
            Names({"meshes", "positions"}));
}

TEST(GlobalPointers, AddressesOfBuffersAreTwoWords) {
  const std::string words = "%lows = zext i32 %low to i64\n%highs = zext i32 %high to i64\n"
                            "%up = shl i64 %highs, 32\n%both = or i64 %up, %lows\n"
                            "%buffer = inttoptr i64 %both to ptr\n";
  EXPECT_EQ(known(meshes +
                  "%next = getelementptr i8, ptr %meshes, i64 4\n"
                  "%low = load i32, ptr %meshes\n%high = load i32, ptr %next\n" +
                  words),
            Names({"meshes", "buffer"}));
  EXPECT_EQ(known("%next = getelementptr i8, ptr %any, i64 4\n"
                  "%low = load i32, ptr %any\n%high = load i32, ptr %next\n" +
                  words),
            Names());
}

TEST(GlobalPointers, NothingIsSaidOfOthers) {
  EXPECT_EQ(known("%p = load ptr, ptr %any"), Names());
  EXPECT_EQ(known("%p = inttoptr i64 %number to ptr"), Names());
  EXPECT_EQ(known("%own = alloca ptr\n%p = load ptr, ptr %own"), Names());
  EXPECT_EQ(known(meshes + "%either = select i1 %is, ptr %meshes, ptr %any\n"
                           "%p = load ptr, ptr %either"),
            Names({"meshes"}));
}
