#include "codegen/emit/rewrites/PassLaunches.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/Verifier.h"
#include "llvm/Support/raw_ostream.h"

#include <gtest/gtest.h>

#include <string>

using namespace rtsl::codegen;

namespace {

/// Functions of a program: `member` reads only what the launch has, `deeper` calls it and no more,
/// `ofRay` reads the ray, `writes` changes the launch, and `exported` may be called by anyone.
constexpr const char *program = R"(
  define internal float @member(ptr noalias dereferenceable(1088) %state, float %x) {
    %launch = load ptr, ptr %state, align 8
    %at = getelementptr i8, ptr %launch, i64 16
    %y = load float, ptr %at, align 4
    %sum = fadd float %x, %y
    ret float %sum
  }
  define internal float @deeper(ptr noalias dereferenceable(1088) %state) {
    %x = call float @member(ptr readonly dereferenceable(1088) %state, float 1.0)
    ret float %x
  }
  define internal float @ofRay(ptr noalias dereferenceable(1088) %state) {
    %x = call float @deeper(ptr %state)
    %at = getelementptr i8, ptr %state, i64 64
    %t = load float, ptr %at, align 4
    %sum = fadd float %x, %t
    ret float %sum
  }
  define internal float @writes(ptr noalias dereferenceable(1088) %state, ptr %other) {
    store ptr %other, ptr %state, align 8
    %x = call float @member(ptr %state, float 2.0)
    ret float %x
  }
  define internal float @mayBeShared(ptr dereferenceable(1088) %state) {
    %launch = load ptr, ptr %state, align 8
    %x = load float, ptr %launch, align 4
    ret float %x
  }
  define float @exported(ptr noalias dereferenceable(1088) %state, ptr %other) {
    %a = call float @deeper(ptr %state)
    %b = call float @ofRay(ptr %state)
    %c = call float @writes(ptr %state, ptr %other)
    %d = call float @mayBeShared(ptr %state)
    %ab = fadd float %a, %b
    %cd = fadd float %c, %d
    %all = fadd float %ab, %cd
    ret float %all
  })";

class PassLaunches : public testing::Test {
protected:
  PassLaunches() : module(parseLlvm(program, context)) { passLaunches(*module); }

  bool getsLaunch(const char *function) const {
    return isLaunch(*module->getFunction(function)->getArg(0));
  }
  std::string textOf(const char *function) const {
    std::string text;
    llvm::raw_string_ostream stream(text);
    module->getFunction(function)->print(stream);
    return text;
  }

  llvm::LLVMContext context;
  std::unique_ptr<llvm::Module> module;
};

TEST_F(PassLaunches, WhoReadsNothingElseOfTheRayGetsIt) {
  EXPECT_TRUE(getsLaunch("member"));
  EXPECT_TRUE(getsLaunch("deeper"));
  EXPECT_EQ(textOf("member").find("load ptr"), std::string::npos);
  EXPECT_EQ(textOf("deeper").find("load"), std::string::npos);
}

TEST_F(PassLaunches, OthersKeepTheState) {
  EXPECT_FALSE(getsLaunch("ofRay"));
  EXPECT_FALSE(getsLaunch("writes"));
  EXPECT_FALSE(getsLaunch("mayBeShared")); // what it reads may change while it runs
  EXPECT_FALSE(getsLaunch("exported"));
}

TEST_F(PassLaunches, CallersLoadItWhereTheyCall) {
  EXPECT_NE(textOf("ofRay").find("load ptr, ptr %state"), std::string::npos);
  const std::string writes = textOf("writes");
  EXPECT_LT(writes.find("store ptr"), writes.find("load ptr, ptr %state"));
}

TEST_F(PassLaunches, NothingIsSaidOfItThatHeldForTheState) {
  EXPECT_FALSE(llvm::verifyModule(*module, &llvm::errs()));
  EXPECT_EQ(textOf("deeper").find("dereferenceable"), std::string::npos);
  EXPECT_EQ(textOf("deeper").find("readonly"), std::string::npos);
}

} // namespace
