//===- ObjectCode.cpp - LLVM IR as machine code before linking ------------===//
#include "codegen/emit/ObjectCode.h"

#include "llvm/IR/LegacyPassManager.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/Target/TargetMachine.h"

namespace rtsl::codegen {

llvm::Expected<ObjectCode> makeObjectCode(llvm::Module &module, llvm::TargetMachine &machine) {
  ObjectCode code = {{}, {}, StackUse(module)};
  for (const llvm::Function &function : module)
    if (!function.isDeclaration() && !function.hasLocalLinkage())
      code.exports.push_back(function.getName().str());
  llvm::raw_svector_ostream stream(code.bytes);
  llvm::legacy::PassManager passes;
  if (machine.addPassesToEmitFile(passes, stream, nullptr, llvm::CodeGenFileType::ObjectFile))
    return llvm::createStringError("the code generator writes no object files");
  passes.run(module);
  return code;
}

} // namespace rtsl::codegen
