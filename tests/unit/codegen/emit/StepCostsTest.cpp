#include "codegen/emit/StepCosts.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include <gtest/gtest.h>

using namespace rtsl::codegen;

namespace {

/// The costs of a program with these functions, of which two are its states.
class Costs {
public:
  explicit Costs(const std::string &functions) {
    llvm::LLVMContext context;
    const auto module = parseLlvm(functions + R"(
      define i32 @rtsl_run_state(ptr %s, i32 %number) {
        switch i32 %number, label %none [ i32 1, label %first
                                          i32 2, label %second ]
      none:
        ret i32 0
      first:
        %a = call i32 @first(ptr %s)
        ret i32 %a
      second:
        %b = call i32 @second(ptr %s)
        ret i32 %b
      })",
                                  context);
    costs = stepCosts(*module);
  }
  unsigned of(unsigned step) const { return costs >> (4 * step) & 15; }

private:
  std::uint64_t costs = 0;
};

enum Step { Traversal, Sample, First, Second, Later, Last = 15 };

std::string stateOf(const std::string &name, unsigned additions) {
  std::string text = "define i32 @" + name + "(ptr %s) {\n%v0 = load i32, ptr %s\n";
  for (unsigned i = 0; i < additions; ++i)
    text += "%v" + std::to_string(i + 1) + " = add i32 %v" + std::to_string(i) + ", 1\n";
  return text + "ret i32 %v" + std::to_string(additions) + "\n}\n";
}

std::string listed(unsigned count) {
  return "define i32 @rtsl_listed_instances(ptr %l) { ret i32 " + std::to_string(count) + " }\n";
}

} // namespace

TEST(StepCosts, TheyDoubleWithTheInstructions) {
  const Costs costs(stateOf("first", 3) + stateOf("second", 31));
  EXPECT_EQ(costs.of(First), 0u);
  EXPECT_EQ(costs.of(Second), 1u);
  const Costs larger(stateOf("first", 63) + stateOf("second", 1023));
  EXPECT_EQ(larger.of(First), 2u);
  EXPECT_EQ(larger.of(Second), 6u);
  EXPECT_EQ(larger.of(Later), 6u) << "those that follow have the last one";
  EXPECT_EQ(larger.of(Last), 6u);
}

TEST(StepCosts, FunctionsAndVectorsCountAsWhatTheyBecome) {
  const Costs costs(R"(
    declare float @sine(float)
    define internal i32 @helper(ptr %s) { )"
                    "%a = load <16 x float>, ptr %s\n"
                    "%b = fdiv <16 x float> %a, %a\n"
                    "store <16 x float> %b, ptr %s\n"
                    "ret i32 0 }\n"
                    "define i32 @first(ptr %s) { %a = call float @sine(float 1.0)\nret i32 1 }\n"
                    "define i32 @second(ptr %s) { %a = call i32 @helper(ptr %s)\nret i32 %a }\n");
  EXPECT_EQ(costs.of(First), 1u);  // 32 instructions of a function of the runtime
  EXPECT_EQ(costs.of(Second), 3u); // 16 loads, 16 divisions of 8, 16 stores
}

TEST(StepCosts, TraversalDependsOnTheScene) {
  const std::string states = stateOf("first", 3) + stateOf("second", 3);
  const Costs few(states + listed(2)), more(states + listed(16)), tree(states + listed(0));
  EXPECT_LT(few.of(Traversal), more.of(Traversal));
  EXPECT_LT(more.of(Traversal), tree.of(Traversal));
  EXPECT_EQ(tree.of(Traversal), Costs(states).of(Traversal));
  EXPECT_GT(few.of(Sample), few.of(First));
}

namespace {

/// The cost of `intersect` in a program with these functions.
std::optional<std::uint64_t> costOfIntersect(const std::string &functions) {
  llvm::LLVMContext context;
  return intersectCost(*parseLlvm(functions, context));
}

const std::string ofOneClass = R"(
  define void @rtsl_rt_Primitive_intersect(ptr %s, i32 %object) {
    %a = call i32 @sphere(ptr %s)
    %b = call i32 @sphere(ptr %s) ; one function in two places is no recursion
    ret void
  })";

} // namespace

TEST(StepCosts, AnIntersectCostsItsInstructions) {
  EXPECT_EQ(costOfIntersect(ofOneClass + stateOf("sphere", 80)), 2 * 81u);
  EXPECT_EQ(costOfIntersect(ofOneClass + stateOf("sphere", 800)), 2 * 801u);
}

TEST(StepCosts, AnIntersectOfSeveralClassesCostsThatOfTheLongest) {
  const std::string intersect = R"(
    define void @rtsl_rt_Primitive_intersect(ptr %s, i32 %object) {
      switch i32 %object, label %none [ i32 1, label %one
                                        i32 2, label %other ]
    none:
      ret void
    one:
      %a = call i32 @sphere(ptr %s)
      ret void
    other:
      %b = call i32 @side(ptr %s)
      ret void
    })";
  EXPECT_EQ(costOfIntersect(intersect + stateOf("sphere", 80) + stateOf("side", 50)), 81u);
  EXPECT_EQ(costOfIntersect(intersect + stateOf("sphere", 30) + stateOf("side", 50)), 51u);
}

TEST(StepCosts, NothingIsKnownOfAnIntersectThatMayLoop) {
  EXPECT_FALSE(costOfIntersect(ofOneClass + R"(
    define i32 @sphere(ptr %s) {
      br label %next
    next:
      %v = load i1, ptr %s
      br i1 %v, label %next, label %end
    end:
      ret i32 0
    })"));
  EXPECT_FALSE(costOfIntersect(ofOneClass + R"(
    define i32 @sphere(ptr %s) {
      call void @rtsl_rt_Primitive_intersect(ptr %s, i32 0)
      ret i32 0
    })"));
  EXPECT_FALSE(costOfIntersect("declare void @rtsl_rt_Primitive_intersect(ptr, i32)"));
  EXPECT_FALSE(costOfIntersect(stateOf("sphere", 3)));
}
