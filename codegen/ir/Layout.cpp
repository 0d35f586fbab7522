//===- Layout.cpp - sizes and offsets in memory ---------------------------===//
#include "codegen/ir/Layout.h"

#include "codegen/ir/dialect/RtslOps.h"
#include "runtime/device/ray/Launch.h"

#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::ir {

std::uint32_t sizeInBytes(mlir::Type type) {
  return llvm::TypeSwitch<mlir::Type, std::uint32_t>(type)
      .Case([](mlir::VectorType vector) {
        return static_cast<std::uint32_t>(vector.getNumElements()) *
               sizeInBytes(vector.getElementType());
      })
      .Case([](ArrayType array) { return array.getLength() * sizeInBytes(array.getElement()); })
      .Case([](StructType structure) {
        return fieldOffset(structure, structure.getFieldTypes().size());
      })
      .Case([](BufferType) { return static_cast<std::uint32_t>(sizeof(RtslBuffer)); })
      .Default([](mlir::Type scalar) { return scalar.isF64() ? 8u : 4u; });
}

std::uint32_t fieldOffset(StructType type, unsigned index) {
  std::uint32_t offset = 0;
  for (mlir::Type field : type.getFieldTypes().take_front(index))
    offset += sizeInBytes(field);
  return offset;
}

std::uint32_t recordSize(ClassOp classOp) {
  std::uint32_t size = sizeof(std::uint32_t);
  for (auto member : classOp.getBody().getOps<MemberDeclOp>())
    if (!member.isScratch())
      size += sizeInBytes(member.getType());
  return size;
}

std::optional<std::uint32_t> memberOffset(ClassOp classOp, llvm::StringRef name) {
  std::uint32_t offset = sizeof(std::uint32_t);
  for (auto member : classOp.getBody().getOps<MemberDeclOp>()) {
    if (member.isScratch())
      continue;
    if (member.getSymName() == name)
      return offset;
    offset += sizeInBytes(member.getType());
  }
  return std::nullopt;
}

} // namespace rtsl::ir
