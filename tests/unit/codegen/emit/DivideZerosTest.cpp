#include "codegen/emit/rewrites/gpu/DivideZeros.h"
#include "codegen/emit/Jit.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

using namespace rtsl::codegen;

namespace {

/// A function of a division after the pass.
class Divided {
public:
  explicit Divided(const std::string &body) {
    auto context = std::make_unique<llvm::LLVMContext>();
    auto module =
        parseLlvm("define float @f(float %a, float %b, float %c) {\n" + body + "}\n", *context);
    llvm::Function &function = *module->getFunction("f");
    llvm::FunctionAnalysisManager analyses;
    hasChanged = !DivideZerosPass().run(function, analyses).areAllPreserved();
    auto machine = llvm::cantFail(createTargetMachine(MachineOptions()));
    module->setTargetTriple(machine->getTargetTriple());
    module->setDataLayout(machine->createDataLayout());
    jit =
        llvm::cantFail(Jit::create(std::move(context), std::move(module), std::move(machine), {}));
  }
  float operator()(float a, float b, float c) const {
    return reinterpret_cast<float (*)(float, float, float)>(jit->lookup("f"))(a, b, c);
  }
  bool hasChanged = false;

private:
  std::unique_ptr<Jit> jit;
};

constexpr float infinite = std::numeric_limits<float>::infinity();
const float numbers[] = {0.0f,      -0.0f,    1.0f,      -1.0f,         3.0f,           0.1f,
                         -7.5e-3f,  1e38f,    -3e38f,    1e-38f,        -1e-40f,        1.4e-45f,
                         -1.4e-45f, infinite, -infinite, std::nanf(""), 1.17549435e-38f};

bool isSame(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

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
