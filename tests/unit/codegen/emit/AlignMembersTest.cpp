#include "codegen/emit/rewrites/gpu/AlignMembers.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"

#include <gtest/gtest.h>

using namespace rtsl::codegen;

namespace {

/// The alignment of a load from %address, which the body computes, after the pass.
std::uint64_t alignmentOf(const std::string &body) {
  llvm::LLVMContext context;
  const auto module =
      parseLlvm("define float @f(ptr %records, i64 %reference) {\n" + body +
                    "%value = load float, ptr %address, align 4\nret float %value\n}\n",
                context);
  alignMembers(*module);
  for (const llvm::Instruction &instruction : llvm::instructions(*module->getFunction("f")))
    if (const auto *load = llvm::dyn_cast<llvm::LoadInst>(&instruction))
      return load->getAlign().value();
  return 0;
}

const std::string record = "%record = getelementptr inbounds [1 x i8], ptr %records, "
                           "i64 %reference\n";

std::string member(int offset) {
  return record + "%address = getelementptr inbounds nuw i8, ptr %record, i32 " +
         std::to_string(offset) + "\n";
}

} // namespace

TEST(AlignMembers, ByTheirOffset) {
  EXPECT_EQ(alignmentOf(member(4)), 4u);
  EXPECT_EQ(alignmentOf(member(8)), 8u);
  EXPECT_EQ(alignmentOf(member(16)), 16u);
  EXPECT_EQ(alignmentOf(member(28)), 4u);
  EXPECT_EQ(alignmentOf(member(64)), 16u);
  EXPECT_EQ(alignmentOf(member(12) + "%field = getelementptr inbounds nuw i8, ptr %address, i32 4\n"
                                     "%value0 = load float, ptr %field, align 4\n"),
            16u);
}

TEST(AlignMembers, NotElementsOfArrays) {
  EXPECT_EQ(alignmentOf("%address = getelementptr inbounds [16 x i8], ptr %records, "
                        "i64 %reference\n"),
            4u);
  EXPECT_EQ(alignmentOf(record + "%member = getelementptr inbounds nuw i8, ptr %record, i32 16\n"
                                 "%address = getelementptr inbounds [4 x i8], ptr %member, "
                                 "i64 %reference\n"),
            4u);
}
