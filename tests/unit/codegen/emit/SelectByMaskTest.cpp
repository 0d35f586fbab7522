#include "codegen/emit/rewrites/SelectByMask.h"
#include "tests/unit/codegen/emit/RewrittenFunction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace rtsl::codegen;

namespace {

/// For this processor, which may have masks.
struct Masked : RewrittenFunction<SelectByMaskPass> {
  explicit Masked(const std::string &body) : RewrittenFunction(body, processor()) {}

  static MachineOptions processor() {
    MachineOptions options;
    options.hostCpu = true;
    return options;
  }
};

constexpr float infinite = std::numeric_limits<float>::infinity();
const float numbers[] = {0.0f,   -0.0f,    1.0f,      -3.0f,         0.1f,     1e38f,
                         1e-40f, infinite, -infinite, std::nanf(""), -1.4e-45f};

} // namespace

TEST(SelectByMask, SelectedNumbersStayTheSame) {
  const Masked less("%less = fcmp olt float %a, %b\n"
                    "%x = select i1 %less, float %c, float 2.0\n"
                    "%y = select i1 %less, float %a, float %c\n"
                    "%sum = fadd float %x, %y\nret float %sum\n");
  const Masked unordered("%less = fcmp uge float %a, %b\n"
                         "%x = select i1 %less, float %c, float 2.0\n"
                         "%y = select i1 %less, float %a, float %x\n"
                         "%sum = fsub float %x, %y\nret float %sum\n");
  EXPECT_TRUE(less.hasChanged);
  EXPECT_TRUE(unordered.hasChanged);
  for (const float a : numbers)
    for (const float b : numbers)
      for (const float c : numbers) {
        EXPECT_TRUE(isSame(less(a, b, c), (a < b ? c : 2) + (a < b ? a : c)))
            << a << " < " << b << ", " << c;
        const float x = a < b ? 2 : c;
        EXPECT_TRUE(isSame(unordered(a, b, c), x - (a < b ? x : a)))
            << "not " << a << " < " << b << ", " << c;
      }
}

TEST(SelectByMask, ComparisonsOfSmallerNumbersAndJumpsStay) {
  EXPECT_FALSE(Masked("%less = fcmp olt float %a, %b\n"
                      "%x = select i1 %less, float %a, float %b\n"
                      "%y = select i1 %less, float %a, float %c\n"
                      "%sum = fadd float %x, %y\nret float %sum\n")
                   .hasChanged);
  EXPECT_FALSE(Masked("%less = fcmp olt float %a, %b\n"
                      "%x = select i1 %less, float %c, float 1.0\n"
                      "%y = select i1 %less, float %a, float %c\n"
                      "br i1 %less, label %one, label %two\n"
                      "one:\nret float %x\n"
                      "two:\nret float %y\n")
                   .hasChanged);
  EXPECT_FALSE(Masked("%less = fcmp olt float %a, %b\n"
                      "%x = select i1 %less, float %c, float 1.0\nret float %x\n")
                   .hasChanged);
}
