//===- ClassTable.cpp - the classes of a module by name -------------------===//
#include "codegen/ir/ClassTable.h"

#include "codegen/ir/Layout.h"

namespace rtsl::ir {

ClassTable::ClassTable(mlir::ModuleOp module) {
  for (auto record : module.getOps<ClassOp>()) {
    llvm::StringMap<Member> &members = classes[record.getSymName()];
    std::uint32_t offset = sizeof(std::uint32_t); // the id of the class comes first
    for (auto declaration : record.getBody().getOps<MemberDeclOp>()) {
      Member &member = members[declaration.getSymName()];
      member.declaration = declaration;
      if (declaration.isScratch())
        continue;
      member.offset = offset;
      offset += sizeInBytes(declaration.getType());
    }
  }
}

const ClassTable::Member *ClassTable::find(llvm::StringRef className,
                                           llvm::StringRef member) const {
  const auto record = classes.find(className);
  if (record == classes.end())
    return nullptr;
  const auto found = record->second.find(member);
  return found == record->second.end() ? nullptr : &found->second;
}

} // namespace rtsl::ir
