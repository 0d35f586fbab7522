//===- RewrittenFunction.h - a function of numbers after a pass -----------===//
#pragma once

#include "codegen/emit/Jit.h"
#include "tests/unit/codegen/emit/ParseLlvm.h"

#include "llvm/IR/PassManager.h"
#include "llvm/Target/TargetMachine.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

namespace rtsl::codegen {

/// A function of %a, %b and %c with this body, after the pass: it can be called.
template <typename Pass>
class RewrittenFunction {
public:
  explicit RewrittenFunction(const std::string &body, const MachineOptions &options = {}) {
    auto context = std::make_unique<llvm::LLVMContext>();
    auto module =
        parseLlvm("define float @f(float %a, float %b, float %c) {\n" + body + "}\n", *context);
    llvm::FunctionAnalysisManager analyses;
    hasChanged = !Pass().run(*module->getFunction("f"), analyses).areAllPreserved();
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

/// The same bits, or two NaNs.
inline bool isSame(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

} // namespace rtsl::codegen
