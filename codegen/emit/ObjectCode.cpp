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

// A line for each exported function, an empty one, the use of the stack, an empty line, and the
// object file.

std::string textOf(const ObjectCode &code) {
  std::string text;
  for (const std::string &name : code.exports)
    text += name + '\n';
  text += '\n' + code.stackUse.text() + '\n';
  text.append(code.bytes.data(), code.bytes.size());
  return text;
}

std::optional<ObjectCode> readObjectCode(llvm::StringRef text) {
  std::vector<std::string> exports;
  for (;;) {
    const auto [line, rest] = text.split('\n');
    text = rest;
    if (line.empty())
      break;
    exports.push_back(line.str());
  }
  std::optional<StackUse> stackUse = StackUse::fromText(text);
  if (!stackUse)
    return std::nullopt;
  return ObjectCode{{text.begin(), text.end()}, std::move(exports), std::move(*stackUse)};
}

} // namespace rtsl::codegen
