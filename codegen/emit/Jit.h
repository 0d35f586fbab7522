//===- Jit.h - LLVM IR that runs in this process --------------------------===//
#pragma once

#include "codegen/emit/LlvmModule.h"
#include "codegen/emit/ObjectCode.h"

#include <memory>
#include <string>
#include <vector>

namespace rtsl::codegen {

/// A function of this process that code may call, by name.
struct HostSymbol {
  std::string name;
  void *address = nullptr;
};

/// Machine code in this process; it exists as long as the object. Besides `symbols`, the code may
/// call only functions that compilers use implicitly (memcpy, memset, ...).
class Jit {
public:
  /// Links parts of a program, which may call one another. An error names the undefined symbols.
  static llvm::Expected<std::unique_ptr<Jit>> create(std::vector<ObjectCode> parts,
                                                     const std::vector<HostSymbol> &symbols);

  /// Compiles all of a module at once, on this thread.
  static llvm::Expected<std::unique_ptr<Jit>> create(std::unique_ptr<llvm::LLVMContext> context,
                                                     std::unique_ptr<llvm::Module> module,
                                                     std::unique_ptr<llvm::TargetMachine> machine,
                                                     const std::vector<HostSymbol> &symbols);
  ~Jit();

  /// Address of an exported function; null if there is none of that name.
  void *lookup(const std::string &name) const;

  /// The stack use of all linked parts.
  std::shared_ptr<const StackUse> stackUse() const;

private:
  Jit();
  struct Implementation;
  std::unique_ptr<Implementation> implementation;
};

} // namespace rtsl::codegen
