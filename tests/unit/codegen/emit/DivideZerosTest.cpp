#include "codegen/emit/rewrites/gpu/DivideZeros.h"
#include "tests/unit/codegen/emit/RewrittenFunction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace rtsl::codegen;

namespace {

using Divided = RewrittenFunction<DivideZerosPass>;

constexpr float infinite = std::numeric_limits<float>::infinity();
const float numbers[] = {0.0f,      -0.0f,    1.0f,      -1.0f,         3.0f,           0.1f,
                         -7.5e-3f,  1e38f,    -3e38f,    1e-38f,        -1e-40f,        1.4e-45f,
                         -1.4e-45f, infinite, -infinite, std::nanf(""), 1.17549435e-38f};

} // namespace

TEST(DivideZeros, QuotientsStayTheSame) {
  const Divided difference("%d = fsub float %a, %b\n%q = fdiv float %d, %c\nret float %q\n");
  const Divided sum("%d = fadd float %a, %b\n%q = fdiv float %d, %c\nret float %q\n");
  EXPECT_TRUE(difference.hasChanged);
  EXPECT_TRUE(sum.hasChanged);
  for (const float a : numbers)
    for (const float b : numbers)
      for (const float c : numbers) {
        EXPECT_TRUE(isSame(difference(a, b, c), (a - b) / c)) << a << " - " << b << " by " << c;
        EXPECT_TRUE(isSame(sum(a, b, c), (a + b) / c)) << a << " + " << b << " by " << c;
      }
}

TEST(DivideZeros, OtherDivisionsStay) {
  EXPECT_FALSE(Divided("%q = fdiv float %a, %c\nret float %q\n").hasChanged);
  EXPECT_FALSE(Divided("%aa = fmul float %a, %a\n%bb = fmul float %b, %b\n"
                       "%d = fadd float %aa, %bb\n%q = fdiv float %d, %c\nret float %q\n")
                   .hasChanged);
  EXPECT_FALSE(
      Divided("%d = fsub float %a, %b\n%q = fdiv afn float %d, %c\nret float %q\n").hasChanged);
}
