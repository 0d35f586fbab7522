//===- FastMath.cpp - arithmetic for --fp=fast ----------------------------===//
#include "codegen/emit/rewrites/arithmetic/FastMath.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/Operator.h"

namespace rtsl::codegen {

static constexpr const char *fastFunctions[] = {
#define RTSL_FAST_UNARY(name) #name,
#define RTSL_FAST_BINARY(name) #name,
#include "math/FastFunctions.def"
};

void relaxArithmetic(llvm::Module &module) {
  llvm::FastMathFlags flags;
  flags.setAllowReassoc();
  flags.setAllowContract();
  flags.setAllowReciprocal();
  flags.setNoSignedZeros();
  for (llvm::Function &function : module)
    for (llvm::Instruction &instruction : llvm::instructions(function))
      if (llvm::isa<llvm::FPMathOperator>(instruction))
        instruction.setFastMathFlags(flags);
  for (const std::string name : fastFunctions)
    if (llvm::Function *strict = module.getFunction("rtsl_" + name))
      strict->setName("rtsl_fast_" + name);
}

} // namespace rtsl::codegen
