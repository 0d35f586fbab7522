//===- RtslTables.cpp - constants in memory -------------------------------===//
//
// A load from a table at a known index is a constant.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Layout.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/IR/BuiltinAttributes.h"
#include "llvm/ADT/APFloat.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/bit.h"

#include <optional>

namespace rtsl::ir {

bool isNumbers(mlir::Type type) {
  if (auto structure = llvm::dyn_cast<StructType>(type))
    return llvm::all_of(structure.getFieldTypes(),
                        [](mlir::Type field) { return isNumbers(field); });
  if (auto array = llvm::dyn_cast<ArrayType>(type))
    return isNumbers(array.getElement());
  return isValueType(type) && !isWide(type) && !llvm::isa<RefType>(type);
}

void TableOp::getAsmResultNames(llvm::function_ref<void(mlir::Value, llvm::StringRef)> setName) {
  setName(getResult(), getName());
}

mlir::LogicalResult TableOp::verify() {
  const mlir::Type type = pointee(getResult());
  if (!isNumbers(type))
    return emitOpError() << "may hold only numbers, not " << type;
  if (getWords().size() * sizeof(std::int32_t) != sizeInBytes(type))
    return emitOpError() << "has " << getWords().size() << " words, and " << type << " has "
                         << sizeInBytes(type) / sizeof(std::int32_t);
  return mlir::success();
}

namespace {

struct TableWord {
  TableOp table;
  std::size_t word = 0;
};

} // namespace

/// The table and the word that an address points to; none if it is not in a table or its index is
/// not known.
static std::optional<TableWord> findTableWord(mlir::Value address) {
  std::size_t bytes = 0;
  while (mlir::Operation *op = address.getDefiningOp()) {
    if (auto table = llvm::dyn_cast<TableOp>(op))
      return TableWord{table, bytes / sizeof(std::int32_t)};
    if (auto field = llvm::dyn_cast<FieldOp>(op)) {
      auto type = llvm::cast<StructType>(pointee(field.getBase()));
      bytes += fieldOffset(type, *type.fieldIndex(field.getField()));
    } else if (auto element = llvm::dyn_cast<ElementOp>(op)) {
      const std::optional<std::int32_t> index = element.constantIndex();
      const auto type = llvm::cast<ArrayType>(pointee(element.getBase()));
      if (!index || *index < 0 || static_cast<unsigned>(*index) >= type.getLength())
        return std::nullopt; // out of range: code that never runs
      bytes += static_cast<std::size_t>(*index) * sizeInBytes(type.getElement());
    } else {
      break;
    }
    address = op->getOperand(0);
  }
  return std::nullopt;
}

/// A word of memory as a constant; a bool is true unless all bits are zero.
static mlir::Attribute scalar(mlir::Type type, std::int32_t word) {
  if (type.isF32())
    return mlir::FloatAttr::get(type, llvm::APFloat(llvm::bit_cast<float>(word)));
  return mlir::IntegerAttr::get(type, type.isInteger(1) ? word != 0 : word);
}

mlir::OpFoldResult LoadOp::fold(FoldAdaptor) {
  std::optional<TableWord> found = findTableWord(getAddress());
  if (!found)
    return nullptr;
  const llvm::ArrayRef<std::int32_t> words = found->table.getWords().drop_front(found->word);
  auto vector = llvm::dyn_cast<mlir::VectorType>(getType());
  if (!vector)
    return scalar(getType(), words.front());
  llvm::SmallVector<mlir::Attribute, 4> components;
  for (const std::int32_t word :
       words.take_front(static_cast<std::size_t>(vector.getNumElements())))
    components.push_back(scalar(vector.getElementType(), word));
  return mlir::DenseElementsAttr::get(vector, components);
}

} // namespace rtsl::ir
