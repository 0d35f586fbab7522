//===- ObjectCode.h - LLVM IR as machine code that is not linked yet ------===//
#pragma once

#include "codegen/emit/StackUse.h"

#include "llvm/ADT/SmallVector.h"
#include "llvm/Support/Error.h"

#include <string>
#include <vector>

namespace llvm {
class Module;
class TargetMachine;
} // namespace llvm

namespace rtsl::codegen {

struct ObjectCode {
  llvm::SmallVector<char, 0> bytes; // an ELF object
  std::vector<std::string> exports; // the functions that are visible outside
  StackUse stackUse;
};

/// Compiles an optimised module. Several threads may do so at once, each with a module in a context
/// of its own.
llvm::Expected<ObjectCode> makeObjectCode(llvm::Module &module, llvm::TargetMachine &machine);

} // namespace rtsl::codegen
