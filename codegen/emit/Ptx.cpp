//===- Ptx.cpp - LLVM IR as PTX -------------------------------------------===//
#include "codegen/emit/Ptx.h"

#include "llvm/ADT/StringExtras.h"
#include "llvm/Demangle/Demangle.h"
#include "llvm/IR/LegacyPassManager.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/Target/TargetMachine.h"

#include <algorithm>
#include <cstdlib>

namespace rtsl::codegen {

/// `_ZN4rtsl6device11describeHitER9RtslState` is `describeHit` in the source.
static std::string nameInSource(llvm::StringRef symbol) {
  std::string name = symbol.str();
  llvm::ItaniumPartialDemangler demangler;
  if (demangler.partialDemangle(name.c_str()) || !demangler.isFunction())
    return name;
  char *base = demangler.getFunctionBaseName(nullptr, nullptr);
  name = base ? base : name;
  std::free(base);
  return name;
}

void nameForPtx(llvm::Module &module) {
  for (llvm::Function &function : module) {
    if (function.isIntrinsic())
      continue;
    std::string name = nameInSource(function.getName());
    if (!function.isDeclaration())
      function.front().setName(name);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !llvm::isAlnum(c) && c != '_'; }, '_');
    while (name != function.getName() && module.getNamedValue(name))
      name += '_';
    function.setName(name);
  }
}

llvm::Expected<std::string> printPtx(llvm::Module &module, llvm::TargetMachine &machine) {
  llvm::SmallString<0> text;
  llvm::raw_svector_ostream stream(text);
  llvm::legacy::PassManager passes;
  if (machine.addPassesToEmitFile(passes, stream, nullptr, llvm::CodeGenFileType::AssemblyFile))
    return llvm::createStringError("the code generator writes no PTX");
  passes.run(module);
  return text.str().str();
}

} // namespace rtsl::codegen
