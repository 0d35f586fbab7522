//===- AlignMembers.cpp - members and elements of buffers on a GPU --------===//
#include "codegen/emit/rewrites/gpu/AlignMembers.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/Operator.h"

#include <algorithm>

namespace rtsl::codegen {

/// Of what an address is a multiple, if it is in a record or in a buffer.
static llvm::MaybeAlign alignmentOf(const llvm::Value *address, const llvm::DataLayout &layout) {
  const llvm::Align ofRecords(16), ofBuffers(64);
  llvm::APInt offset(layout.getIndexTypeSizeInBits(address->getType()), 0);
  while (const auto *step = llvm::dyn_cast<llvm::GEPOperator>(address)) {
    const llvm::Value *base = step->getPointerOperand();
    const auto *bytes = llvm::dyn_cast<llvm::ArrayType>(step->getSourceElementType());
    if (bytes && bytes->getElementType()->isIntegerTy(8)) {
      if (bytes->getNumElements() == 1)
        return llvm::commonAlignment(ofRecords, offset.getZExtValue());
      if (!step->hasAllConstantIndices()) {
        const llvm::MaybeAlign ofBase = alignmentOf(base, layout);
        if (!ofBase)
          return {};
        return llvm::commonAlignment(llvm::commonAlignment(*ofBase, bytes->getNumElements()),
                                     offset.getZExtValue());
      }
    }
    if (!step->accumulateConstantOffset(layout, offset))
      return {};
    address = base;
  }
  const auto *load = llvm::dyn_cast<llvm::LoadInst>(address);
  if (load && load->getType()->isPointerTy() && alignmentOf(load->getPointerOperand(), layout))
    return llvm::commonAlignment(ofBuffers, offset.getZExtValue());
  return {};
}

/// The same of where a store goes: an output buffer, or a variable instead after an exception.
static llvm::MaybeAlign alignmentOfTarget(llvm::Value *address, const llvm::DataLayout &layout) {
  auto *choice = llvm::dyn_cast<llvm::SelectInst>(address);
  auto *variable = choice ? llvm::dyn_cast<llvm::AllocaInst>(choice->getTrueValue()) : nullptr;
  const llvm::MaybeAlign alignment =
      alignmentOf(variable ? choice->getFalseValue() : address, layout);
  if (variable && alignment)
    variable->setAlignment(std::max(variable->getAlign(), *alignment));
  return alignment;
}

void alignMembers(llvm::Module &module) {
  const llvm::DataLayout &layout = module.getDataLayout();
  for (llvm::Function &function : module)
    for (llvm::Instruction &instruction : llvm::instructions(function))
      if (auto *load = llvm::dyn_cast<llvm::LoadInst>(&instruction)) {
        if (const auto known = alignmentOf(load->getPointerOperand(), layout))
          load->setAlignment(std::max(load->getAlign(), *known));
      } else if (auto *store = llvm::dyn_cast<llvm::StoreInst>(&instruction)) {
        if (const auto known = alignmentOfTarget(store->getPointerOperand(), layout))
          store->setAlignment(std::max(store->getAlign(), *known));
      } else if (auto *copy = llvm::dyn_cast<llvm::MemCpyInst>(&instruction)) {
        if (const auto known = alignmentOf(copy->getRawSource(), layout))
          copy->setSourceAlignment(*known);
        if (const auto known = alignmentOfTarget(copy->getRawDest(), layout))
          copy->setDestAlignment(*known);
      }
}

} // namespace rtsl::codegen
