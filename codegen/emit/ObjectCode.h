//===- ObjectCode.h - LLVM IR as machine code before linking --------------===//
#pragma once

#include "codegen/emit/StackUse.h"

#include "llvm/ADT/SmallVector.h"
#include "llvm/Support/Error.h"

#include <optional>
#include <string>
#include <vector>

namespace llvm {
class Module;
class TargetMachine;
} // namespace llvm

namespace rtsl::codegen {

struct ObjectCode {
  llvm::SmallVector<char, 0> bytes; // an ELF object
  std::vector<std::string> exports; // the externally visible functions
  StackUse stackUse;
};

/// Compiles an optimised module. Several threads may do so in parallel, each with a module in its
/// own context.
llvm::Expected<ObjectCode> makeObjectCode(llvm::Module &module, llvm::TargetMachine &machine);

/// The code as a sequence of bytes, for a file.
std::string textOf(const ObjectCode &code);

/// What textOf has written; nothing if it is something else.
std::optional<ObjectCode> readObjectCode(llvm::StringRef text);

} // namespace rtsl::codegen
