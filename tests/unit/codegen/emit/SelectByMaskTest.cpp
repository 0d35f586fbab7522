#include "codegen/emit/rewrites/SelectByMask.h"
#include "codegen/emit/Jit.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/Target/TargetMachine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

using namespace rtsl::codegen;

namespace {

/// A function of three numbers after the pass.
class Masked {
public:
  explicit Masked(const std::string &body) {
    auto context = std::make_unique<llvm::LLVMContext>();
    auto module =
        parseLlvm("define float @f(float %a, float %b, float %c) {\n" + body + "}\n", *context);
    llvm::FunctionAnalysisManager analyses;
    hasChanged = !SelectByMaskPass().run(*module->getFunction("f"), analyses).areAllPreserved();
    MachineOptions options;
    options.hostCpu = true;
    auto machine = llvm::cantFail(createTargetMachine(options));
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
const float numbers[] = {0.0f,   -0.0f,    1.0f,      -3.0f,         0.1f,     1e38f,
                         1e-40f, infinite, -infinite, std::nanf(""), -1.4e-45f};

bool isSame(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

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
