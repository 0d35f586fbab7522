//===- AlignMembers.cpp - loads of members on a GPU -----------------------===//
#include "codegen/emit/rewrites/gpu/AlignMembers.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/Operator.h"

#include <optional>

namespace rtsl::codegen {

/// Bytes from the beginning of the record that `address` is in; none if it is not in a record, or
/// at an element that is chosen while the program runs.
static std::optional<std::uint64_t> offsetInRecord(const llvm::Value *address,
                                                   const llvm::DataLayout &layout) {
  llvm::APInt offset(layout.getIndexTypeSizeInBits(address->getType()), 0);
  while (const auto *step = llvm::dyn_cast<llvm::GEPOperator>(address)) {
    if (const auto *bytes = llvm::dyn_cast<llvm::ArrayType>(step->getSourceElementType());
        bytes && bytes->getNumElements() == 1 && bytes->getElementType()->isIntegerTy(8) &&
        !step->hasAllConstantIndices())
      return offset.getZExtValue();
    if (!step->accumulateConstantOffset(layout, offset))
      return std::nullopt;
    address = step->getPointerOperand();
  }
  return std::nullopt;
}

void alignMembers(llvm::Module &module) {
  const llvm::Align ofRecords(16);
  for (llvm::Function &function : module)
    for (llvm::Instruction &instruction : llvm::instructions(function))
      if (auto *load = llvm::dyn_cast<llvm::LoadInst>(&instruction))
        if (const auto offset = offsetInRecord(load->getPointerOperand(), module.getDataLayout()))
          load->setAlignment(std::max(load->getAlign(), llvm::commonAlignment(ofRecords, *offset)));
}

} // namespace rtsl::codegen
