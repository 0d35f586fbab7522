//===- ClassTable.h - the classes of a module by name ---------------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/StringMap.h"

#include <cstdint>
#include <optional>

namespace rtsl::ir {

/// Finds members of classes in constant time. Invalid once class declarations have been added or
/// erased.
class ClassTable {
public:
  explicit ClassTable(mlir::ModuleOp module);

  struct Member {
    MemberDeclOp declaration;
    // bytes from the start of the record; none for a scratch member
    std::optional<std::uint32_t> offset;
  };
  /// The member of this name of the class; null if the class is not declared or does not have it.
  const Member *find(llvm::StringRef className, llvm::StringRef member) const;

private:
  llvm::StringMap<llvm::StringMap<Member>> classes;
};

} // namespace rtsl::ir
